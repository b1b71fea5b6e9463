#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A column that is killed and resumed, or run on several ranks, leaves the same files."""
import os
import random
import re
import shutil
import signal

import numpy as np

from column_support import ColumnTest, SCENES, history, settings
from support import main


class Resume(ColumnTest):
    """A run that is killed and resumed leaves the same files."""

    OPTIONS = settings(analysis__duration="50 s", output__profile_interval="0.1 s", output__paraview_interval="2 s",
                       output__checkpoint="1e-9 min")

    def interrupt(self, with_signal, expected, *more):
        arguments = [self.scene, *self.OPTIONS, *more]
        begin = os.times().elapsed
        self.assert_done(self.run_column(*arguments, "-o", "whole"))
        seconds = os.times().elapsed - begin
        moments, codes = random.Random(20240229), []
        started = (self.folder / "parts/checkpoint/last.h5", True)
        for resume in ([], ["--resume"], ["--resume"]):
            codes.append(self.run_and_stop(moments.uniform(0.02, 0.25) * seconds, with_signal, started, *arguments,
                                           "-o", "parts", *resume, program="soil_column"))
        self.assertEqual(codes[0], expected)
        return arguments

    def finish(self, arguments):
        self.assert_done(self.run_column(*arguments, "-o", "parts", "--resume"))
        self.assert_same_files("whole", "parts")

    def test_sigterm(self):
        self.finish(self.interrupt(signal.SIGTERM, 130, *settings(water__drainage="undrained",
                                                                  water__lagged_compressibility="true")))

    def test_sigkill_and_a_damaged_checkpoint(self):
        arguments = self.interrupt(signal.SIGKILL, -signal.SIGKILL)
        checkpoints = self.folder / "parts/checkpoint"
        for name in ("fresh.h5", "last.h5"):
            if (checkpoints / name).exists():
                (checkpoints / name).write_bytes((checkpoints / name).read_bytes()[:3000])
        self.finish(arguments)


    def test_consolidation(self):
        options = [SCENES / "terzaghi.toml", *settings(analysis__steps=60, output__checkpoint="1e-9 min")]
        self.assert_done(self.run_column(*options, "-o", "whole"))
        started = (self.folder / "parts/checkpoint/last.h5", True)
        code = self.run_and_stop(0.02, signal.SIGTERM, started, *options, "-o", "parts", program="soil_column")
        self.assertIn(code, {0, 130})
        self.finish(options)


class MPIRanks(ColumnTest):
    def test_replicated_to_the_bit(self):
        options = settings(output__profile_interval="0.05 s", output__paraview_interval="0.5 s")
        results = [self.run_on_ranks(n, self.scene, "-o", f"on{n}", *options) for n in (1, 2, 3)]
        for n, result in enumerate(results, 1):
            self.assert_done(result)
            self.assertEqual(result.stdout.count("peak shear strain"), 1)
            self.assert_same_files("on1", f"on{n}")
            self.assertEqual(len(re.findall("time step .* stable up to", result.stderr)), 1)

    def test_distributed(self):
        options = settings(mesh__dimension=2, mesh__distributed="true", mesh__width="4 m", mesh__cells_across=3,
                           analysis__duration="0.5 s")
        rows = {}
        for n in (1, 2, 3):
            self.assert_done(self.run_on_ranks(n, self.scene, "-o", f"on{n}", *options))
            rows[n] = history(self.folder / f"on{n}")
            self.assertFalse((self.folder / f"on{n}/profiles.h5").exists())
            for name in ("surface_ax", "surface_ay", "surface_vx", "surface_ux", "surface_uz", "d0_tau_xz", "d0_u",
                         "max_ru", "min_p_ratio", "external"):
                scale = np.abs(rows[1][name]).max()
                self.assertGreater(scale, 0, name)
                self.assert_near(rows[n][name], rows[1][name], 1e-10 * scale,
                                 f"round-off of sums over the ranks ({name})")

    def test_failure_on_all_ranks(self):
        shutil.copy(self.scene, self.folder / "out")  # a file
        result = self.run_on_ranks(2, self.scene, "-o", "out")
        self.assertEqual(result.stderr.count("error: "), 1)
        self.assertIn("not a folder", result.stderr)
        self.assertEqual(result.returncode, 2)


if __name__ == "__main__":
    main()

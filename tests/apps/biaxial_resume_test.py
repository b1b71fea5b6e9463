# SPDX-License-Identifier: BSD-3-Clause
"""A biaxial block, stopped and started again: the same files, whatever stopped it."""
import functools
import signal

from biaxial_test import BLOCKS, CELL, FEW, GRAINS
from column_support import ColumnTest, settings
from support import tiny_scene

SOFTENING = BLOCKS / "mohr_coulomb.toml"
SMALL = settings(mesh__cells_across=4, layer__0__cells=8, analysis__nonlocal__length="0.08 m", analysis__load_steps=15,
                 analysis__map_every=2)
UNDRAINED = settings(water__drainage="coupled", mesh__points=3, layer__0__permeability="1e-9 m/s")


class Resume(ColumnTest):
    def test_a_softening_block_with_a_length(self):
        self.assert_goes_on(SOFTENING, signal.SIGKILL, *SMALL)
        self.assertIn("continue with --resume", self.assert_goes_on(SOFTENING, signal.SIGTERM, *SMALL))
        calls = (self.folder / "parts/provenance.txt").read_text(encoding="utf-8").split("\n\n")
        self.assertEqual(["--resume" in call for call in calls], [False, True], "each call is recorded")

    def test_an_undrained_block(self):
        self.assert_goes_on(SOFTENING, signal.SIGKILL, *SMALL, *UNDRAINED)

    def test_a_failed_run_has_not_finished(self):
        for more in ((), ("--resume",)):
            result = self.run_column(SOFTENING, "-o", "out", "-q", *SMALL, *settings(
                analysis__relaxation_iterations=1), *more)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("relaxation has not come to rest", result.stderr)

    def test_packings_on_other_threads(self):
        scene = self.write("rve.toml", tiny_scene(specimen=CELL, stages="# none"))
        self.assert_done(self.run_app("isostat", "library", scene, *FEW, "-o", "library.h5"))
        on_two = functools.partial(self.run_column, "--threads", "2")
        self.assert_goes_on(self.write("block.toml", GRAINS), signal.SIGKILL, *settings(
            analysis__load_steps=6, analysis__nonlocal__length="0.5 m", analysis__max_iterations=0,
            analysis__relaxation_iterations=300), resume=on_two)
        self.assertTrue(self.summary_of("parts")["complete"])

# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of soil_column share: a small scene, running the program, comparing what it leaves behind."""
import os
import shutil

import h5py
import numpy as np

from support import ROOT, AppTest

os.environ["OMP_NUM_THREADS"] = "1"
SCENES = ROOT / "apps/scenes/column"

SOIL = """title = "sand over clay"
[water]
drainage = "coupled"
[[layer]]
name = "sand"
thickness = "3 m"
cells = 3
permeability = "1e-4 m/s"
material = "iwan"
reference_pressure = "100 kPa"
k0 = 0.5
shear_velocity = "150 m/s"
[[layer]]
thickness = "4 m"
cells = 4
permeability = "1e-6 m/s"
material = "elastic"
shear_velocity = "200 m/s"
[[motion]]
axis = "x"
kind = "harmonic"
amplitude = "0.1 g"
frequency = "3 Hz"
duration = "60 s"
ramp = "1 s"
[[motion]]
axis = "y"
kind = "ricker"
amplitude = "0.05 g"
frequency = "4 Hz"
[analysis]
duration = "1 s"
[output]
depths = ["1 m", "5 m"]
"""
NO_FILES = ("provenance.txt", "times.json")  # time of the run, number of ranks


def settings(**values):
    """--set section__key=value ..., with a dot for two underscores."""
    return [part for key, value in values.items() for part in ("--set", f"{key.replace('__', '.')}={value}")]


def history(folder):
    with h5py.File(folder / "history.h5") as file:
        return {name: np.asarray(values) for name, values in file["history"].items()}


class ColumnTest(AppTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("soil.toml", SOIL)

    def run_column(self, *arguments):
        return self.run_app("soil_column", *arguments, "--no-figures")

    def assert_no_warning(self, result, message=None):
        """None but that a short analysis ends before its motion."""
        self.assertEqual([line for line in result.stderr.splitlines() if "before the motion along" not in line], [],
                         message)

    def rows_of(self, text, name="run"):
        """History and summary of a scene."""
        result = self.run_column(self.write(f"{name}.toml", text), "-o", name, "--quiet")
        self.assert_done(result)
        return history(self.folder / name), self.summary_of(name)

    def command_on_ranks(self, n, *arguments):
        return ["mpirun", "--oversubscribe", "-n", str(n), *self.command("soil_column", *arguments, "--no-figures")]

    def run_on_ranks(self, n, *arguments):
        return self.run_command(self.command_on_ranks(n, *arguments))

    def assert_goes_on(self, scene, how, *options, resume=None):
        """A run that gets a signal once it has a checkpoint, and is resumed, leaves the same files as one that is not
        stopped. Returns what it said on stderr.   resume: runs the rest, as run_column() does"""
        options = (*options, *settings(output__checkpoint="1e-9 min"))
        self.assert_done(self.run_column(scene, "-o", "whole", "--overwrite", *options))
        shutil.rmtree(self.folder / "parts", ignore_errors=True)
        last = self.folder / "parts/checkpoint/last.h5"
        said = self.stop_when(last.exists, last, how,
                              self.command("soil_column", scene, "-o", "parts", "--no-figures", *options))[1]
        self.assertTrue(last.exists(), said)
        self.assertFalse((self.folder / "parts/summary.json").exists())
        self.assert_done((resume or self.run_column)(scene, "-o", "parts", "--resume", *options))
        self.assert_same_files("whole", "parts")
        return said

    def check_ranks(self, *options):
        """The scene leaves the same files on one rank and on two."""
        for n in (1, 2):
            self.assert_done(self.run_on_ranks(n, self.scene, "-o", f"on{n}", *options))
        self.assert_same_files("on1", "on2")

    def check_shared_mesh(self, others, keys, tolerance, *options):
        """These numbers of the summary are those of one rank on other numbers of ranks."""
        for n in (1, *others):
            self.assert_done(self.run_on_ranks(n, self.scene, "-o", f"on{n}", *options))
            self.check_numbers("on1", f"on{n}", keys, tolerance)

    def check_numbers(self, one, other, keys, tolerance):
        for key in keys:
            expected, found = (self.summary_of(name) for name in (one, other))
            for part in key.split("."):
                expected, found = expected[part], found[part]
            self.assert_close(found, expected, tolerance, f"round-off of sums over the ranks ({key})")

    def assert_same_files(self, one, other):
        """Checkpoints come when the clock says."""
        self.assert_same_folders(one, other, (*NO_FILES, "checkpoint"))

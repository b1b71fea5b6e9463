# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of soil_column share: a small scene, running the program, comparing what it leaves behind."""
import json
import os
import pathlib
import shutil
import sys

import h5py
import numpy as np

from support import AppTest, contents

os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OPENBLAS_NUM_THREADS="1",
                  OMP_NUM_THREADS="1")
ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "apps/scenes/column"
sys.path.append(str(ROOT))  # for studies

SOIL = """title = "sand over clay"
[water]
drainage = "coupled"
[[layer]]
name = "sand"
thickness = "3 m"
cells = 3
permeability = "1e-4 m/s"
material = "iwan"
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
NO_FILES = {"provenance.txt", "times.json"}  # time of the run, number of ranks


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
        folder = self.folder / name
        return history(folder), json.loads((folder / "summary.json").read_text(encoding="utf-8"))

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

    def assert_same_files(self, one, other):
        """All files the same: HDF5 item by item, anything else byte by byte. Checkpoints come when the clock says."""
        def names(folder):
            return {n for n in contents(self.folder / folder) if n not in NO_FILES and not n.startswith("checkpoint")}
        self.assert_same_contents(one, other, names)

    def assert_same_contents(self, one, other, names):
        """Of two folders the files `names(folder)`: HDF5 item by item, anything else byte by byte."""
        self.assertEqual(names(one), names(other))
        for name in names(one):
            a, b = self.folder / one / name, self.folder / other / name
            if name.endswith(".h5"):
                self.assert_same_h5(a, b)
            else:
                self.assertEqual(a.read_bytes(), b.read_bytes(), name)

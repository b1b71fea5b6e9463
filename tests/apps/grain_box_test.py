# SPDX-License-Identifier: BSD-3-Clause
"""soil_column with packings of grains in a box whose ground is inclined: settled, shaken, on ranks and threads, and
killed."""
import random
import re
import signal

import h5py
import numpy as np

import grain_column_test
from column_support import settings
from grain_column_test import GRAINS
from support import columns

BOX = re.sub(r"(snapshot|path)_(depths|interval).*\n", "", GRAINS).replace(
    "[mesh]\ndegree = 1\n", """[mesh]
dimension = 2
width = "6 m"
cells_across = 2
points = 2
sides = "walls"
ground_x = ["0 m", "6 m"]
ground_z = ["3 m", "2.6 m"]
""").replace('"undrained"', '"coupled"').replace("cells = 5", 'cells = 1\npermeability = "1e-4 m/s"').replace(
    "safety = 0.7", "safety = 0.5").replace('duration = "0.3 s"', 'duration = "0.2 s"')


class Box(grain_column_test.GrainColumnTest):
    stop = grain_column_test.Bits.stop

    def setUp(self):
        super().setUp()
        self.scene = self.write("box.toml", BOX.format(cache=self.cache))

    def test_ranks_threads_and_kills(self):
        """Between free fields, whose columns have packings of their own."""
        slope = BOX.replace('"walls"', '"free-field"').replace("cells_across = 2", "cells_across = 3").replace(
            '"0 m", "6 m"', '"0 m", "2 m", "4 m", "6 m"').replace('"3 m", "2.6 m"', '"3 m", "3 m", "2.6 m", "2.6 m"')
        self.scene = self.write("box.toml", slope.format(cache=self.cache))
        self.assert_done(self.run_column(self.scene, "-o", "whole", "-q"))
        self.assert_done(self.run_on_ranks(3, self.scene, "-o", "ranks", "-q"))
        self.assert_same_bytes("whole", "ranks")
        code, message = self.stop(2, signal.SIGKILL, random.Random(1).uniform(0, 0.5))
        self.assertNotEqual(code, 0, message)
        self.assert_done(self.run_column(self.scene, "-o", "parts", "-q", "--resume", "--threads", 2))
        self.assert_same_bytes("whole", "parts")

    def test_packings_in_balance_settle_to_a_thousandth(self):
        run = self.run_column(self.scene, "-o", "run", *settings(analysis__duration="0.01 s", grains__drive="static"))
        self.assert_done(run)
        last = [float(found[1]) for found in re.finditer(r"settles: .* trials, residuals .*?(\S+)$", run.stderr, re.M)]
        self.assertTrue(last, run.stderr)
        self.assert_below(max(last), 1e-3, "the tolerance of Newton's method")

    def test_maps_have_the_redundancy_of_each_packing(self):
        self.assert_done(self.run_column(self.scene, "-o", "run", "-q", *settings(analysis__duration="0.05 s")))
        with h5py.File(self.folder / "run/maps.h5") as file:
            redundancy, x, z = (np.asarray(file[name]) for name in ("redundancy", "x", "z"))
            moved = np.asarray(file["displacement_x"])
        self.assertEqual(redundancy.shape[1], 8)
        self.assertEqual((len(x), len(z)), (8, 8))
        self.assertTrue(((redundancy > 0.5) & (redundancy < 3)).all(), redundancy)
        self.assertEqual(np.abs(moved[0]).max(), 0)
        self.assertGreater(np.abs(moved[-1]).max(), 1e-6)
        profiles = columns(self.folder / "run/grain_profiles/history.csv")
        rows = np.array([values for name, values in profiles.items() if re.fullmatch(r"p\d+_IR", name)]).T
        self.assert_near(np.sort(rows[0]), np.sort(redundancy[0]), 1e-9, "ten digits of a table for people")

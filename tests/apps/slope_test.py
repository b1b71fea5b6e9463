# SPDX-License-Identifier: BSD-3-Clause
"""soil_column on a slope with a water table, in soil whose permeability varies: what it leaves, on how many ranks and
after which restarts."""
import math
import signal

import h5py
import numpy as np

from column_support import ColumnTest, SOIL, settings

SLOPE = SOIL.replace('drainage = "coupled"', 'drainage = "coupled"\ntable = "1 m"\n[slope]\nangle = "5 deg"').replace(
    'amplitude = "0.1 g"', 'amplitude = "0.2 g"').replace(
    'permeability = "1e-4 m/s"', 'permeability = "1e-4 m/s"\npermeability_law = "kozeny-carman"')
DISTRIBUTED = settings(mesh__dimension=2, mesh__distributed="true", mesh__width="4 m", mesh__cells_across=2)


class Slope(ColumnTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("slope.toml", SLOPE)

    def profiles(self, name):
        with h5py.File(self.folder / name / "profiles.h5") as file:
            return {key: np.asarray(values) for key, values in file.items()}

    def test_what_it_leaves(self):
        rows, summary = self.rows_of(SLOPE)
        self.assertGreater(summary["downslope"], 0.01)
        text = (self.folder / "run/summary.txt").read_text(encoding="utf-8")
        self.assertRegex(text, r"slope +5 deg, factor of safety at the start \d\.\d+ at a depth of 3\.00 m")
        self.assertRegex(text, r"moved downslope +0\.\d+ m at the surface")
        left = self.profiles("run")
        self.assertEqual(left["end_displacement"][0], summary["downslope"])
        self.assertEqual(left["end_displacement"][-1], 0)
        self.assert_near(rows["surface_ux"][-1], summary["downslope"], 0.2 * summary["downslope"],
                         "the end is half a step and up to 10 ms after the last row")
        self.assertEqual(np.abs(left["end_gamma_xz"]).max(), abs(summary["end_gamma"]))
        # statics: 2000 kg/m3 everywhere, water below 1 m; sin and cos of 5 deg
        weight = 9.81 * 2000 * left["depth"]
        self.assert_near(left["tau_0"], weight * math.sin(math.radians(5)), 1e-9 * weight.max(), "round-off")
        effective = weight - 9810 * np.maximum(0, left["depth"] - 1)
        self.assert_near(left["sigma_v0"], effective * math.cos(math.radians(5)), 1e-9 * weight.max(), "round-off")
        self.assertEqual(rows["d0_tau_xz"][0], left["tau_0"][np.argmin(abs(left["depth"] - rows["d0_depth"][0]))])
        self.assertEqual(summary["slope"], 5)

    def test_level_ground_says_nothing_of_slopes(self):
        _, summary = self.rows_of(SOIL)
        self.assertFalse({"slope", "downslope", "factor_of_safety"} & summary.keys())
        self.assertNotIn("tau_0", self.profiles("run"))

    def test_no_pore_pressure_above_the_table(self):
        rows, _ = self.rows_of(SLOPE.replace('depths = ["1 m"', 'depths = ["0.5 m", "2 m"'))
        self.assertEqual(np.abs(rows["d0_u"]).max(), 0)
        self.assertGreater(np.abs(rows["d1_u"]).max(), 100)

    def test_ranks_are_alike_bit_for_bit(self):
        self.check_ranks(*settings(output__profile_interval="0.05 s", analysis__duration="0.3 s"))

    def test_one_mesh_over_ranks(self):
        self.check_shared_mesh((3,), ("downslope", "end_gamma", "end_gamma_depth", "max_ru", "settlement"), 1e-9,
                               *DISTRIBUTED, *settings(analysis__duration="0.3 s"))

    def test_continues_where_it_was_stopped(self):
        said = self.assert_goes_on(self.scene, signal.SIGTERM, *settings(output__profile_interval="0.1 s",
                                                                         analysis__duration="4 s"))
        self.assertIn("continue with --resume", said)

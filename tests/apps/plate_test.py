# SPDX-License-Identifier: BSD-3-Clause
"""soil_column with a rigid plate that moves into a box of soil: forces of elastic soil in closed form, what it leaves,
and restarts."""
import signal

import numpy as np

from column_support import ColumnTest, settings
from support import columns

BOX = """title = "plate"
[mesh]
dimension = 2
width = "4 m"
cells_across = 8
sides = "walls"
[water]
drainage = "dry"
[[layer]]
name = "soil"
thickness = "2 m"
cells = 4
density = "1800 kg/m3"
k0 = 0.5
material = "elastic"
shear_modulus = "10 MPa"
poisson_ratio = 0.25
[analysis]
kind = "plate"
on = "surface"
displacement = "10 mm"
load_steps = 4
"""
WEIGHT = 9.81 * 1800 * 2 * 4
MODULUS = 10e6 * 2 * (1 - 0.25) / (1 - 2 * 0.25)  # of confined compression


class PlateTest(ColumnTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("plate.toml", BOX)

    def plate(self, name="run", **values):
        """The rows of plate/history.csv, and the summary."""
        self.assert_done(self.run_column(self.scene, "-o", name, "--quiet", *settings(**values)))
        return columns(self.folder / name / "plate/history.csv"), self.summary_of(name)["plate"]

    def forces(self, name="run", **values):
        table, summary = self.plate(name, **values)
        return table["displacement"], table["force"], table["pressure"], summary

    def test_a_press_over_the_whole_surface_is_confined_compression(self):
        way, force, pressure, summary = self.forces(analysis__rough="false")
        self.assert_near(way, np.linspace(0, 0.01, 5), 1e-15, "round-off")
        self.assert_near(force, MODULUS * way / 2 * 4, 1e-4, "a tolerance of 1e-6 of some 1e5 N")
        self.assert_near(pressure[-1] - pressure[0], MODULUS * 0.01 / 2, 1e-2, "likewise, Pa of 1e5")
        self.assertEqual(summary["length"], 4)
        self.assertEqual(summary["largest_at"], 0.01)
        self.assert_below(summary["largest_residual"], 1e-6, "the tolerance of the scene")

    def test_the_whole_base_carries_the_weight(self):
        _, force, _, summary = self.forces(analysis__on="base", analysis__displacement="-1 mm")
        self.assert_near(force[0], WEIGHT, 1e-6 * WEIGHT, "the solver of the stress in situ, 1e-10 of the forces")
        self.assertEqual(summary["force_in_situ"], force[0])
        self.assert_near(force[-1], WEIGHT, 1e-6 * WEIGHT, "the soil falls with it as a whole: smooth walls, no force")

    def test_a_wall_bears_earth_pressure_at_rest_and_answers_elastically(self):
        _, force, pressure, _ = self.forces(analysis__on="left", analysis__rough="false")
        at_rest = 0.5 * 9.81 * 1800 * 2 ** 2 / 2
        self.assert_near(force[0], at_rest, 1e-6 * at_rest, "round-off of the solver")
        self.assertGreater(force[-1], force[0] + 0.8 * MODULUS * 0.01 / 4 * 2)
        self.assertGreater(pressure[-1], pressure[0])
        _, away, _, _ = self.forces("away", analysis__on="left", analysis__rough="false",
                                    analysis__displacement="-10 mm")
        self.assert_near(force + away, 2 * force[0], 1e-5 * at_rest, "linear: as much less as it was more")
        _, right, _, _ = self.forces("right", analysis__on="right", analysis__rough="false")
        self.assert_near(right, force, 1e-6 * at_rest, "mirrored")

    def test_a_surcharge_is_taken_over_by_the_plate(self):
        for place in ({}, {"analysis__from": "1 m", "analysis__to": "2 m"}):
            _, force, _, summary = self.forces("on" + str(len(place)), load__surcharge="20 kPa", **place)
            expected = 20e3 * summary["length"]
            self.assert_near(force[0], expected, 1e-6 * expected, "the stress in situ is exact on level ground")

    def test_a_smooth_plate_bears_no_shear_and_a_rough_one_what_holds_it(self):
        for rough in ("false", "true"):
            table, _ = self.plate(rough, analysis__on="left", analysis__rough=rough, mesh__width="2 m",
                                  mesh__cells_across=4)
            shear = table["shear_force"]
            foot = 9.81 * 1800 * 2 * 0.5 / 6 if rough == "true" else 0  # what the base bears at the node they share
            self.assert_near(shear[0], foot, 1e-6 * WEIGHT, "it was a smooth wall when the soil settled")
            self.assertEqual(shear[-1] < foot - 1000, rough == "true", "soil that is pressed rises, the wall holds it")

    def test_a_part_of_a_side(self):
        way, force, _, summary = self.forces(analysis__from="1 m", analysis__to="2 m")
        self.assertEqual(summary["length"], 1)
        self.assert_near(force[0], 0, 1e-9, "round-off of forces of kN")
        self.assertGreater(force[-1], MODULUS * way[-1] / 2 * 1, "the soil next to it helps")

    def test_continues_where_it_was_stopped(self):
        self.assert_goes_on(self.scene, signal.SIGKILL, *settings(analysis__load_steps=60))

# SPDX-License-Identifier: BSD-3-Clause
"""The mesh that a column chooses, what it says of it, and the check with half the elements."""
import numpy as np

from column_support import SCENES, ColumnTest, history, settings
from figures.common import read_history

SITE = SCENES / "site.toml"


class Mesh(ColumnTest):
    def run_site(self, name, *options):
        self.assert_done(self.run_column(SITE, "-o", name, "--quiet", *settings(analysis__duration="8 s"), *options))
        return self.summary_of(name)

    def test_the_chosen_mesh_and_half_of_it(self):
        """Against a mesh with more than twice the elements: spectra within 2 % from 0.1 s on, the peak below 25 Hz
        within 1 %. The check states what the results of its two runs say."""
        whole = self.run_site("whole", "--check-mesh")
        cells = [layer["cells"] for layer in whole["layers"]]
        fine = self.run_site("fine", *[part for k, n in enumerate(cells)
                                       for part in settings(**{f"layer__{k}__cells": int(2.2 * n)})])
        spectra = {name: read_history(self.folder / name / "spectra.csv")
                   for name in ("whole", "fine", "whole/half_mesh")}
        period = spectra["fine"]["period"]
        long = period >= 0.1
        ratio = spectra["whole"]["surface_x_SA"] / spectra["fine"]["surface_x_SA"] - 1
        print(f"{whole['elements']} elements against {fine['elements']}: S_a {100 * np.abs(ratio[long]).max():.2f} %, "
              f"peak {100 * (whole['peak_surface'] / fine['peak_surface'] - 1):.2f} %")
        self.assert_below(np.abs(ratio[long]).max(), 0.02, "0.1 to 0.5 % were measured over 26 s")
        self.assert_close(whole["peak_surface_below"], fine["peak_surface_below"], 0.01, "0.1 % was measured over 26 s")

        check, half = whole["mesh_check"], self.summary_of("whole/half_mesh")
        self.assertEqual([layer["cells"] for layer in half["layers"]], [(n + 1) // 2 for n in cells])
        self.assertEqual(check["elements"], half["elements"])
        for key in ("peak_surface", "peak_surface_below", "peak_gamma"):
            self.assert_near(check[key], half[key] / whole[key] - 1, 1e-12, "the same numbers")
        ratio = spectra["whole/half_mesh"]["surface_x_SA"] / spectra["whole"]["surface_x_SA"] - 1
        at = np.argmax(np.abs(ratio) * long)
        self.assert_near(check["spectrum"], ratio[at], 1e-7, "digits of the table")
        self.assert_near(check["spectrum_period"], period[at], 1e-9, "digits of the table")
        apart = np.abs(ratio) > 0.05
        if apart.any():
            self.assert_close(check["frequency"], 1 / period[apart].max(), 1e-8, "digits of the table")
        else:
            self.assertIsNone(check["frequency"])

        carried = whole["layers"][0]
        self.assert_near(carried["element_length"], 4 / cells[0], 1e-12, "round-off of a quotient")
        self.assertLess(carried["softened_frequency"], carried["carried_frequency"])
        stiff = whole["layers"][-1]  # elastic: V_s = 400 m/s
        for key in ("carried_frequency", "softened_frequency"):
            self.assert_close(stiff[key], 400 * 2 / 10 / stiff["element_length"], 1e-6, "round-off of a modulus")

    def test_too_few_elements_are_named_at_the_end(self):
        coarse = settings(**{f"layer__{k}__cells": 1 for k in range(4)})
        summary = self.run_site("coarse", *coarse)
        said = [w for w in summary["warnings"] if "became so soft" in w]
        self.assertEqual(len(said), 1, summary["warnings"])
        self.assertRegex(said[0], r"layer\.1 \(medium sand\) .* 8 m long, carried waves up to \S+ Hz only .*"
                                  r"--check-mesh.*depend on the mesh at any size")

    def test_dynamic_runs_alone_are_checked(self):
        self.assert_refused(self.run_column(SCENES / "terzaghi.toml", "--check-mesh", "-o", "out"), "--check-mesh",
                            "dynamic")


MOIST = """title = "sand, moist above the water table"
[water]
drainage = "undrained"
table = "2 m"
[[layer]]
thickness = "6 m"
cells = 12
density = "1900 kg/m3"
material = "iwan"
k0 = 0.5
shear_velocity = "160 m/s"
[[motion]]
kind = "harmonic"
amplitude = "0.15 g"
frequency = "2 Hz"
duration = "4 s"
ramp = "1 s"
[analysis]
duration = "5 s"
[output]
depths = ["1 m", "3.4 m"]
profile_interval = "1 s"
"""


class WaterTable(ColumnTest):
    def test_undrained_below_the_table_drained_above(self):
        rows, summary = self.rows_of(MOIST)
        depth = rows["d1_depth"][0]
        self.assert_close(rows["d1_p"][0], 2 / 3 * 9.81 * (1900 * depth - 1000 * (depth - 2)), 1e-6,
                          "digits of the file")
        self.assertEqual(np.abs(rows["d0_u"]).max(), 0)
        self.assertGreater(rows["d1_u"].max(), 0.2 * rows["d1_p"][0])
        self.assertGreater(summary["max_ru_depth"], 2)
        self.assertGreater(rows["d0_p"].min(), 0.5 * rows["d0_p"][0])  # its weight confines it
        self.assertGreater(summary["settlement"], 1e-5)  # of what is above the table
        dry = self.rows_of(MOIST.replace('table = "2 m"\n', ""), "saturated")[1]
        self.assert_near(dry["settlement"], 0, 1e-12, "constant volume")
        self.assert_below(summary["relative_energy_residual"], 1e-9, "round-off")


class BothEnds(ColumnTest):
    def test_series_of_a_layer_that_drains_at_both_ends(self):
        """Terzaghi: U = 1 - sum 8/(pi^2 m^2) exp(-m^2 pi^2 T/4), m odd, T = c t/(H/2)^2."""
        options = settings(water__base="drained", analysis__last_time="3000 s", analysis__steps=40)
        self.assert_done(self.run_column(SCENES / "terzaghi.toml", "-o", "out", "-q", *options))
        rows, summary = history(self.folder / "out"), self.summary_of("out")
        c = 1e-6 / 9810 / (1 / 100e6 + 0.33 / 2.2e9)
        t = rows["time"][rows["time"] > 20]
        settlement = rows["settlement"][rows["time"] > 20]
        m = np.arange(1, 2000, 2)[:, None]
        degree = 1 - (8 / (np.pi * m) ** 2 * np.exp(-m**2 * np.pi**2 / 4 * c * t / 25)).sum(axis=0)
        at_once = rows["settlement"][rows["time"] == 0].max()
        found = (settlement - at_once) / (summary["final_settlement"] - at_once)
        print("largest error of U", np.abs(found - degree).max())
        self.assert_near(found, degree, 0.005, "0.5 % of the final settlement is what a consolidation promises")
        self.assert_refused(self.run_column(SCENES / "recorded_motion.toml", *settings(water__base="drained")),
                            "water.base", "coupled")

# SPDX-License-Identifier: BSD-3-Clause
"""Element tests of a layer's material: one point from Python, and the command isostat soil-test."""
import csv
import json
import math
import subprocess
import unittest

import numpy as np

from package import BINARIES, FolderTest, ROOT, TIME_LIMIT, isostat
from isostat import column
from isostat.campaign.soil_test import secant_and_damping, soil_test

SCENE = """title = "one layer"
[water]
drainage = "dry"
[[layer]]
name = "sand"
thickness = "10 m"
cells = 5
density = "2000 kg/m3"
material = "iwan"
k0 = 0.5
shear_velocity = "200 m/s"
[[layer]]
name = "grains"
thickness = "1 m"
cells = 1
material = "user"
[analysis]
duration = "1 s"
"""
UNDER_A_CRUST = """title = "a cell of sand under a crust"
[mesh]
dimension = 1
degree = 1
[water]
drainage = "undrained"
[[layer]]
name = "crust"
thickness = "4 m"
cells = 4
density = "2000 kg/m3"
permeability = "0 m/s"
material = "elastic"
shear_velocity = "400 m/s"
[[layer]]
name = "sand"
thickness = "1 m"
cells = 1
density = "2000 kg/m3"
permeability = "0 m/s"
material = "iwan"
shear_velocity = "200 m/s"
n1_60cs = 15
[[motion]]
axis = "x"
kind = "harmonic"
amplitude = "0.08 g"
frequency = "0.5 Hz"
duration = "45 s"
ramp = "0.5 s"
[analysis]
duration = "45 s"
[output]
depths = ["4.5 m"]
history_interval = "0.01 s"
"""
FREE_SURFACE = """title = "sand"
[mesh]
dimension = 1
degree = 2
[water]
drainage = "coupled"
[[layer]]
name = "sand"
thickness = "6 m"
cells = 6
density = "2000 kg/m3"
permeability = "1e-3 m/s"
material = "iwan"
shear_velocity = "200 m/s"
n1_60cs = 10
[[motion]]
axis = "x"
kind = "harmonic"
amplitude = "0.15 g"
frequency = "1 Hz"
duration = "15 s"
ramp = "2 s"
[analysis]
duration = "40 s"
[output]
depths = ["3 m"]
"""
MIDDLE = 2000 * 9.81 * 5  # Pa
COLUMN = ROOT / "apps/scenes/column/recorded_motion.toml"


def scene(**keys):
    return column.ColumnScene(SCENE, set={f"layer.0.{name}": value for name, value in keys.items()})


def blow_resistance(n, vertical):
    """Idriss and Boulanger (2008)."""
    curve = math.exp(n / 14.1 + (n / 126)**2 - (n / 23.6)**3 + (n / 25.4)**4 - 2.8)
    return curve * min(1.1, 1 - math.log(vertical / 101325) / (18.9 - 2.55 * math.sqrt(n)))


class SoilPointTest(FolderTest):
    def test_a_point_is_that_of_the_layer(self):
        point = column.SoilPoint(scene(material="elastic", poisson_ratio=0.25, k0=0.4))
        self.assert_close(point.stress, MIDDLE * np.array([-0.4, -0.4, -1, 0, 0, 0]), 1e-12, "round-off")
        self.assertEqual((point.layer, point.material, point.crr), ("sand", "elastic", None))
        gradient = np.zeros((3, 3))
        gradient[0, 2], gradient[2, 2] = 1e-4, -1e-4
        self.assert_close(point.deform(gradient)[[4, 2]], [8e3, -MIDDLE - 240e6 * 1e-4], 1e-12, "round-off; M = 3 G")
        path = point.fresh().shear_to(20e3)
        self.assert_near(path[-1] / [2.5e-4, 20e3, MIDDLE, 0.6 * MIDDLE, 1], [1, 1, 1, 1, 0], 1e-4,
                         "shear_to() lands within 1e-5 of sigma'_v")
        at_100 = column.SoilPoint(scene(), "sand", 100e3)
        self.assert_close(at_100.stress[2], -100e3, 1e-12, "round-off")

    def test_modulus_and_damping_of_small_strain_are_those_of_1_hertz(self):
        damped = column.SoilPoint(scene(material="elastic", damping=0.02))
        self.assert_close(damped.shear_modulus, 80e6, 1e-9, "round-off")
        modulus, damping = secant_and_damping(damped, 1e-6)
        self.assert_near([modulus / 80e6, damping / 0.02], [1, 1], 0.02, "1.6 % of least squares, third cycle")

    def test_mistakes_are_refused(self):
        for arguments, words in (((scene(), "snad"), 'no layer of this name. Give one of "sand", "grains"'),
                                 ((scene(name="grains"), "grains"), "several of this name.*layer.0"),
                                 ((scene(), "grains"), 'its material is "user"'),
                                 ((scene(), None, -1), "vertical_stress"),
                                 ((scene(), None, "1 Pa"), "vertical_stress: must be a number")):
            with self.assertRaisesRegex(isostat.InputError, words):
                column.SoilPoint(*arguments)
        with self.assertRaisesRegex(isostat.InputError, "limit = 0"):
            column.SoilPoint(scene()).shear_to(1e3, limit=0)

    def test_modulus_and_damping_are_those_of_the_hyperbola(self):
        """With Masing's rules: D = 4/pi (1 + 1/x) (1 - ln(1 + x)/x) - 2/pi, x = gamma/gamma_r."""
        found = soil_test(scene(contraction=0, dilation=0, k0=1, elements=64, reference_pressure=f"{MIDDLE!r} Pa"))
        gamma, ratio, damping = found.modulus.T
        x = gamma / (0.55 * MIDDLE / 80e6)
        self.assert_near(ratio, 1 / (1 + x), 0.005 / (1 + x), "64 elements are within 0.14 % of the curve")
        self.assert_near(damping, 4 / math.pi * (1 + 1 / x) * (1 - np.log1p(x) / x) - 2 / math.pi, 0.004,
                         "elements, and 200 steps of a loop")
        self.assertIsNone(found.crr)
        elastic = soil_test(scene(material="elastic"), ratios=[0.1])
        self.assert_close(elastic.modulus[:, 1], 1, 1e-9, "round-off")
        self.assert_near(elastic.modulus[:, 2], 0, 1e-9, "round-off")
        self.assertTrue(math.isinf(elastic.resistance[0, 1]))
        self.assertIsNone(soil_test(scene(material="mohr_coulomb")).crr)

    def test_sand_has_the_resistance_and_the_settlement_of_its_density(self):
        for n, surcharge in ((5, 0), (15, 0), (25, 0), (15, -48.1), (15, 101.9)):
            depth = {"thickness": f"{10 + 2 * surcharge / 19.62:.4f} m"} if surcharge else {}
            with self.subTest(n=n, surcharge=surcharge):
                found = soil_test(scene(n1_60cs=n, reference_pressure="100 kPa", **depth))
                target = blow_resistance(n, found.vertical_stress)
                self.assert_close(found.crr_of_scene, target, 1e-12, "round-off")
                self.assert_close(found.crr, target, 0.02, "1 % of contraction, half cycles; the limit is 5 %")
                self.assertTrue(0.2 <= found.b <= 0.5, found.b)
                strain, volume = found.reconsolidation[n < 10:].T  # very loose sand contracts more after small strains
                relation = 1.5 * math.exp(-0.369 * math.sqrt(n)) * np.minimum(0.08, strain)
                self.assert_near(volume, relation, (0.45 if n < 10 else 0.2) * relation, "theory_column.md: N below 10")

    def test_a_run_says_the_resistance_of_its_layers(self):
        short = column.ColumnScene(COLUMN, set={"layer.1.relative_density": 0.5, "analysis.duration": "0.1 s"})
        layers = column.run(short, self.folder / "run", quiet=True).summary["layers"]
        point = column.SoilPoint(short, "loose sand")
        self.assertEqual([layer.get("crr") for layer in layers], [None, point.crr, None])

    def test_a_column_liquefies_as_its_point_does(self):
        scene_of = column.ColumnScene(UNDER_A_CRUST)
        rows = column.run(scene_of, self.folder / "undrained", quiet=True).history
        time, ratio = np.array(rows["time"]), np.array(rows["d0_tau_xz"]) / rows["d0_sigma_v"][0]
        cycles = 0.5 * time[np.argmax(np.array(rows["d0_ru"]) >= 0.95)]
        csr = np.ptp(ratio[(time > 1) & (time < 9)]) / 2
        point = column.SoilPoint(scene_of, "sand")
        self.assert_close(cycles, point.cyclic_shear(csr * -point.stress[2], 100)[0], 0.2,
                          "waves in the crust, half cycles")

    def test_a_coupled_column_settles(self):
        """It does not rise; (25c) of its largest strains is 73 mm, of which dilation in shaking leaves a part."""
        found = column.run(column.ColumnScene(FREE_SURFACE), self.folder / "coupled", quiet=True).summary
        self.assert_near(found["settlement"], 0.044, 0.036, "what the text says")
        self.assertFalse([text for text in found["warnings"] if "risen" in text])

    def test_the_command_leaves_tables_and_a_figure(self):
        folder = self.folder / "tests"
        words = ["soil-test", COLUMN, "--layer", "loose sand", "--set", "layer.1.n1_60cs=10", "-o", folder]
        done = self.run_command(*words)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("CRR at 15 cycles", done.stdout)
        numbers = json.loads((folder / "soil_test.json").read_text())
        self.assertEqual(numbers["layer"], "loose sand")
        self.assert_close(numbers["CRR_15"], numbers["CRR_of_scene"], 0.02, "as above")
        with open(folder / "resistance.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), 5)
        for name in ("modulus.csv", "path.csv", "reconsolidation.csv", "summary.txt", "report.html",
                     "figures/soil_test.png"):
            self.assertTrue((folder / name).is_file(), name)
        for more, code in ((["--ratios", "0.1,0.2", "--vertical-stress", "50 kPa", "--no-figures"], 0),
                           (["--layer", "dense sand"], 2), (["--layer", "none"], 2), (["--vertical-stress", "50"], 2)):
            self.assertEqual(self.run_command(*words, *more).returncode, code, more)
        self.assertEqual(json.loads((folder / "soil_test.json").read_text())["layer"], "loose sand")
        done = self.run_command("soil-test", COLUMN, "--layer", "loose sand", "--ratios", "0.1", "--no-figures",
                                cwd=self.folder)
        left = self.folder / "results/recorded_motion_soil_test_loose_sand/summary.txt"
        self.assertTrue(left.is_file(), done.stderr)

    def run_command(self, *words, **where):
        return subprocess.run([BINARIES / "isostat", *map(str, words)], **where, capture_output=True, text=True,
                              timeout=TIME_LIMIT, check=False)


if __name__ == "__main__":
    unittest.main()

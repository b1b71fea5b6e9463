# SPDX-License-Identifier: BSD-3-Clause
"""Sands in scenes: what runs, libraries and columns make of them, and isostat sands."""
from support import AppTest, tiny_scene

SAND = """[sand]
misfit = 0.2
highest_pressure = "40 kPa"
[contact]
young = "1 GPa"
friction = "22 deg"
[specimen]
domain = "periodic-cell"
preparation_friction = "10 deg"
"""
SCENE = """title = "sand in a cell"
sand = "{sand}"
[grading]
truncate = [20, 80]
grains = 150
cloud_edge = "2.45 mm"
[specimen]
pressure = "50 kPa"
"""
COLUMN = """[grains]
library = "library.h5"
sand = "{sand}"
[water]
drainage = "undrained"
[[layer]]
material = "grains"
thickness = "2 m"
cells = 2
[[motion]]
kind = "ricker"
amplitude = "0.1 g"
frequency = "2 Hz"
[analysis]
kind = "dynamic"
duration = "0.1 s"
"""


class Sands(AppTest):
    def test_run_library_and_column_know_their_sand(self):
        self.write("my_sand.toml", SAND)
        scene = self.write("scene.toml", SCENE.format(sand="my_sand.toml"))
        warned = "specimen.pressure = 50 kPa, but the sand my_sand was compared with tests at up to 40 kPa"
        run = self.run_test(scene, "-o", "out", "--no-figures")
        self.assert_done(run)
        self.assertIn(warned, run.stderr)
        (self.folder / "my_sand.toml").rename(self.folder / "other.toml")
        again = self.run_test("out/scene.toml", "-o", "again", "--no-figures")  # without the file
        self.assert_done(again)
        self.assertIn(warned, again.stderr)
        self.assertEqual((self.folder / "out/scene.toml").read_text(), (self.folder / "again/scene.toml").read_text())

        self.write("scene.toml", SCENE.format(sand="other.toml"))
        self.assert_done(self.run_app("isostat", "library", scene, "-o", "library.h5", "-q", "--set",
                                      "specimen.pressure=10 kPa"))
        column = self.write("column.toml", COLUMN.format(sand="other"))
        checked = self.run_app("soil_column", column, "--validate")
        self.assert_done(checked)
        self.assertIn('sand = "other"', checked.stdout)
        self.assertNotIn("compared with tests", checked.stderr)
        deep = self.run_app("soil_column", column, "--validate", "--set", "load.surcharge=100 kPa")
        self.assertRegex(deep.stderr, r"layer\.0: p' in situ is .* kPa in its middle, but the sand other was compared")
        column = self.write("column.toml", COLUMN.format(sand="third"))
        self.assert_refused(self.run_app("soil_column", column, "--validate"), "grains.sand = third",
                            "has specimens of other", "isostat library")

    def test_list(self):
        listed = self.run_app("isostat", "sands")
        self.assert_done(listed)
        for word in ("karlsruhe-fine-sand\n", "misfit           fitted 0.196, not fitted 0.29", "100 kPa to 200 kPa",
                     "0.4915, 0.7389", "missed: extension by 6 to 15 deg, undrained cyclic (over 100 cycles for 18)"):
            self.assertIn(word, listed.stdout)
        own = self.run_app("isostat", "sands", self.write("mine.toml", SAND))
        self.assertIn("p0'              up to 40 kPa", own.stdout)
        named = self.run_app("isostat", "sands", "karlsruhe-fine-sand")
        self.assertIn(named.stdout, listed.stdout)
        self.assertIn("scenes/sands/karlsruhe-fine-sand.toml", named.stdout)
        self.assert_refused(self.run_app("isostat", "sands", "karlsruhe"), "is no sand. There are karlsruhe-fine-sand")
        self.assert_refused(self.run_app("isostat", "sands", self.write("wrong.toml", SAND + "[motion]\n")),
                            "wrong.toml:10: motion; a sand has")

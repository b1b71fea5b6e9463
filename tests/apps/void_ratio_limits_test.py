# SPDX-License-Identifier: BSD-3-Clause
"""The program void_ratio_limits on a few grains: what it leaves behind, and its refusals."""

from support import AppTest, contents, tiny_scene

LIMITS = tiny_scene(specimen='preparation_friction = "0 deg"\npressure = "100 kPa"', motion="damping = 0.4",
                    stages="# none")
QUICK = ("--set", "grading.grains=150", "--set", "grading.cloud_edge=2.5 mm", "--set", "contact.young=10 GPa",
         "--quiet")


class VoidRatioLimits(AppTest):
    def test_finds_both(self):
        scene = self.write("limits.toml", LIMITS)
        result = self.run_app("void_ratio_limits", scene, "-o", "out", *QUICK)
        self.assert_done(result)
        for word in ("e_min", "e_max", "0.568", "0.841", "0.677", "1.054", "contact modulus",
                     "its void ratio means little"):
            self.assertIn(word, result.stdout)
        written = self.summary_of("out", "limits.json")
        limits = {name: item["value"] for name, item in written.items()}
        header, row = (self.folder / "out/limits.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual([cell.split(" (")[0] for cell in header.split(",")], list(limits))
        self.assertEqual([float(cell) for cell in row.split(",")], list(limits.values()))
        self.assertLess(limits["e_min"], limits["e_max"])
        self.assert_below(limits["max_overlap"], 1e-3, "what the softened modulus is chosen for")
        self.assertEqual(limits["grains"], 150)
        for packing in ("densest.h5", "loosest.h5"):  # specimens that other programs read
            self.assert_done(self.run_app("micromechanics", f"out/{packing}", "--output", "table.csv"))
        before = contents(self.folder / "out")
        self.assert_refused(self.run_app("void_ratio_limits", scene, "-o", "out", *QUICK), "exists", "--overwrite")
        self.assertEqual(contents(self.folder / "out"), before)

    def test_of_a_cell(self):
        scene = self.write("limits.toml", LIMITS)
        result = self.run_app("void_ratio_limits", scene, "-o", "out", *QUICK, "--set", "specimen.domain=periodic-cell",
                              "--set", "grading.grains=400", "--set", "grading.truncate=[10, 90]")
        self.assert_done(result)
        limits = self.summary_of("out", "limits.json")
        self.assertEqual(limits["e_min"]["value"], limits["e_min_inside"]["value"])
        self.assertLess(limits["e_min"]["value"], limits["e_max_inside"]["value"])
        self.assert_below(limits["dense_unbalanced"]["value"], 5e-5, "at rest, as every specimen")

    def test_refusals(self):
        scene = self.write("limits.toml", LIMITS)
        for change, parts in ((["--set", "specimen.preparation_friction=5 deg"], ("preparation_friction", "0 deg")),
                              (["--set", "specimen.relative_density=0.5"], ("preparation_friction", "0 deg")),
                              (["--set", "grading.grain=5"], ("grading.grain", "grading.grains"))):
            self.assert_refused(self.run_app("void_ratio_limits", scene, "-o", "out", *QUICK, *change), *parts)
            self.assertFalse((self.folder / "out").exists())
        self.assert_refused(self.run_app("void_ratio_limits", "nowhere.toml"), "nowhere.toml", "does not exist")
        self.assert_refused(self.run_app("void_ratio_limits", scene, "-o", "out", "--fall", "0.5"), "fall = 0.5",
                            ">= 1")
        self.assertFalse((self.folder / "out").exists())
        stages = self.write("stages.toml", tiny_scene(specimen='preparation_friction = "0 deg"'))
        self.assert_refused(self.run_app("void_ratio_limits", stages, "-o", "out"), "stages.toml", "stage")

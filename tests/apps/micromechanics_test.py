# SPDX-License-Identifier: BSD-3-Clause
"""The program micromechanics: its tables against the history of the run and against each other, and its refusals."""
import csv
import math
import re

import h5py
import numpy as np

from support import AppTest, CYCLIC, contents, tiny_scene


def read_table(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names = [re.fullmatch(r"(\S+) \(([^()]+)\)", cell).group(1) for cell in rows[0]]  # every cell: name (unit)
    return {name: np.array([float(row[k]) for row in rows[1:]]) for k, name in enumerate(names)}


class Micromechanics(AppTest):
    def setUp(self):
        super().setUp()
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=6000)))
        self.assert_done(self.run_test(scene, "-o", "run"))

    def test_tables(self):
        result = self.run_app("micromechanics", "run", "--no-figures")
        self.assert_done(result)
        for word in ("first", "last", "I_R"):
            self.assertIn(word, result.stdout)
        folder = self.folder / "run/micromechanics"
        table, history = read_table(folder / "micromechanics.csv"), read_table(self.folder / "run/history.csv")
        n = len(list((self.folder / "run/snapshots").iterdir()))
        self.assertEqual(len(table["step"]), n)
        self.agree_with_history(table, history)
        self.agree_among_each_other(table)
        self.check_distributions(folder, table)

    def agree_with_history(self, table, history):
        rows = [int(np.flatnonzero(history["step"] == step)[0]) for step in table["step"]]
        for name in ("p", "q", "IR", "Z", "Fyy", "a_c", "a_n", "a_t", "eps_y", "E_el", "unbalanced"):
            expected = history[name][rows]
            self.assert_near(table[name], expected, 1e-8 * np.abs(expected) + 1e-12,
                             f"ten digits in the tables ({name})")

    def agree_among_each_other(self, table):
        digits = "ten digits in the table"
        self.assert_near(table["Fxx"] + table["Fyy"] + table["Fzz"], 1, 1e-9, digits)
        for kind in ("F_strong_", "F_weak_"):
            self.assert_near(table[kind + "xx"] + table[kind + "yy"] + table[kind + "zz"], 1, 1e-9, digits)
        for axis in "xyz":
            wall = table[f"S_{axis}{axis}_wall"]
            self.assert_near(table[f"S_{axis}{axis}_LW"], wall, 0.02 * np.abs(wall),
                             "inertia: the test is not wholly quasi-static")
        stored = sum(table["E_" + part] for part in ("normal", "shear", "rolling", "twisting", "wall"))
        self.assert_near(stored, table["E_el"], 1e-9 * table["E_el"], digits)
        along_y = table["a_c_yy"] - 0.5 * (table["a_c_xx"] + table["a_c_zz"])
        self.assert_near(along_y, table["a_c"], 1e-8, digits)
        self.assertTrue((table["a_n_intensity"] >= np.abs(table["a_n"]) * (1 - 1e-9)).all())

    def check_distributions(self, folder, table):
        forces, roses = read_table(folder / "force_distribution.csv"), read_table(folder / "roses.csv")
        grains = read_table(folder / "coordination.csv")
        for k in range(len(table["step"])):
            of_forces, of_roses = forces["snapshot"] == k, roses["snapshot"] == k
            self.assertEqual(forces["normal"][of_forces].sum(), table["C"][k])
            self.assertEqual(forces["tangential"][of_forces].sum(), table["C"][k])
            self.assertEqual(of_roses.sum(), 36)
            for plane in ("xy", "xz"):
                density = roses[plane + "_density"][of_roses]
                self.assert_near(density.mean(), 1, 5e-9, "ten digits in the table")
                self.assert_near(density[:18], density[18:], 1e-8 * density[18:],
                                 "ten digits of the same number, for n and -n")
            of_grains = grains["snapshot"] == k
            self.assertEqual((grains["contacts"] * grains["grains"])[of_grains].sum(), 2 * table["C"][k])
            self.assertEqual(grains["grains"][of_grains].sum(), 200)

    def test_single_files(self):
        snapshot = "run/snapshots/snapshot_0001.h5"
        self.assert_done(self.run_app("micromechanics", snapshot, "--output", "one", "--no-figures"))
        self.assertEqual(len(read_table(self.folder / "one/micromechanics.csv")["p"]), 1)
        specimen = next(self.cache.glob("*.h5"))
        self.assert_done(self.run_app("micromechanics", specimen, "--output", "specimen.csv"))
        pressure = read_table(self.folder / "specimen.csv")["p"][0]
        self.assert_close(pressure, 200e3, 0.01, "the servo of the preparation stops within 0.3 % in each direction")

    def test_packing_of_another_program(self):
        """A face-centred packing whose spheres overlap by 0.2 % of their radius: twelve contacts each."""
        edge, n = 1.998e-4 * math.sqrt(2), 3
        rows = "".join(f"{edge * (x + a)!r} {edge * (y + b)!r} {edge * (z + c)!r} 1e-4\n"
                       for x in range(n) for y in range(n) for z in range(n)
                       for a, b, c in ((0, 0, 0), (0.5, 0.5, 0), (0.5, 0, 0.5), (0, 0.5, 0.5)))
        self.write("fcc.txt", f"##PERIODIC:: {n * edge!r} {n * edge!r} {n * edge!r}\n{rows}")
        self.assert_done(self.run_app("isostat", "convert", "fcc.txt", "fcc.h5"))
        result = self.run_app("micromechanics", "fcc.h5", "--output", "fcc.csv")
        self.assert_done(result)
        self.assertIn("warning: fcc.h5: it is stored without contacts", result.stderr)
        table = read_table(self.folder / "fcc.csv")
        self.assertEqual(table["C"][0], 6 * 4 * n**3)
        self.assertEqual(table["Z"][0], 12)
        for name in table:
            self.assertTrue(np.isfinite(table[name]).all() or name.endswith("_wall"), name)  # a cell has no walls
        self.assertGreater(table["p"][0], 0)
        self.assertEqual(table["E_shear"][0], 0)
        for component in ("Fxx", "Fyy", "Fzz"):
            self.assert_near(table[component], 1 / 3, 1e-9, "ten digits in the table")

    def test_figures(self):
        for path in sorted((self.folder / "run/snapshots").iterdir())[2:]:  # two are enough to draw
            path.unlink()
        self.assert_done(self.run_app("micromechanics", "run", "--output", "it's here"))
        figures = sorted(path.name for path in (self.folder / "it's here/figures").iterdir())
        self.assertEqual(figures, ["fig_anisotropies.png", "fig_force_distribution.png", "fig_roses.png"])
        self.assertIn('<figure id="fig_roses"', (self.folder / "it's here/report.html").read_text(encoding="utf-8"))

    def test_run_is_not_touched(self):
        before = contents(self.folder / "run")
        self.assert_done(self.run_app("micromechanics", "run", "--output", "elsewhere", "--no-figures"))
        self.assertEqual(contents(self.folder / "run"), before)

    def refuse(self, *parts, results="run", output="out"):
        self.assert_refused(self.run_app("micromechanics", results, "--output", output), *parts)
        self.assertFalse((self.folder / "out").exists())

    def test_missing_results(self):
        self.refuse("nowhere", "does not exist", results="nowhere")

    def test_no_snapshots(self):
        (self.folder / "empty").mkdir()
        self.refuse("empty", "no snapshots", "output.snapshots", results="empty")

    def test_truncated(self):
        path = self.folder / "run/snapshots/snapshot_0001.h5"
        path.write_bytes(path.read_bytes()[:-3000])
        self.refuse("snapshot_0001.h5", "truncated")

    def test_output_below_a_file(self):
        self.write("file", "precious")
        self.refuse("file/out", "cannot be made", output="file/out")
        self.assertEqual((self.folder / "file").read_text(encoding="utf-8"), "precious")

    def test_foreign(self):
        with h5py.File(self.folder / "run/snapshots/snapshot_0001.h5", "w") as file:
            file["x"] = 1.0
        self.refuse("snapshot_0001.h5", "isostat-snapshot")

    def test_missing_dataset(self):
        with h5py.File(self.folder / "run/snapshots/snapshot_0001.h5", "r+") as file:
            del file["snapshot/contacts/normal_force"]
        self.refuse("snapshot_0001.h5", "normal_force")

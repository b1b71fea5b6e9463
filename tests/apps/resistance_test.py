# SPDX-License-Identifier: BSD-3-Clause
"""isostat resistance on a few grains: tables and fit, runs that are kept, that fail, that are
interrupted, and its refusals."""
import csv
import signal

import numpy as np

from support import AppTest, MONOTONIC, contents, tiny_scene

STAGE = '[[stage]]\nkind = "{}"\nuntil = {{ strain = 0.05 }}\nliquefaction_ratio = 0.3\n'
CELL = 'domain = "periodic-cell"\npreparation_friction = "14 deg"'
SHEAR = tiny_scene(specimen=CELL, motion='strain_rate = "5 1/s"', stages=STAGE.format("undrained-cyclic-simple-shear"))
TRIAXIAL = tiny_scene(stages=STAGE.format("undrained-cyclic"))
RATIOS = ("--ratios", "0.12,0.25")


class LiquefactionResistance(AppTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("shear.toml", SHEAR)

    def run_it(self, *arguments, scene=None):
        return self.run_app("isostat", "resistance", scene or self.scene, *arguments, "--cycles", "15")

    def table(self, folder="out"):
        with open(self.folder / folder / "resistance.csv", newline="", encoding="utf-8") as file:
            return [{name.split(" (")[0]: cell for name, cell in row.items()} for row in csv.DictReader(file)]

    def outcome(self, folder="out"):
        return [{name: cell for name, cell in row.items() if name != "wall"} for row in self.table(folder)]

    def finish_times(self, folder="out"):
        return {path.parent.name: path.stat().st_mtime_ns
                for path in (self.folder / folder).glob("runs/*/summary.json")}

    def test_curve(self):
        result = self.run_it(*RATIOS, "-n", "2", "--jobs", "2", "-o", "out")
        self.assert_done(result)
        for word in ("CSR", "seed by seed", "void ratios"):
            self.assertIn(word, result.stdout)
        self.assertIn("100 %", result.stderr)
        rows = self.table()
        self.assertEqual([(row["CSR"], row["seed"]) for row in rows],
                         [("0.25", "1"), ("0.12", "1"), ("0.25", "2"), ("0.12", "2")])
        self.check_fit(rows)
        self.check_one_run(rows[0])
        before = self.finish_times()
        self.assert_done(self.run_it(*RATIOS, "-n", "2", "-o", "out", "--no-figures"))  # all there: nothing runs
        self.assertEqual(self.finish_times(), before)
        self.assertEqual(self.outcome(), [{k: v for k, v in row.items() if k != "wall"} for row in rows])
        self.assert_done(self.run_it("--ratios", "0.25", "-n", "3", "-o", "out", "--no-figures"))  # one more specimen
        self.assertEqual(set(self.finish_times()) - set(before), {"csr0.25_seed3", "specimen_seed3"})
        self.assertEqual({name: t for name, t in self.finish_times().items() if name in before}, before)

    def test_two_runs(self):
        result = self.run_it(*RATIOS, "-n", "1", "-o", "out", "--no-figures")
        self.assert_done(result)
        fit = self.summary_of("out", "resistance.json")["fit"]
        self.assertEqual(fit["runs"], 2, "both liquefy")
        self.assertIn("whose error two runs cannot give", result.stdout)
        self.assertIsNone(fit["b_error"])
        self.assertIsNone(fit["R2"])
        self.assertNotIn("failed", result.stderr)

    def test_all_within_a_cycle_give_no_slope(self):
        result = self.run_it("--ratios", "0.6,0.9", "-n", "1", "-o", "out", "--no-figures")
        self.assert_done(result)
        self.assertTrue(all(float(row["N_liquefaction"]) <= 1 for row in self.table()), self.table())
        self.assertIn("none: fewer than two ratios have a run that liquefied, or all within a cycle", result.stdout)
        self.assertIsNone(self.summary_of("out", "resistance.json")["fit"])

    def check_fit(self, rows):
        """log N against log CSR, by numpy."""
        liquefied = [(float(row["CSR"]), float(row["N_liquefaction"])) for row in rows if row["N_liquefaction"]]
        self.assertEqual(len(liquefied), sum(row["status"] == "liquefied" for row in rows))
        self.assertGreater(len({ratio for ratio, _ in liquefied}), 1, rows)
        ratio, cycles = np.log(np.array(liquefied).T)
        slope, shift = np.polyfit(ratio, cycles, 1)
        fit = self.summary_of("out", "resistance.json")["fit"]
        digits = "digits of the table that the fit is repeated from"
        self.assert_near(fit["b"], -1 / slope, 5e-7, digits)
        self.assert_near(fit["a"], np.exp(-shift / slope), 5e-7, digits)
        self.assert_near(fit["CSR_15"], fit["a"] * 15 ** -fit["b"], 5e-7, digits)
        self.assertEqual(fit["runs"], len(liquefied))
        self.assertTrue((self.folder / "out/figures/resistance.png").exists())
        report = (self.folder / "out/report.html").read_text(encoding="utf-8")
        self.assertIn(f"CSR = {fit['a']:.4f} N^-{fit['b']:.3f} by {fit['runs']} runs", report)

    def check_one_run(self, row):
        """The table agrees with the summary of the run."""
        summary = self.summary_of(f"out/runs/csr{row['CSR']}_seed{row['seed']}")
        self.assertEqual(float(row["N_liquefaction"]), max(0.25, summary["liquefaction"]["cycle"]))
        self.assert_near(float(row["e"]), summary["void_ratio"], 5e-5, "four digits in the table")
        self.assertEqual(summary["CSR"], 0.25)
        self.assert_near(summary["stress_ratio_max"], 0.25, 0.02, "the overshoot of a fast test of 200 grains")

    def test_failure_stops_nothing(self):
        broken = self.folder / "out/runs/csr0.25_seed1/checkpoint"
        self.assert_done(self.run_it("--ratios", "0.2", "-n", "1", "-o", "out", "--no-figures"))
        broken.mkdir(parents=True)
        (broken / "last.h5").write_text("not a checkpoint", encoding="utf-8")
        result = self.run_it("--ratios", "0.25,0.2,0.15", "-n", "1", "-o", "out", "--no-figures")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("failed: CSR 0.25, seed 1: exit code", result.stdout)
        self.assertEqual([row["status"] == "failed" for row in self.table()], [True, False, False])
        self.assertNotEqual(self.table()[1]["N_applied"], "0")

    def test_interrupt(self):
        arguments = (self.scene, "--ratios", "0.1,0.15,0.25", "-n", "1", "--cycles", "15", "--no-figures", "-o")
        code, said = self.stop_when(lambda: "csr0.25_seed1" in self.finish_times(), "csr0.25_seed1", signal.SIGINT,
                                    self.command("isostat", "resistance", *arguments, "out"))
        self.assertEqual(code, 130, said)
        self.assertEqual(self.table()[0]["status"], "liquefied")
        self.assertEqual(self.table()[-1]["status"], "missing")
        before = self.finish_times()
        self.assert_done(self.run_app("isostat", "resistance", *arguments, "out"))
        self.assertEqual({name: t for name, t in self.finish_times().items() if name in before}, before)
        self.assert_done(self.run_app("isostat", "resistance", *arguments, "at_once"))
        self.assertEqual(self.outcome(), self.outcome("at_once"))

    def test_a_run_killed_between_two_names_of_its_checkpoint(self):
        """It continues from there, and is not begun again."""
        arguments = (self.scene, "--ratios", "0.1", "-n", "1", "--cycles", "15", "--no-figures", "-o", "out",
                     "--set", "output.checkpoint=1e-9 min")
        checkpoint = self.folder / "out/runs/csr0.1_seed1/checkpoint"
        code, said = self.stop_when((checkpoint / "previous.h5").exists, "two checkpoints", signal.SIGINT,
                                    self.command("isostat", "resistance", *arguments))
        self.assertEqual(code, 130, said)
        (checkpoint / "last.h5").rename(checkpoint / "fresh.h5")
        self.assert_done(self.run_app("isostat", "resistance", *arguments))
        self.assertIn("--resume", (checkpoint.parent / "provenance.txt").read_text(encoding="utf-8"))

    def test_triaxial_ratio(self):
        scene = self.write("triaxial.toml", TRIAXIAL)
        self.assert_done(self.run_it("--ratios", "0.15", "-n", "1", "-o", "out", "--no-figures",
                                     "--set", "stage.0.max_steps=50", scene=scene))
        text = (self.folder / "out/scenes/csr0.15_seed1.toml").read_text(encoding="utf-8")
        self.assertIn('deviator_amplitude = "60 kPa"', text)  # 2 x 0.15 x 200 kPa

    def test_refusals(self):
        for ratios, parts in (("0.1,abc", ("abc", "0.10,0.15")), ("0", ('"0"', "(0, 1]")), ("0.2,2", ('"2"',)),
                              ("0.1,0.1", ("0.1 appears twice", "--realisations")), (",", ("no number",))):
            self.assert_refused(self.run_it("--ratios", ratios, "-o", "out"), "--ratios", *parts)
        monotonic = self.write("monotonic.toml", tiny_scene(stages=MONOTONIC.format(steps=10)))
        self.assert_refused(self.run_it(*RATIOS, "-o", "out", scene=monotonic), "no cyclic stage", "undrained-cyclic")
        self.assert_refused(self.run_it(*RATIOS, scene="nowhere.toml"), "nowhere.toml", "does not exist")
        packing = self.write("packing.h5", "")
        self.assert_refused(self.run_it(*RATIOS, "-o", "out", "--set", f"specimen.file={packing}",
                                        scene=self.write("triaxial.toml", TRIAXIAL)), "specimen.file",
                            "--realisations 1")
        self.assertFalse((self.folder / "out").exists())

    def test_folder_of_others(self):
        quick = ("--ratios", "0.25", "-n", "1", "--no-figures", "-o", "out")
        self.assert_done(self.run_it(*quick))
        before = contents(self.folder / "out")
        self.assert_refused(self.run_it(*quick, "--set", "motion.damping=0.3"), "out", "another scene", "damping",
                            "--overwrite")
        self.assertEqual(contents(self.folder / "out"), before)
        self.assert_done(self.run_it(*quick, "--set", "motion.damping=0.3", "--overwrite"))

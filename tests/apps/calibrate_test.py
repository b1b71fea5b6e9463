# SPDX-License-Identifier: BSD-3-Clause
"""isostat calibrate on a few grains: what it leaves, calibrations that are killed, interrupted, and asked for more,
trials that fail, and its refusals."""
import csv
import os
import re
import shutil
import signal
import tomllib

import numpy as np

from support import AppTest, columns, contents, tiny_scene

os.environ["ISOSTAT_INSTRUCTION_SET"] = "SSE4"  # what 200 grains do, bit for bit, on any machine

STAGES = '[[stage]]\nkind = "drained"\nstrain = 0.02\n'
SCENE = tiny_scene(stages=STAGES, motion='inertial_number = 4e-3')
PLAN = """title = "tiny"
scene = "scene.toml"
[specimens]
grains = 200
seeds = 2
full_grains = 400
[budget]
trials = {trials}
[optimiser]
method = "sbplx"
design = 2
[misfit]
points = 10
[[parameter]]
key = "{key}"
bounds = {bounds}
[[curve]]
name = "fitted"
file = "lab.csv"
test = "drained"
strain_end = 0.02
{curve}
[[curve]]
name = "unseen"
file = "lab.csv"
test = "drained"
strain_end = 0.01
blind = true
"""
LABORATORY = """eps_a[%],eps_v[%],sigma_v[kPa],sigma_r[kPa]
0,0,200,200
0.5,0.2,400,200
1,0.25,450,200
2,0.3,500,200
"""
FRICTION = {"key": "contact.friction", "bounds": '["10 deg", "30 deg"]'}
LEFT = ("trials.csv", "curves.csv", "calibrate.json", "best_scene.toml", "best_sand.toml", "best/fitted.toml",
        "best/unseen.toml", "plan.toml", "scene.toml")


def plan_text(trials=4, curve="", **parameter):
    return PLAN.format(trials=trials, curve=curve, **(parameter or FRICTION))


class Calibrate(AppTest):
    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)
        self.write("lab.csv", LABORATORY)
        self.plan = self.write("plan.toml", plan_text())

    def run_it(self, *arguments, plan=None):
        return self.run_app("isostat", "calibrate", plan or self.plan, "--jobs", "2", *arguments)

    def whole(self, folder):
        """A calibration without any disturbance, made once."""
        if not (self.cache / "whole").exists():
            self.assert_done(self.run_it("-o", self.cache / "whole", "--no-figures"))
        shutil.copytree(self.cache / "whole", self.folder / folder)

    def trials(self, folder="out"):
        with open(self.folder / folder / "trials.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def result(self, folder="out"):
        return self.summary_of(folder, "calibrate.json")

    def finish_times(self, folder="out"):
        return {path.parent: path.stat().st_mtime_ns for path in (self.folder / folder).glob("runs/*/*/summary.json")}

    def assert_same_calibration(self, one, other):
        for name in LEFT:
            self.assertEqual((self.folder / one / name).read_bytes(), (self.folder / other / name).read_bytes(), name)
        histories = sorted(path.relative_to(self.folder / one)
                           for path in (self.folder / one).glob("runs/*/*/history.csv"))
        self.assertGreater(len(histories), 6)
        for path in histories:
            self.assertEqual((self.folder / one / path).read_bytes(), (self.folder / other / path).read_bytes(), path)


class Results(Calibrate):
    def test_what_it_leaves(self):
        result = self.run_it("-o", "out")
        self.assert_done(result)
        rows, found = self.trials(), self.result()
        self.assertEqual(len(rows), 4)
        self.assertEqual(rows[0]["contact.friction (deg)"], "18")  # the scene's
        best = min(rows, key=lambda row: float(row["misfit (-)"]))
        self.assertEqual(found["best"], int(best["trial (-)"]))
        self.assertEqual(found["parameters"][0]["best"], best["contact.friction (deg)"] + " deg")
        self.assertIn(f'friction = "{found["parameters"][0]["best"]}"',
                      (self.folder / "out/best_scene.toml").read_text(encoding="utf-8"))
        self.assertEqual([curve["blind"] for curve in found["curves"]], [False, True])
        self.assertTrue(all(curve[which] > 0 for curve in found["curves"] for which in ("start", "best", "scatter")))
        for word in ("contact.friction (deg)", "fitted", "unseen", "blind", "ended because budget.trials = 4"):
            self.assertIn(word, result.stdout)
        self.assertRegex(result.stderr, r"100 %  trial 4 of at most 4: misfit \d\.\d+, best")
        self.check_misfit(rows[0])
        for name in ("curves", "convergence", "tradeoffs"):
            self.assertTrue((self.folder / f"out/figures/{name}.png").exists())
        self.assertIn("because budget.trials = 4", (self.folder / "out/report.html").read_text(encoding="utf-8"))
        for name in ("best_scene", "best/fitted"):  # ready to run
            self.assert_done(self.run_test(self.folder / f"out/{name}.toml", "--validate"))
        self.check_sand(found)

    def check_sand(self, found):
        """A scene of nothing but the sand that was left is the best one, and knows its tests."""
        checked = self.run_test(self.write("of_sand.toml", 'sand = "out/best_sand.toml"\n'), "--validate")
        self.assert_done(checked)
        scene = tomllib.loads(checked.stdout)
        self.assertEqual(scene["contact"]["friction"], found["parameters"][0]["best"])
        sand = scene["sand"]
        self.assertEqual((sand["name"], sand["misfit"], sand["blind_misfit"]), (
            "best_sand", round(found["misfit_best"], 4), round(found["curves"][1]["best"], 4)))
        self.assertEqual((sand["tests"], sand["lowest_pressure"]), ("fitted: fitted; not fitted: unseen", "200 kPa"))
        self.assertLess(sand["lowest_void_ratio"], sand["highest_void_ratio"])

    def check_misfit(self, row):
        """The equation of isostat.campaign.calibrate.curve, by numpy, from the runs' histories."""
        laboratory = np.genfromtxt(LABORATORY.splitlines(), delimiter=",", skip_header=1).T
        strain = 0.02 * np.arange(1, 11) / 10
        curves = []
        for path in sorted((self.folder / "out" / row["folder"]).glob("fitted_seed?/history.csv")):
            rows = columns(path)
            eps = [rows[f"eps_{axis}"] for axis in "xyz"]
            linear = 1 - np.exp(-eps[1])
            curves.append([np.interp(strain, linear, y) for y in (rows["q"], 1 - np.exp(-sum(eps)))])
        self.assertEqual(len(curves), 2)
        measured = [np.interp(strain, laboratory[0] / 100, y)
                    for y in (1e3 * (laboratory[2] - laboratory[3]), laboratory[1] / 100)]
        off = [(model - lab) / np.abs(lab).max() for model, lab in zip(np.mean(curves, axis=0), measured)]
        self.assert_near(float(row["misfit of fitted (-)"]), np.sqrt(np.mean(np.square(off))), 1e-6,
                         "six digits in the table")

    def test_undrained_extension(self):
        """The model's strains grow in the direction of the test; p' takes the place of the volume."""
        self.write("lab.csv", "eps_a[%],p[kPa],q[kPa]\n0,200,0\n-0.5,150,-60\n-1,140,-70\n-2,150,-90\n")
        text = plan_text(1).replace('"drained"', '"undrained"\ndirection = "extension"')
        self.assert_done(self.run_it("-o", "out", "--no-figures", plan=self.write("plan.toml", text)))
        with open(self.folder / "out/curves.csv", newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["curve"] == "fitted"]
        self.assertEqual({row["second"] for row in rows}, {"p' (Pa)"})
        column = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]
                  if name not in ("curve", "second")}
        self.assert_near(column["eps_1 (-)"], 0.002 * np.arange(1, 11), 1e-9, "six digits of shares of 0.02")
        self.assertTrue((column["q best (Pa)"] < 0).all())
        self.assertTrue((column["second best"] > 0).all())
        off = [(column[f"{name} best{unit}"] - column[f"{name} laboratory{unit}"]) /
               np.abs(column[f"{name} laboratory{unit}"]).max() for name, unit in (("q", " (Pa)"), ("second", ""))]
        misfit = np.sqrt(np.mean(np.square(off)))
        self.assert_near(self.result()["misfit_best"], misfit, 1e-5, "six digits in the table")
        self.assertEqual([curve["failure"] for curve in self.result()["curves"]], ["", ""])  # the start is the best
        self.assertIn('direction = "extension"', (self.folder / "out/best/fitted.toml").read_text(encoding="utf-8"))

    def test_failed_trials_end_nothing(self):
        """Densities of which the upper ones cannot be reached; a failed trial is not the best."""
        self.write("scene.toml", SCENE.replace('preparation_friction = "10 deg"',
                                               "relative_density = 0.1\ndensity_tolerance = 0.03"))
        text = plan_text(4, key="specimen.relative_density", bounds="[0.05, 0.99]").replace("seeds = 2", "seeds = 1")
        plan = self.write("dense.toml", text.replace("density\"\n", "density\"\nstart = 0.1\n")
                          .replace("[misfit]\n", "[misfit]\npenalty = 1e-6\n"))
        result = self.run_it("-o", "out", "--no-figures", plan=plan)
        self.assert_done(result)
        failed = [row["failed curves"] for row in self.trials()]
        self.assertEqual(failed[0], "")
        self.assertIn("fitted", failed)
        self.assertEqual(self.trials()[failed.index("fitted")]["misfit (-)"], "0.000001")  # the penalty
        best = self.trials()[self.result()["best"] - 1]
        self.assertEqual(best["failed curves"], "")
        self.assertGreater(float(best["misfit (-)"]), 1e-6)
        self.assertIn("(a run FAILED)", result.stderr)
        self.assertRegex(result.stdout, r"failed: trial \d, fitted, seed 1: error: specimen density cannot be reached")
        before = contents(self.folder / "out/runs")
        self.assert_done(self.run_it("-o", "out", "--no-figures", plan=plan))  # nor are they tried again
        self.assertEqual(contents(self.folder / "out/runs"), before)

    def test_a_file_with_a_byte_order_mark(self):
        lab = self.folder / "lab.csv"
        lab.write_bytes(b"\xef\xbb\xbf" + lab.read_bytes())
        self.assert_done(self.run_it("--dry-run"))


class Resume(Calibrate):
    def stop(self, happened, what, with_signal):
        """The exit code of a calibration that gets a signal."""
        command = self.command("isostat", "calibrate", self.plan, "--jobs", "2", "-o", "parts", "--no-figures")
        return self.stop_when(happened, what, with_signal, command)[0]

    def test_sigkill(self):
        self.whole("whole")
        code = self.stop(lambda: len(self.finish_times("parts")) >= 5, "five runs", signal.SIGKILL)
        self.assertEqual(code, -signal.SIGKILL)
        self.assertFalse((self.folder / "parts/calibrate.json").exists())
        before = self.finish_times("parts")
        self.assertLess(len(before), len(self.finish_times("whole")))
        self.assert_done(self.run_it("-o", "parts", "--no-figures"))
        self.assertEqual({name: t for name, t in self.finish_times("parts").items() if name in before}, before)
        self.assert_same_calibration("whole", "parts")

    def test_sigint_leaves_what_there_is(self):
        self.assertEqual(self.stop((self.folder / "parts/trials.csv").exists, "trials.csv", signal.SIGINT), 130)
        self.assertIn("interrupted", self.result("parts")["ending"])
        self.assert_done(self.run_it("-o", "parts", "--no-figures"))
        self.whole("whole")
        self.assert_same_calibration("whole", "parts")

    def test_a_larger_budget_continues(self):
        self.whole("out")
        before, rows = self.finish_times(), self.trials()
        self.plan = self.write("plan.toml", plan_text(6))
        self.assert_done(self.run_it("-o", "out", "--no-figures"))
        self.assertEqual(self.trials()[:4], rows)
        self.assertEqual(len(self.trials()), 6)
        self.assertEqual({name: t for name, t in self.finish_times().items() if name in before}, before)


class Refusals(Calibrate):
    def assert_plan_refused(self, text, *parts):
        result = self.run_it("-o", "out", plan=self.write("wrong.toml", text))
        self.assert_refused(result, *parts)
        self.assertFalse((self.folder / "out").exists())

    def test_plans_and_laboratory_files(self):
        """More of them: tests/python/calibration_test.py, calibration_curves_test.py."""
        self.assert_plan_refused(plan_text().replace("blind", "blnd"), "wrong.toml:28", "blnd",
                                 "Did you mean curve.blind?")
        self.assert_plan_refused(plan_text().replace("lab.csv", "lob.csv"), "wrong.toml:19", "lob.csv",
                                 "does not exist")
        self.assert_plan_refused(plan_text().replace("scene.toml", "other.toml"), "wrong.toml:2", "other.toml")
        self.write("lab.csv", LABORATORY.replace("2,0.3", "0.9,0.3"))
        self.assert_plan_refused(plan_text(), "lab.csv:5", "eps_a[%] = 0.9", "goes back")
        self.assert_refused(self.run_app("isostat", "calibrate"), "no plan given", "quick_karlsruhe.toml")
        for path in ("nowhere.toml", "/dev/zero", "."):
            self.assert_refused(self.run_it(plan=path), path, "does not exist, or is no file")

    def test_density_that_no_trial_reaches(self):
        text = plan_text(curve="relative_density = 1.0").replace("seeds = 2", "seeds = 1")
        plan = self.write("dense.toml", text)
        result = self.run_it("-o", "out", plan=plan)
        self.assert_refused(result, "dense.toml:19", 'curve "fitted" (relative_density = 1)', "none of the first 3",
                            "seed 1: error:", "density cannot be reached", "Correct the curve's density")
        before = contents(self.folder / "out/runs")
        self.assertEqual(self.run_it("-o", "out", plan=plan).returncode, 2)
        self.assertEqual(contents(self.folder / "out/runs"), before)

    def test_folder_of_others(self):
        self.plan = self.write("plan.toml", plan_text(1))
        self.assert_done(self.run_it("-o", "out", "--no-figures"))
        before = contents(self.folder / "out")
        other = self.write("other.toml", plan_text(1).replace("points = 10", "points = 11"))
        self.assert_refused(self.run_it("-o", "out", plan=other), "points = 10", "points = 11", "--overwrite")
        self.write("lab.csv", LABORATORY.replace("500", "501"))
        self.assert_refused(self.run_it("-o", "out"), "laboratory/fitted.csv", "2,0.3,500,200", "2,0.3,501,200")
        self.assertEqual(contents(self.folder / "out"), before)
        self.assert_done(self.run_it("-o", "out", "--no-figures", "--overwrite"))
        (self.folder / "thesis").mkdir()
        self.write("thesis/chapter.tex", "precious")
        for name in ("scene.toml", "provenance.txt"):  # a user's files do not make it a results folder
            before = contents(self.folder / "thesis")
            for flag in ((), ("--overwrite",)):
                self.assert_refused(self.run_it("-o", "thesis", *flag), "thesis", f"holds no {name}")
            self.assertEqual(contents(self.folder / "thesis"), before)
            for own in ("plan.toml", "scene.toml"):
                self.write(f"thesis/{own}", (self.folder / own).read_text(encoding="utf-8"))
        (self.folder / "out/plan.toml").unlink()
        self.assert_refused(self.run_it("-o", "out"), "holds results of another program", "no plan.toml")

    def test_dry_run_leaves_nothing(self):
        result = self.run_it("-o", "out", "--dry-run")
        self.assert_done(result)
        self.assertIsNotNone(re.search(r"runs per trial +2 \(1 curves, 2 seeds\)", result.stdout), result.stdout)
        self.assertIn("at most 8, and 4 for the blind curves", result.stdout)
        self.assertFalse((self.folder / "out").exists())

    def test_dry_run_finds_what_would_stop_the_run(self):
        sieves = 'table = [["0.1 mm", 0], ["0.2 mm", 100]]'
        self.write("scene.toml", SCENE.replace("grains = 200", f"grains = 200\n{sieves}"))
        plan = self.write("own.toml", plan_text(curve="relative_density = 0.5"))
        self.assert_refused(self.run_it("-o", "out", "--dry-run", plan=plan), "relative_density", "e_min")
        self.write("scene.toml", SCENE)
        self.plan = self.write("plan.toml", plan_text(1))
        self.assert_done(self.run_it("-o", "out", "--no-figures"))
        other = self.write("other.toml", plan_text(1).replace("points = 10", "points = 11"))
        self.assert_refused(self.run_it("-o", "out", "--dry-run", plan=other), "points = 10", "--overwrite")
        self.assert_done(self.run_it("-o", "out", "--dry-run", "--overwrite", plan=other))

    def test_remarks(self):
        """A start that is not the scene's, one seed, and a blind curve that wants the opposite of the fitted one."""
        self.write("strong.csv", LABORATORY[:LABORATORY.index("0.5")] +
                   "0.5,-0.3,700,200\n1,-1,900,200\n2,-2,900,200\n")
        text = plan_text(4, key="contact.friction", bounds='["20 deg", "60 deg"]').replace("seeds = 2", "seeds = 1")
        plan = self.write("plan.toml", text.replace('"unseen"\nfile = "lab.csv"', '"unseen"\nfile = "strong.csv"'))
        self.assertIn("contact.friction (deg): the scene's value is outside of the bounds: the start is their middle",
                      self.run_it("--dry-run").stdout)
        result = self.run_it("-o", "out", "--no-figures", plan=plan)
        self.assert_done(result)
        self.assertRegex(result.stdout, r"fitted +1 +\d\.\d+ +\d\.\d+ +-\n")
        self.assertEqual([curve["scatter"] for curve in self.result()["curves"]], [None, None])
        self.assertIn("1 of 1 blind curves became WORSE: unseen", result.stdout)

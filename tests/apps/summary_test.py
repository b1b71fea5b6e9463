# SPDX-License-Identifier: BSD-3-Clause
"""Each number of a test's summary is of that run, in text, summary.json, report and figures, or is left out: scenes
without a shear stage, with several, that ended at once, and contact laws without moments or friction. What ended a
stage, lost control and the strength of a drained test are there; a resumed run says the same. Conditions that
are met at once or never: tests/verification/path_ends_test.cpp."""
import html
import json
import re
import signal

import numpy as np

from report_support import page
from support import AppTest, columns, tiny_scene

CELL = 'domain = "periodic-cell"\npreparation_friction = "10 deg"'
REST = '[[stage]]\nkind = "hold"\nbalance = 0.05\n'
SHEAR = '[[stage]]\nkind = "undrained-simple-shear"\nstrain = 2e-4\n'
OF_SHEAR = ("p0'", "strain rate", "largest", "lowest", "I_R at the start", "liquefaction", "reversals")
PATH = '[[stage]]\nkind = "path"\nx.keep = "stress"\nz.keep = "stress"\n'
LIMITED = PATH + 'max_steps = 400\nuntil = { strain = 0.05, q = "150 kPa" }\n'
ENDED_EARLY = ("stage 0 (path): ended by max_steps = 400 before any of its conditions was met: until.strain = 5 % (")
CYCLIC_PATH = """[[stage]]
kind = "path"
x.keep = "volume"
z.keep = "volume"
turn = { low = "-30 kPa", high = "30 kPa" }
until = { cycles = 2, strain = 0.1 }
"""
DRAINED = '[[stage]]\nkind = "drained"\nstrain = 0.02\nstrain_rate = "{rate} 1/s"\n'
LOSS = "stage 0: sigma_x off its target by more than 1 %"
STRENGTH = ('[[stage]]\nkind = "drained"\nstrain = 0.02\nstrain_rate = "1 1/s"\n'
          '[[stage]]\nkind = "constant-p"\ndirection = "extension"\nstrain = 0.01\nstrain_rate = "1 1/s"\n')


class Summary(AppTest):
    def leave(self, name, stages, *arguments, specimen=CELL, without=()):
        """Runs a scene without some keys of [contact] and keeps its summary's text, numbers and history."""
        lines = tiny_scene(specimen=specimen, stages=stages).splitlines()
        scene = "\n".join(line for line in lines if line.split(" ")[0] not in without)
        result = self.run_app("element_test", self.write(f"{name}.toml", scene), "-o", name, *arguments)
        self.assert_done(result)
        self.text = (self.folder / name / "summary.txt").read_text(encoding="utf-8")
        self.numbers = self.summary_of(name)
        rows = [f"  {label:<25}{text}\n" for label, text in self.numbers["rows"]]
        self.assertEqual(self.text, "\ntiny\n" + "".join(rows))
        self.history = columns(self.folder / name / "history.csv")

    def line(self, name):
        """What the summary says of a name, or None."""
        found = re.search(rf"^  {re.escape(name)}\s+(\S.*)$", self.text, re.M)
        return found[1] if found else None

    def assert_at_the_end(self):
        h = self.history
        self.assertEqual(self.line("at the end").split(" (")[0],
                         f"p' {h['p'][-1] / 1e3:.2f} kPa, I_R {h['IR'][-1]:.3f}")
        self.assert_close(self.numbers["p_end"], h["p"][-1], 1e-9, "digits of the history")
        self.assert_close(self.numbers["IR_at_end"], h["IR"][-1], 1e-9, "digits of the history")

    def test_without_a_shear_stage(self):
        self.leave("rest", REST)
        self.assert_at_the_end()
        for name in OF_SHEAR:
            self.assertNotIn(f"\n  {name}", self.text)
        for name in ("p0", "shear_stage_first_row", "IR_at_start", "worst_overshoot", "liquefaction"):
            self.assertIsNone(self.numbers[name], name)
        figures = {path.stem for path in (self.folder / "rest/figures").glob("*.png")}
        self.assertEqual(figures, {"fig_redundancy", "fig_contact_fractions", "fig_fabric"})
        report = (self.folder / "rest/report.html").read_text(encoding="utf-8")
        self.assertNotIn("Not liquefied", report)
        self.assertNotIn("p0'", re.search(r'id="summary">.*?</section>', report, re.S)[0])

    def test_consolidation_by_a_path_is_no_shearing(self):
        self.leave("path", '[[stage]]\nkind = "path"\nconsolidation = true\nx.keep = "stress"\nz.keep = "stress"\n'
                           "until.strain = 1e-4\n", "--no-figures")
        self.assert_at_the_end()
        for name in ("p0'", "largest", "I_R at the start", "liquefaction"):
            self.assertNotIn(f"\n  {name}", self.text)

    def test_without_any_step(self):
        self.leave("nothing", '[[stage]]\nkind = "friction"\nfriction = "10 deg"\n', "--no-figures")
        self.assertNotIn("I_R", self.text)
        self.assertNotIn("kPa", self.text)
        self.assertIsNone(self.numbers["p_end"])

    def test_a_drained_test_does_not_speak_of_liquefaction(self):
        self.leave("drained", '[[stage]]\nkind = "drained"\nstrain = 5e-4\n', "--no-figures")
        self.assertIsNotNone(self.line("p0'"))
        self.assertNotIn("liquefaction", self.text)

    def test_a_stage_that_ends_at_once_has_no_response(self):
        self.leave("once", '[[stage]]\nkind = "undrained-cyclic-simple-shear"\nstress_ratio = 0.1\nmax_steps = 1\n',
                   "--no-figures")
        self.assertEqual(self.line("reversals"), "0")
        self.assertIsNone(self.numbers["worst_overshoot"])
        for name in ("cyclic response", "largest indicator"):
            self.assertNotIn(f"\n  {name}", self.text)

    def test_every_balanced_state_has_a_row(self):
        """With what its relaxation took; few grains have no jump in a short test."""
        self.leave("still", SHEAR, "--no-figures", "--set", "motion.drive=static", without=("strain_rate",))
        self.assertEqual((self.line("jumps"), self.numbers["jumps"]["number"]), ("none", 0))
        self.assertGreaterEqual(len(self.history["relaxed"]), 5, "2e-4 in increments of 5e-5, and the start")
        self.assertTrue((self.history["relaxed"] >= 0).all())

    def test_of_two_stages_the_stress_ratio_is_of_one_of_them(self):
        self.leave("two", SHEAR + '[[stage]]\nkind = "compress"\npressure = "20 kPa"\nmax_steps = 20000\n' + SHEAR,
                   "--no-figures")
        h = self.history
        ratios = []
        for stage in (0, 2):
            rows = h["stage"] == stage
            ratios.append((np.abs(h["tau_xy"][rows]).max() / h["sigma_y"][rows][0], h["sigma_y"][rows][0]))
        ratio, vertical = max(ratios)
        self.assertEqual((ratio, vertical), ratios[1], "softer, and under a tenth of the stress")
        self.assert_close(self.numbers["stress_ratio_max"], ratio, 1e-8, "digits of the history")
        self.assert_close(self.numbers["sigma_v0"], vertical, 1e-8, "digits of the history")
        self.assert_close(self.numbers["p0"], h["p"][0], 1e-8, "p0' is that of the first: digits of the history")
        self.assert_at_the_end()

    def test_liquefaction_is_by_the_ratio_of_its_stage(self):
        loose = 'preparation_friction = "30 deg"'
        stages = ('[[stage]]\nkind = "undrained-monotonic"\nstrain = 1e-5\n'
                  '[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.01\nliquefaction_ratio = 0.9\n')
        self.leave("ratio", stages, "--no-figures", "--set", "motion.strain_rate=10 1/s", specimen=loose)
        event = self.numbers["liquefaction"]
        self.assertEqual(event["ratio"], 0.9)
        below = np.flatnonzero(self.history["p"] / self.numbers["p0"] < 0.9)
        self.assertEqual(event["row"], below[0])
        before = below[0] - 1
        self.assert_close(event["p_ratio_before"], self.history["p"][before] / self.numbers["p0"], 1e-8, "its digits")
        self.assert_close(event["IR_before"], self.history["IR"][before], 1e-8, "digits of the history")
        self.assertGreaterEqual(event["p_ratio_before"], 0.9)
        self.assertIsNone(self.line("cycles to liquefaction"), "it had none")
        report = page(self.folder / "ratio")
        self.assertIn("fell below 0.9 ", report)
        self.assertIn("in the row before ", report)
        for name in ("IR_before", "p_ratio_before"):  # as a version left it that did not have them
            del self.numbers["liquefaction"][name]
        (self.folder / "ratio/summary.json").write_text(json.dumps(self.numbers), encoding="utf-8")
        report = page(self.folder / "ratio")
        self.assertIn("fell below 0.9 ", report)
        self.assertNotIn("in the row before ", report)

    def test_results_of_a_version_without_rows_are_reported(self):
        """Their text as it is, and without what that version did not keep as numbers; without the text the numbers."""
        self.leave("old", SHEAR, "--no-figures", "--set", "motion.strain_rate=2 1/s")
        for name in ("rows", "strain_rate", "inertial_number", "max_indicator"):
            del self.numbers[name]
        (self.folder / "old/summary.json").write_text(json.dumps(self.numbers), encoding="utf-8")
        report = html.unescape(page(self.folder / "old"))
        self.assertIn(self.text.strip() + "</pre>", report)
        self.assertIn("fixed at 2 1/s, not controlled.", report)
        (self.folder / "old/summary.txt").unlink()
        report = page(self.folder / "old")
        self.assertIn(f'<th scope="row">grains</th><td>{self.numbers["grains"]}</td>', report)

    def test_a_contact_counts_as_yielding_within_the_margin(self):
        shares = []
        for margin in ("1e-9", "0.5"):
            self.leave(f"margin{margin}", SHEAR, "--no-figures", "--set", f"output.yield_margin={margin}")
            shares.append(self.history["f_NSR"])
        self.assertTrue((shares[1] <= shares[0]).all())
        self.assertLess(shares[1][-1], shares[0][-1])

    def test_the_index_is_that_of_the_law(self):
        law = ("friction", "rolling", "twisting")
        for without, constraints, isostatic in (((), 6, 2), (law[2:], 5, 2.4), (law[1:2], 4, 3), (law[1:], 3, 4),
                                                (law, 1, 6)):
            self.leave(f"law{constraints}", SHEAR, "--no-figures", without=without)
            h = {name: values[-1] for name, values in self.history.items()}
            self.assertEqual(h["IR_constraints"], constraints)
            self.assertEqual(self.numbers["IR_constraints"], [constraints])
            self.assertRegex(self.line("redundancy index I_R"),
                             rf"^{constraints} constraints? a contact( \(Eq. 2\))?, isostatic at Z = {isostatic:g}$")
            slide, roll = h["f_S"] + h["f_SR"], h["f_R"] + h["f_SR"]
            held = constraints - 2 * slide - 2 * roll  # the law's classes: what it leaves out does not yield
            self.assert_close(h["IR"], held / constraints * h["Z"] / isostatic, 1e-8, "digits of the history")
            self.assert_close(h["IR_eq2"], (6 - 2 * slide - 2 * roll) * h["Z"] / 12, 1e-8, "digits of the history")
            self.assertEqual("Eq. 2: " in self.line("at the end"), constraints < 6)
            self.assert_at_the_end()


class EarlyEnd(AppTest):
    def scene(self, name, stages):
        return self.write(f"{name}.toml", tiny_scene(stages=stages))

    def test_a_stage_that_its_limit_ended_says_so(self):
        result = self.run_test(self.scene("limited", LIMITED + REST), "-o", "limited")
        self.assert_done(result)
        self.assertIn("warning: " + ENDED_EARLY, result.stderr)
        self.assertIn("ended early              " + ENDED_EARLY, result.stdout)
        (end,) = self.summary_of("limited")["ended_early"]
        self.assertEqual((end["stage"], end["times"], end["at_once"]), (0, 1, False))
        self.assertIn("until.q = 150 kPa (", end["text"])

    def test_summary_says_what_ended_a_stage(self):
        stages = PATH + 'max_steps = 400\nuntil.strain = 1e-4\n' + PATH + "max_steps = 50\n"
        result = self.run_test(self.scene("whole", stages), "-o", "whole")
        self.assert_done(result)
        self.assertNotIn("warning", result.stderr)
        self.assertNotIn("ended early", result.stdout)
        self.assertIn("ended                    stage 0 (path): ended by until.strain = 0.01 % (", result.stdout)
        self.assertIn("ended                    stage 1 (path): ended by max_steps = 50\n", result.stdout)
        numbers = self.summary_of("whole")
        self.assertEqual(numbers["ended_early"], [])
        self.assertEqual([(end["stage"], end["by"], end["early"]) for end in numbers["ended"]],
                         [(0, "strain", False), (1, "max_steps", False)])

    def test_a_default_that_comes_before_what_was_asked_for_is_named(self):
        stage = '[[stage]]\nkind = "undrained-cyclic"\ndeviator_amplitude = "40 kPa"\nuntil.cycles = 60\n'
        result = self.run_test(self.scene("default", stage), "-o", "default", "--set", "stage.0.until.strain=1e-4")
        self.assert_done(result)
        self.assertRegex(result.stdout, r"ended by until.strain = 0.01 % \(0.01\d* %\), before until.cycles = 60 "
                         r"\([\d.]+ reached\), until.reversals_after_liquefaction = 10 \(not liquefied\)")

    def test_a_resumed_run_says_the_same(self):
        stages, often = LIMITED + PATH + "until.strain = 0.005\n", ("--set", "output.checkpoint=0.0005 min")
        scene = self.scene("resumed", stages)
        self.assert_done(self.run_test(scene, "-o", "whole", *often))
        self.run_and_stop(0.05, signal.SIGKILL, (self.folder / "parts/checkpoint/last.h5", True), scene, "-o", "parts",
                          *often)
        self.assert_done(self.run_test(scene, "-o", "parts", "--resume", *often))
        self.assertEqual(self.summary_of("parts")["ended_early"], self.summary_of("whole")["ended_early"])
        self.assertEqual(len(self.summary_of("parts")["ended_early"]), 1)

    def test_cycles_of_a_path_have_a_response(self):
        result = self.run_test(self.scene("cyclic", CYCLIC_PATH), "-o", "cyclic")
        self.assert_done(result)
        self.assertIn("  cyclic response          ", result.stdout)
        response = self.summary_of("cyclic")["cyclic_response"]
        self.assertIn(response["name"],
                      ("flow", "limited flow", "cyclic mobility", "plastic strain accumulation", "no failure"))
        self.assertTrue(response["stress_reversal"])
        self.assert_near(response["load_max"], 30e3, 3e3, "what a step of 200 grains adds at a turn")

    def test_a_bias_that_cannot_hold_is_refused_when_the_scene_is_read(self):
        scene = self.scene("bias", CYCLIC_PATH.replace("-30 kPa", "10 kPa"))
        self.assert_refused(self.run_app("element_test", scene, "--validate"), "bias.toml:",
                            "stage.0.turn.low = 10 kPa", "isotropic consolidation to 200 kPa", "turn.high = 30 kPa")

    def test_cycles_of_stages_are_counted(self):
        stages = (PATH + "until.strain = 2e-4\n" + PATH +
                  'direction = "extension"\nuntil.strain = 2e-4\nmax_steps = 5\n'
                  '[[stage]]\nkind = "repeat"\nstages = 2\ntimes = 3\n')
        result = self.run_test(self.scene("cycles", stages), "-o", "cycles")
        self.assert_done(result)
        for part in ("stage 0 (path), cycle 2 of 3 of stages 0 to 1", "repeated                 stages 0 to 1, 3 times",
                     "stage 1 (path), cycle 1 of 3 of stages 0 to 1: ended by max_steps = 5", "3 times in all"):
            self.assertIn(part, result.stderr + result.stdout)
        rows = columns(self.folder / "cycles/history.csv")
        self.assertEqual(sorted(set(zip(rows["done"], rows["stage"]))),
                         [(0, 0), (1, 1), (2, 0), (3, 1), (4, 0), (5, 1)])
        report = page(self.folder / "cycles")
        self.assertIn("Stage 0 (path), cycle 1 of 3 of stages 0 to 1:", report)
        self.assertIn("ended by max_steps = 5 before any of its conditions was met", report)

    def test_a_condition_that_is_met_when_it_begins_is_reported(self):
        result = self.run_test(self.scene("met", PATH + 'until.p = "200 kPa"\n' + REST), "-o", "met")
        self.assert_done(result)
        self.assertIn("warning: stage 0 (path): ended in its first step, because one of its conditions was met when it "
                      "began: until.p = 200 kPa (", result.stderr)
        self.assertTrue(self.summary_of("met")["ended_early"][0]["at_once"])


class Control(AppTest):
    def scene(self, rate):
        return self.write(f"scene_{rate}.toml", tiny_scene(stages=DRAINED.format(rate=rate)))

    def losses(self, folder):
        return self.summary_of(folder)["control_lost"]

    def test_a_test_that_keeps_its_stresses_says_nothing(self):
        result = self.run_test(self.scene(0.5), "-o", "slow")
        self.assert_done(result)
        self.assertNotIn("control lost", result.stderr + result.stdout)
        self.assertEqual(self.losses("slow"), [])

    def test_lost_control_is_reported(self):
        result = self.run_test(self.scene(60), "-o", "fast")
        self.assert_done(result)
        self.assertIn("warning: control lost: " + LOSS, result.stderr)
        self.assertIn("control lost             " + LOSS, result.stdout)
        lost = [loss for loss in self.losses("fast") if loss["quantity"] == "sigma_x"]
        self.assertEqual(len(lost), 1)
        self.assertEqual(lost[0]["stage"], 0)
        self.assert_close(lost[0]["target"], 200e3, 0.01, "the pressure of the preparation, within the servo's 0.2 %")
        self.assertGreater(abs(lost[0]["worst"] / lost[0]["target"] - 1), 0.01)
        self.assertGreater(lost[0]["share"], 0.05)

    def test_lost_control_may_be_an_error(self):
        result = self.run_test(self.scene(60), "-o", "error", "--set", "control.on_loss=error")
        self.assertEqual(result.returncode, 1, result.stdout)
        for part in ("failed: step ", "control lost: " + LOSS, "control.on_loss", "checkpoint"):
            self.assertIn(part, result.stderr)

    def test_a_resumed_run_says_the_same(self):
        scene, often = self.scene(60), ("--set", "output.checkpoint=1e-9 min")
        self.assert_done(self.run_test(scene, "-o", "whole", *often))
        self.run_and_stop(0.05, signal.SIGKILL, (self.folder / "parts/checkpoint/last.h5", True), scene, "-o", "parts",
                          *often)
        self.assert_done(self.run_test(scene, "-o", "parts", "--resume", *often))
        self.assertEqual(self.losses("parts"), self.losses("whole"))


class DrainedReport(AppTest):
    def test_strength_in_history_summary_and_figure(self):
        self.result = self.run_test(self.write("scene.toml", tiny_scene(stages=STRENGTH)), "-o", "run")
        self.assert_done(self.result)
        self.numbers = self.summary_of("run")
        self.history = columns(self.folder / "run/history.csv")
        self.check_strength()
        self.check_summary_and_figure()

    def check_strength(self):
        """That of the history."""
        h = self.history
        self.assertEqual([stage["stage"] for stage in self.numbers["drained"]], [0, 1])
        for stage in self.numbers["drained"]:
            rows = h["stage"] == stage["stage"]
            ratio = (h["q"] / h["p"])[rows]
            volume = (h["eps_x"] + h["eps_y"] + h["eps_z"])[rows]
            peak = ratio[np.argmax(abs(ratio))]
            self.assert_close(stage["q_over_p_peak"], peak, 0.05, "a mean over 1 % of the strain, a row scatters more")
            sine = 3 * abs(stage["q_over_p_peak"]) / (6 + stage["q_over_p_peak"])
            self.assert_close(stage["friction_peak_deg"], np.degrees(np.arcsin(sine)), 1e-6, "digits of the file")
            self.assert_near(stage["eps_v_end"], volume[-1], 1e-12, "digits of the file")
            self.assert_near(stage["eps_v_max"], volume.max(), 1e-12, "digits of the file")
        self.assertIsNotNone(self.numbers["drained"][0]["dilatancy_deg"])
        self.assertIsNone(self.numbers["drained"][1]["dilatancy_deg"], "of compression alone")

    def check_summary_and_figure(self):
        for name in ("peak friction", "end friction", "largest dilatancy", "volumetric strain"):
            self.assertIn(f"  {name:<25}", self.result.stdout)
        report = page(self.folder / "run", "fig_dilatancy")
        self.assertTrue((self.folder / "run/figures/fig_dilatancy.png").stat().st_size > 10000)
        for part in ("peak friction", "fig_dilatancy"):
            self.assertIn(part, report)

# SPDX-License-Identifier: BSD-3-Clause
"""Each number of a test's summary is of that run, in text, summary.json, report and figures, or is left out: scenes
without a shear stage, with several, that ended at once, and contact laws without moments or friction."""
import html
import json
import re

import numpy as np

from report_support import page
from support import AppTest, columns, tiny_scene

CELL = 'domain = "periodic-cell"\npreparation_friction = "10 deg"'
REST = '[[stage]]\nkind = "hold"\nbalance = 0.05\n'
SHEAR = '[[stage]]\nkind = "undrained-simple-shear"\nstrain = 2e-4\n'
OF_SHEAR = ("p0'", "strain rate", "largest", "lowest", "I_R at the start", "liquefaction", "reversals")


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

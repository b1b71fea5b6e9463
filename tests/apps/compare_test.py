#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The comparison of two runs, and the program isostat that leads to it."""
import re
import shutil

import numpy as np

from report_support import ReportTest
from support import BIN, AppTest, contents, main

DRAINED = '[[stage]]\nkind = "drained"\nstrain = 0.001\nstrain_rate = "5 1/s"\n'


class Compare(ReportTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.make_test("one", "--no-figures", stages=DRAINED)
        cls.make_test("other", "--no-figures", "--set", "contact.friction=25 deg", stages=DRAINED)

    def compare(self, *arguments):
        return self.run_app("isostat", "compare", *arguments)

    def test_two_runs(self):
        self.assert_done(self.compare(self.runs / "one", self.runs / "other"))
        text = (self.folder / "compare.html").read_text(encoding="utf-8")
        self.assert_one_file(text)
        for part in ("A: one blue, B: other orange.", "<td>contact.friction</td><td>18 deg</td><td>25 deg</td>",
                     '<figure id="curves"', '<tr class="same"><td>grains</td>'):
            self.assertIn(part, text)
        q = np.genfromtxt(self.runs / "one/history.csv", delimiter=",", names=True)["q_Pa"]
        self.assertIn(f'<td>peak q (kPa)</td><td class="number">{q[np.argmax(np.abs(q))] / 1e3:.6g}</td>', text)
        scene = re.search(r'id="scene">.*?</section>', text, re.S)[0]
        self.assertEqual(re.findall(r"<tr><td>([^<]*)", scene), ["contact.friction", "output.folder"])

    def test_with_itself(self):
        before = contents(self.runs / "one")
        self.assert_done(self.compare(self.runs / "one", self.runs / "one", "-o", "same.html"))
        text = (self.folder / "same.html").read_text(encoding="utf-8")
        self.assertIn("Every key of the scenes is the same.", text)
        self.assertNotIn("differs", text)
        self.assertEqual(contents(self.runs / "one"), before)

    def test_a_run_of_python(self):
        shutil.copytree(self.runs / "one", self.folder / "notebook")
        path = self.folder / "notebook/provenance.txt"
        text, n = re.subn(r"(?m)^(command +).*$", r"\1isostat.run() in Python", path.read_text(encoding="utf-8"))
        self.assertEqual(n, 1)
        path.write_text(text, encoding="utf-8")
        self.assert_done(self.compare(self.runs / "one", "notebook"))
        self.assert_done(self.run_app("isostat", "report", "notebook"))
        self.assertTrue((self.folder / "notebook/report.html").exists())

    def refuse(self, first, second, *parts):
        self.assert_refused(self.compare(first, second), *parts)
        self.assertFalse((self.folder / "compare.html").exists())

    def test_no_results(self):
        self.refuse(self.runs / "one", "nowhere", "nowhere", "no such folder", "results folder of a run")
        self.refuse(self.folder, self.runs / "one", "is not a results folder", "provenance.txt")

    def test_unfinished(self):
        shutil.copytree(self.runs / "one", self.folder / "part")
        (self.folder / "part/summary.json").unlink()
        self.refuse("part", self.runs / "one", "part: is not finished", "summary.json", "--resume")

    def test_different_kinds(self):
        shutil.copytree(self.runs / "one", self.folder / "column")
        path = self.folder / "column/provenance.txt"
        path.write_text(path.read_text(encoding="utf-8").replace("element_test", "soil_column"), encoding="utf-8")
        self.refuse(self.runs / "one", "column", "is of element_test", "of soil_column", "two runs of one program")

    def test_place_of_the_file(self):
        result = self.compare(self.runs / "one", self.runs / "other", "-o", "nowhere/compare.html")
        self.assert_refused(result, "nowhere/compare.html", "--output")


class Launcher(AppTest):
    def test_help(self):
        result = self.run_app("isostat", "--help")
        self.assert_done(result)
        programs = [name for name in ("element_test", "calibrate", "soil_column") if (BIN / name).exists()]
        for word in ("compare", "report", *programs):
            self.assertRegex(result.stdout, rf"(?m)^  {word} ")
        self.assertEqual(self.run_app("isostat").stdout, result.stdout)

    def test_version(self):
        self.assertRegex(self.run_app("isostat", "--version").stdout, r"^isostat \d+\.\d+\.\d+ \(")

    def test_unknown(self):
        self.assert_refused(self.run_app("isostat", "blend"), "blend", "isostat --help")

    def test_other_programs(self):
        """With what follows, and their exit codes."""
        self.assertEqual(self.run_app("isostat", "element_test", "--print-defaults").stdout,
                         self.run_app("element_test", "--print-defaults").stdout)
        self.assert_refused(self.run_app("isostat", "element_test", "nowhere.toml"), "nowhere.toml")


if __name__ == "__main__":
    main()

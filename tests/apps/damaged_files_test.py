# SPDX-License-Identifier: BSD-3-Clause
"""Damaged files of a results folder: each program says where, what and what to do, and exits with 2."""
import json
import shutil
import tomllib

from figures.files import Damaged, read_parsed
from report_support import ReportTest
from support import CYCLIC


class Tables(ReportTest):
    def said(self, text, parse=json.loads):
        path = self.folder / "file"
        path.write_bytes(text)
        with self.assertRaises(Damaged) as caught:
            read_parsed(path, parse)
        return str(caught.exception).removeprefix(str(path))

    def test_place_and_reason(self):
        cut = b'{\n  "title": "one",\n  "grains": 20'
        self.assertRegex(self.said(cut), r"^:3: is damaged \(Expecting ',' delimiter\)\. Restore it")
        self.assertRegex(self.said(b""), r"^:1: is damaged \(it is empty\)\.")
        self.assertRegex(self.said(b'{\n"title": "\xff"}'), r"^:2: is damaged \(it holds bytes that are no text\)")
        self.assertRegex(self.said(b"[1, 2]"), r"^:1: is damaged \(it holds no table")
        self.assertRegex(self.said(b"[grading]\ngrains = \n", tomllib.loads), r"^:2: is damaged \(Invalid value\)\.")
        self.assertRegex(self.said(b'[grading]\ngrains = "2', tomllib.loads), r"^:2: is damaged \(Unterminated string")

    def test_whole(self):
        path = self.write("file", '{"grains": 200}')
        self.assertEqual(read_parsed(path), {"grains": 200})
        with self.assertRaises(FileNotFoundError):
            read_parsed(self.folder / "nowhere")


class Programs(ReportTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.make_test("whole", "--no-figures", stages=CYCLIC.format(steps=600))

    def test_report_and_compare(self):
        shutil.copytree(self.runs / "whole", self.folder / "cut")
        for name in ("summary.json", "scene.toml"):
            path = self.folder / "cut" / name
            whole = path.read_text(encoding="utf-8")
            lines = whole.splitlines()
            path.write_text("\n".join([*lines[:4], '"half = ']), encoding="utf-8")
            for arguments in (("report", "cut"), ("compare", self.runs / "whole", "cut"),
                              ("compare", "cut", self.runs / "whole")):
                self.assert_refused(self.run_app("isostat", *arguments), f"cut/{name}:5: is damaged (", "Restore it",
                                    "--resume")
            path.write_text(whole, encoding="utf-8")

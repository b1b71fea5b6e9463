# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of reports and comparisons share: runs that a class makes once, what every page has to hold to."""
import contextlib
import html
import importlib
import io
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
from unittest import mock

from report import run
from support import BIN, ROOT, TIME_LIMIT, AppTest, tiny_scene

os.environ["OMP_NUM_THREADS"] = "1"
SCENES = ROOT / "apps/scenes"
MOST_BYTES = 2.5e6  # of a report


def page(folder, *names, program="element_test", code=0):
    """The report of a results folder, left in this process with no more than these figures: quicker than a program."""
    drawing = importlib.import_module(f"figures.{program}").DRAWING
    figures = [drawing.figures[name] for name in names]
    with mock.patch.object(drawing, "all", figures), contextlib.redirect_stdout(io.StringIO()):
        found = run.leave(folder, program)
    assert found == code, f"{folder}: exit code {found}"
    return (folder / "report.html").read_text(encoding="utf-8")


class ReportTest(AppTest):
    """Runs that all tests of a class look at, made once in its folder."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.runs = pathlib.Path(tempfile.mkdtemp(prefix="isostat_reports_"))
        cls.addClassCleanup(shutil.rmtree, cls.runs)
        (cls.runs / "specimens").symlink_to(cls.cache)

    @classmethod
    def make(cls, program, name, scene, *arguments):
        command = [str(BIN / program), str(scene), "-o", name, "-q", *arguments]
        result = subprocess.run(command, cwd=cls.runs, capture_output=True, text=True, check=False,
                                timeout=TIME_LIMIT)
        if result.returncode != 0:
            raise AssertionError(result.stderr)
        return result

    @classmethod
    def make_test(cls, name, *arguments, **scene):
        (cls.runs / f"{name}.toml").write_text(tiny_scene(**scene), encoding="utf-8")
        return cls.make("element_test", name, f"{name}.toml", *arguments)

    def report(self, name):
        return (self.runs / name / "report.html").read_text(encoding="utf-8")

    def assert_one_file(self, text):
        """Nothing that a browser would have to fetch."""
        for target in re.findall(r'(?:src|href|action|data)\s*=\s*"([^"]*)"', text):
            self.assertRegex(target, r"^(#|data:image/png;base64,)")
        self.assertEqual(set(re.findall(r"url\((.)", text)) - {"#"}, set())
        for word in ("http:", "https:", "<link", "@import", "<iframe", "import("):
            self.assertNotIn(word, text)
        ids = re.findall(r'\bid="([^"]*)"', text)
        self.assertEqual(len(ids), len(set(ids)))
        for target in re.findall(r'href="#([^"]*)"|url\(#([^)]*)\)', text):
            self.assertIn(target[0] or target[1], set(ids))
        self.assertLess(len(text), MOST_BYTES)

    def assert_whole(self, name):
        """Summary, scene and provenance to the letter, every figure with its text."""
        text, folder = self.report(name), self.runs / name
        self.assert_one_file(text)
        plain = html.unescape(re.sub(r"<[^>]*>", " ", text))
        words = " ".join(plain.split())
        for file in ("summary.txt", "provenance.txt", "scene.toml"):
            for line in (folder / file).read_text(encoding="utf-8").splitlines():
                self.assertIn(" ".join(line.split()), words, file)
        figures = sorted(path.stem for path in (folder / "figures").iterdir())
        self.assertGreater(len(figures), 0)
        self.assertEqual(sorted(re.findall(r'<figure id="([^"]*)"', text)), figures)
        for label in re.findall(r'<svg class="zoom"[^>]*aria-label="([^"]*)"', text):
            self.assertGreater(len(label), 20)
        self.assertEqual(text.count('<svg class="zoom"'), len(figures))
        return words

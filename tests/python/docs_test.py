# SPDX-License-Identifier: BSD-3-Clause
"""The programs of docs/python.md, one after another as a reader would type them, on smaller packings."""
import contextlib
import io
import os
import pathlib
import re
import tempfile
import unittest

import matplotlib

from support import ROOT

PAGE = ROOT / "docs/python.md"
SMALLER = {'"grains": 500, "cloud_edge": "3.684 mm"': '"grains": 200, "cloud_edge": "2.7 mm"',
           "0.01}": "0.002}", "0.015}": "0.003}", "every=1000": "every=5000",
           '"duration": "2 s"': '"duration": "0.3 s"'}


class DocsTest(unittest.TestCase):
    def test_programs_of_the_page_run(self):
        matplotlib.use("Agg")
        blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S)
        self.assertGreater(len(blocks), 3)
        program = "\n".join(blocks)
        for text, smaller in SMALLER.items():
            self.assertIn(text, program)
            program = program.replace(text, smaller)
        before = pathlib.Path.cwd()
        self.addCleanup(os.chdir, before)
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as printed:
            os.chdir(folder)
            names = {}
            exec(compile(program, PAGE, "exec"), names)  # pylint: disable=exec-used
            self.assertGreater(pathlib.Path("drained.pdf").stat().st_size, 10_000)
            os.chdir(before)
        self.assertIn("[", printed.getvalue())
        self.assertEqual(names["rve"].stiffness().shape, (6, 6))

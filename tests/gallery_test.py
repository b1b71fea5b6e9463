# SPDX-License-Identifier: BSD-3-Clause
"""The scripts of the gallery run at small sizes, draw their figures, and have their place on its page."""
import os
import pathlib
import subprocess
import tempfile
import unittest

from support import BIN, ROOT, TIME_LIMIT

SCRIPTS = sorted((ROOT / "examples/python").glob("*.py"))
LARGEST = 150_000  # bytes of a figure in the repository


class Gallery(unittest.TestCase):
    def test_scripts_draw(self):
        self.assertEqual(len(SCRIPTS), 6)
        environment = {**os.environ, "PYTHONPATH": str(BIN.parent / "python"), "OMP_NUM_THREADS": "1"}
        with tempfile.TemporaryDirectory() as folder:
            for script in SCRIPTS:
                with self.subTest(script.name):
                    if script.name == "soil_column.py" and not (BIN / "soil_column").exists():
                        continue
                    done = subprocess.run(["/usr/bin/python3", script, "--small", "--output", folder], env=environment,
                                          capture_output=True, text=True, check=False, timeout=TIME_LIMIT)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    self.assertGreater((pathlib.Path(folder) / f"{script.stem}.png").stat().st_size, 10_000)

    def test_page_has_script_figure_command_and_time(self):
        page = (ROOT / "docs/gallery.md").read_text(encoding="utf-8")
        for script in SCRIPTS:
            with self.subTest(script.name):
                self.assertIn(f"../examples/python/{script.name}", page)
                self.assertIn(f"examples/python/{script.name}  # ", page)
                self.assertIn(f"figures/gallery/{script.stem}.png", page)
                figure = ROOT / f"docs/figures/gallery/{script.stem}.png"
                self.assertLess(figure.stat().st_size, LARGEST)

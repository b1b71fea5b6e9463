# SPDX-License-Identifier: BSD-3-Clause
"""The tutorial, followed word for word in an empty folder: every block runs, every file that a page names is there. Its
notebooks run from the first cell to the last."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import tutorial
from support import BIN, ROOT, TIME_LIMIT

LARGEST = 150_000  # bytes of a figure in the repository
# The programs of this tree, and Debian's Python, for which the package was built.
ENVIRONMENT = {"PATH": f"{BIN}:/usr/bin:{os.environ['PATH']}", "PYTHONPATH": str(BIN.parent / "python")}
NOTEBOOKS = sorted((ROOT / "examples/notebooks").glob("*.ipynb"))


class Tutorial(unittest.TestCase):
    def test_every_step_runs_and_leaves_what_its_page_names(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(os.environ, ENVIRONMENT):
            for step in tutorial.STEPS:  # each needs the files of those before it
                tutorial.follow(step, pathlib.Path(folder))

    def test_every_page_shows_one_figure_that_it_makes(self):
        for step in tutorial.STEPS:
            with self.subTest(step):
                (figure,) = tutorial.figures(step)
                self.assertLess(figure.stat().st_size, LARGEST)

    def test_a_page_that_does_not_work_is_noticed(self):
        def refused(text, message):
            with self.subTest(text), tempfile.TemporaryDirectory() as folder:
                with unittest.mock.patch.object(tutorial, "page", lambda _: text):
                    self.assertRaisesRegex(RuntimeError, message, tutorial.follow, "step", pathlib.Path(folder))
        refused("```sh\nfalse\ntrue\n```\n", "returned 1")
        refused("```toml\ntitle = 1\n```\n", "no name above it")
        refused("See `results/none.png`.\n\n```sh\ntrue\n```\n", "results/none.png, which the commands do not make")


def left(path):
    """Of each code cell of a notebook, what it has left."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return [[output["output_type"] for output in cell["outputs"]] for cell in cells if cell["cell_type"] == "code"]


class Notebooks(unittest.TestCase):
    def test_they_run_and_leave_what_is_stored(self):
        self.assertEqual(len(NOTEBOOKS), 2)
        for path in NOTEBOOKS:
            with self.subTest(path.name), tempfile.TemporaryDirectory() as folder:
                self.assertLess(path.stat().st_size, 300_000)
                self.assertGreaterEqual(str(left(path)).count("display_data"), 2)
                again = pathlib.Path(shutil.copy(path, folder))
                # In a process of its own: columns start MPI, below which mpirun does not run.
                done = subprocess.run([sys.executable, ROOT / "scripts/notebook.py", again], cwd=folder, check=False,
                                      env={**os.environ, **ENVIRONMENT}, capture_output=True, text=True,
                                      timeout=TIME_LIMIT)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(left(again), left(path))

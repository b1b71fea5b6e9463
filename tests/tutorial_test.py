# SPDX-License-Identifier: BSD-3-Clause
"""The tutorial, followed word for word in an empty folder: every block runs, every file that a page names is there. Its
notebooks run from the first cell to the last."""
import contextlib
import json
import os
import pathlib
import tempfile
import unittest
import unittest.mock

import notebook
import tutorial
from support import BIN, ROOT

LARGEST = 150_000  # bytes of a figure in the repository
NOTEBOOKS = sorted((ROOT / "examples/notebooks").glob("*.ipynb"))


class Tutorial(unittest.TestCase):
    def test_every_step_runs_and_leaves_what_its_page_names(self):
        # Debian's Python, for which the package was built, and the programs of this tree.
        environment = {"PATH": f"{BIN}:/usr/bin:{os.environ['PATH']}", "PYTHONPATH": str(BIN.parent / "python")}
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.dict(os.environ, environment):
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


def kinds(read):
    """Of each code cell, what it has left."""
    code = [cell for cell in read["cells"] if cell["cell_type"] == "code"]
    return [[output["output_type"] for output in cell["outputs"]] for cell in code]


class Notebooks(unittest.TestCase):
    def test_they_run_and_leave_what_is_stored(self):
        self.assertEqual(len(NOTEBOOKS), 2)
        for path in NOTEBOOKS:
            with self.subTest(path.name), tempfile.TemporaryDirectory() as folder:
                self.assertLess(path.stat().st_size, 300_000)
                stored = json.loads(path.read_text(encoding="utf-8"))
                again = json.loads(json.dumps(stored))
                with contextlib.chdir(folder):
                    self.assertEqual(kinds(notebook.run(again, path.name)), kinds(stored))
                self.assertGreaterEqual(str(kinds(stored)).count("display_data"), 2)

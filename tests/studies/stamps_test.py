# SPDX-License-Identifier: BSD-3-Clause
"""Pages of results know by which scenes they were made: a default that changes under one makes it stale."""
import dataclasses
import json
import re
import unittest
import unittest.mock

from isostat.campaign import study
from support import ROOT

STALE = re.compile(r"not\s+(been\s+)?(made|run)\s+again\s+since")
STAMPS = json.loads((ROOT / "studies/stamps.json").read_text(encoding="utf-8"))


def pages():
    """{study: its pages}, by the table of studies/README.md."""
    rows = re.findall(r"^\| `(\w+)` \|(.*)", (ROOT / "studies/README.md").read_text(encoding="utf-8"), re.M)
    return {name: re.findall(r"\]\(\.\./(docs/results/\w+\.md)", row) for name, row in rows}


def last_cells():
    """{study: minutes and revision}, by the same table."""
    text = (ROOT / "studies/README.md").read_text(encoding="utf-8")
    return dict(re.findall(r"^\| `(\w+)` \|.*\| ([^|]*\| [^|]*) \|$", text, re.M))


def says_when(page, name):
    """Whether a paragraph that names the study says that it is not of today's program."""
    paragraphs = (ROOT / page).read_text(encoding="utf-8").split("\n\n")
    return any(re.search(rf"\b{name}\b", text) and STALE.search(text) for text in paragraphs)


def is_of_today(name):
    found = study.fingerprint(name, study.load(name), STAMPS[name]["keys"])
    return found["scenes"] == STAMPS[name]["scenes"]


class Stamps(unittest.TestCase):
    def test_every_page_is_of_these_scenes_or_says_that_it_is_not(self):
        studies = {path.parent.name for path in (ROOT / "studies").glob("*/__init__.py")}
        self.assertEqual(set(pages()), studies)
        for name, of_study in pages().items():
            is_fresh = name in STAMPS and is_of_today(name)
            for page in of_study:
                with self.subTest(page):
                    self.assertTrue(is_fresh or says_when(page, name), f"a default, or the study {name}, has changed. "
                                    f"Run isostat study {name}, or say in a paragraph that names it when it was made, "
                                    "and that it has not been run again since.")

    def test_minutes_and_revisions_of_the_table_are_those_of_the_stamps(self):
        for name, cells in last_cells().items():
            self.assertEqual(cells, study.cells_of(STAMPS[name]) if name in STAMPS else " | ", name)

    def test_a_default_that_changes_is_noticed(self):
        paper, as_run = study.load("paper"), study.as_run
        before = study.fingerprint("paper", paper)
        self.assertEqual(study.fingerprint("paper", paper), before)

        def with_another_damping(folder, planned):
            run = as_run(folder, planned)
            self.assertIn("contact_damping = 0.05", run.text)  # no scene of the study gives it
            return dataclasses.replace(run, text=run.text.replace("contact_damping = 0.05", "contact_damping = 0.06"))
        with unittest.mock.patch.object(study, "as_run", with_another_damping):
            self.assertNotEqual(study.fingerprint("paper", paper), before)

    def test_a_new_key_leaves_pages_as_they_are(self):
        paper, as_run = study.load("paper"), study.as_run
        before = study.fingerprint("paper", paper)

        def with_a_new_key(value):
            def made(folder, planned):
                run = as_run(folder, planned)
                return dataclasses.replace(run, text=run.text.replace("[motion]", f"[motion]\nnew = {value}"))
            return unittest.mock.patch.object(study, "as_run", made)
        defaults = [*study.default_scenes(), "[motion]\nnew = false\n"]
        with unittest.mock.patch.object(study, "default_scenes", lambda: defaults):
            with with_a_new_key("false"):
                self.assertEqual(study.fingerprint("paper", paper, before["keys"]), before)
                self.assertNotEqual(study.fingerprint("paper", paper), before)
            with with_a_new_key("true"):
                self.assertNotEqual(study.fingerprint("paper", paper, before["keys"]), before)

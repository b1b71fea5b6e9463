#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Pages of results know by which scenes they were made: a default that changes under one makes it stale."""
import dataclasses
import json
import pathlib
import re
import sys
import unittest
import unittest.mock

BINARIES = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else pathlib.Path("build/release/bin")
sys.path.insert(0, str(BINARIES.resolve().parent / "python"))
from isostat.campaign import study  # noqa: E402  (its folder comes first)

ROOT = pathlib.Path(__file__).resolve().parents[2]
STALE = re.compile(r"not\s+(been\s+)?(made|run)\s+again\s+since")
STAMPS = json.loads((ROOT / "studies/stamps.json").read_text(encoding="utf-8"))


def pages():
    """{study: its page}, by the table of studies/README.md."""
    text = (ROOT / "studies/README.md").read_text(encoding="utf-8")
    return dict(re.findall(r"^\| `(\w+)` \|.*?\]\(\.\./(docs/results/\w+\.md)", text, re.M))


class Stamps(unittest.TestCase):
    def test_every_page_is_of_these_scenes_or_says_that_it_is_not(self):
        studies = {path.parent.name for path in (ROOT / "studies").glob("*/__init__.py")}
        self.assertEqual(set(pages()), studies)
        for name, page in pages().items():
            with self.subTest(name):
                says_so = STALE.search((ROOT / page).read_text(encoding="utf-8"))
                is_fresh = name in STAMPS and STAMPS[name]["scenes"] == study.fingerprint(name, study.load(name))
                self.assertTrue(is_fresh or says_so, f"{page}: a default or the study itself has changed. Run isostat "
                                f"study {name}, or say on the page with what program it was made and that it has not "
                                "been run again since.")

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


if __name__ == "__main__":
    unittest.main()

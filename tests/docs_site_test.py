# SPDX-License-Identifier: BSD-3-Clause
"""The documentation site is built without a warning and without network, and every link within it leads somewhere.
Skipped where Sphinx, its parts or doxygen are not installed (scripts/setup.sh --docs)."""
import importlib.util
import pathlib
import shutil
import subprocess
import unittest

from support import BIN, ROOT

MATHJAX = pathlib.Path("/usr/share/javascript/mathjax/MathJax.js")
PAGES = ("index", "../README", "installation", "tutorial/first_test", "guide/stages", "python", "python_api",
         "scene_reference", "theory", "cpp_api", "results", "gallery", "compared")


class Site(unittest.TestCase):
    def test_pages_and_equations(self):
        missing = [name for name in ("sphinx-build", "doxygen") if not shutil.which(name)]
        missing += [name for name in ("myst_parser", "furo") if not importlib.util.find_spec(name)]
        missing += [] if MATHJAX.is_file() else ["libjs-mathjax"]
        if missing:
            self.skipTest(f"{', '.join(missing)} not there")
        build = BIN.parent
        self.assertEqual(subprocess.run([ROOT / "scripts/docs.sh", build, build / "docs"], check=False).returncode, 0)
        site = build / "docs/html/docs"
        self.assertEqual([page for page in PAGES if not (site / f"{page}.html").is_file()], [])
        equations = (site / "theory.html").read_text(encoding="utf-8").count('class="math notranslate nohighlight"')
        self.assertGreater(equations, 20)

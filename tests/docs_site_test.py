#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The documentation site is built without a warning and without network, and every link within it leads somewhere.

Returns 77, skipped, where Sphinx, its parts or doxygen are not installed (scripts/setup.sh --docs).
"""
import importlib.util
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
SKIPPED = 77
MATHJAX = pathlib.Path("/usr/share/javascript/mathjax/MathJax.js")
PAGES = ("index", "../README", "installation", "first_scene", "guide/stages", "python", "python_api", "scene_reference",
         "theory", "cpp_api", "results", "gallery", "compared")


def main(binaries):
    build = pathlib.Path(binaries).resolve().parent
    missing = [name for name in ("sphinx-build", "doxygen") if not shutil.which(name)]
    missing += [name for name in ("myst_parser", "furo") if not importlib.util.find_spec(name)]
    missing += [] if MATHJAX.is_file() else ["libjs-mathjax"]
    missing += [] if (build / "python/isostat").is_dir() else ["the module isostat"]
    if missing:
        print(f"skipped: {', '.join(missing)} not there")
        return SKIPPED
    done = subprocess.run([ROOT / "scripts/docs.sh", build, build / "docs"], check=False)
    if done.returncode != 0:
        return 1
    site = build / "docs/html"
    lost = [page for page in PAGES if not (site / "docs" / f"{page}.html").is_file()]
    equations = (site / "docs/theory.html").read_text(encoding="utf-8").count('class="math notranslate nohighlight"')
    print(f"pages that do not exist: {lost}; equations in theory: {equations}")
    return 0 if not lost and equations > 20 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))

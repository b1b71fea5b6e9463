#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs tests that are written in Python with the programs of a build tree.

    tests/run.py BIN TEST...      e.g. tests/run.py build/release/bin apps/summary_test python/run_test.RunTest

TEST is a file below tests without its ending; a class and a case of it may follow, and options of unittest (-f, -k).
"""
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[1]


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    folders, names = [], []
    for word in sys.argv[2:]:
        folder, _, name = word.removesuffix(".py").rpartition("/")
        folders.append(ROOT / "tests" / folder)
        names.append(name)
    package = pathlib.Path(sys.argv[1]).resolve().parent / "python"
    sys.path[:1] = map(str, [*folders, ROOT / "tests/apps", ROOT / "apps", ROOT / "scripts", ROOT, package])
    unittest.main(module=None, argv=[sys.argv[0], *names])


if __name__ == "__main__":
    main()

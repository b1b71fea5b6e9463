#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The same scenes by programs of other compilers and levels of optimisation, on each instruction set that they have in
common: how far histories are apart, over the largest value of each column, and where the first bit differs.

    compare_builds.py BIN OTHER_BIN [MORE_BINS ...]      folders of the programs, e.g. build/release/bin
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "apps"))
from support import CYCLIC, MONOTONIC, tiny_scene  # noqa: E402  (the path comes first)
from column_support import history  # noqa: E402
from failing_runs import COLUMN  # noqa: E402

CELL = 'domain = "periodic-cell"\npreparation_friction = "10 deg"'
SCENES = {"cyclic box": ("element_test", tiny_scene(stages=CYCLIC.format(steps=2000))),
          "monotonic cell": ("element_test", tiny_scene(specimen=CELL, stages=MONOTONIC.format(steps=2000))),
          "soil column": ("soil_column", COLUMN)}


def run(program, scene, folder, instruction_set=None):
    environment = os.environ | ({"ISOSTAT_INSTRUCTION_SET": instruction_set} if instruction_set else {})
    return subprocess.run([program, scene, "-o", folder, "-q", "--no-figures"], capture_output=True, text=True,
                          env=environment, check=False)


def instruction_sets(bins):
    found = [run(folder / "element_test", "x", "y", "none").stderr for folder in bins]
    sets = [re.search(r"this machine has ([A-Z0-9_, ]+)\.", text)[1].split(", ") for text in found]
    return [name for name in sets[0] if all(name in other for other in sets)]


def compare(one, other):
    """Rows of equal bits, and the largest distance of a column."""
    same = {name: one[name].view(np.uint64) == other[name].view(np.uint64) for name in one}
    rows = int(np.argmin(np.append(np.all(list(same.values()), axis=0), False)))
    columns = ("p", "q", "e") if "q" in one else [name for name in one if one[name].any()]
    apart = {name: np.abs(one[name] - other[name]).max() / np.abs(one[name]).max() for name in columns}
    worst = max(apart, key=apart.get)
    return rows, len(one["step"]), worst, apart[worst]


def main():
    bins = [pathlib.Path(word).resolve() for word in sys.argv[1:]]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        differ = 0
        for name in instruction_sets(bins):
            for scene, (program, text) in SCENES.items():
                pathlib.Path("scene.toml").write_text(text, encoding="utf-8")
                rows = []
                for k, place in enumerate(bins):
                    out = pathlib.Path(f"{scene} {name} {k}")
                    result = run(place / program, "scene.toml", out, name)
                    if result.returncode != 0:
                        sys.exit(f"{place / program}: {result.stderr}")
                    rows.append(history(out))
                for place, other in zip(bins[1:], rows[1:]):
                    same, n, column, apart = compare(rows[0], other)
                    differ += same < n
                    print(f"{name:6} {scene:15} {place}: {same} of {n} rows have the same bits; {column} within "
                          f"{apart:.1e}", flush=True)
        sys.exit(f"{differ} comparisons differ" if differ else 0)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Every scene of this folder against its expected history: `name.toml` beside `name.expected.csv`.

    regression_test.py BIN_FOLDER [--regenerate]

Rows must agree in number and, column by column, within 1e-6 of the column's largest value: other instruction sets round
differently, and within so few steps that does not grow further. --regenerate rewrites the expectations; read the diff.
"""
import csv
import pathlib
import shutil
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
TOLERANCE = 1e-6
LEFT_OUT = {"indicator (-)", "unbalanced (-)"}  # differences of nearly equal numbers


def table(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def run(binary, scene, folder):
    subprocess.run([binary, scene, "-o", folder, "--quiet", "--no-figures"], cwd=ROOT, check=True,
                   stdout=subprocess.DEVNULL)
    return pathlib.Path(folder) / "history.csv"


def compare(name, got, wanted):
    if list(got) != list(wanted):
        return [f"{name}: columns differ: {sorted(set(got) ^ set(wanted))}"]
    problems = []
    for column, values in wanted.items():
        if len(got[column]) != len(values):
            return [f"{name}: {len(got[column])} rows, expected {len(values)}"]
        scale = max(map(abs, values)) or 1.0
        worst = max(abs(a - b) for a, b in zip(got[column], values)) / scale
        if worst > TOLERANCE and column not in LEFT_OUT:
            problems.append(f"{name}: {column} differs by {worst:.2e} of its largest value")
    return problems


def main():
    binary = str(pathlib.Path(sys.argv[1]).resolve() / "element_test")
    problems = []
    scenes = sorted(HERE.glob("*.toml"))
    for scene in scenes:
        with tempfile.TemporaryDirectory() as folder:
            history = run(binary, str(scene), folder + "/results")
            expected = scene.with_suffix(".expected.csv")
            if "--regenerate" in sys.argv:
                shutil.copy(history, expected)
            problems += compare(scene.stem, table(history), table(expected))
    print("\n".join(problems) if problems else f"{len(scenes)} scene(s) agree with their expectations")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Undrained triaxial compression in a box and in periodic cells: one figure and one table from finished runs.

    box_against_cell.py --out FIGURE.png LABEL=RESULTS_FOLDER ...    the first run is what the others are held against

The runs are those of element_test. Strains of the table: 0.01, 0.1, 0.5 and 1 %.
"""
import argparse
import json
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "apps"))
import matplotlib  # noqa: E402

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from figures.common import STYLE, read_history  # noqa: E402

STRAINS = (1e-4, 1e-3, 5e-3, 1e-2)
COLOURS = ("#1a1a1a", "#0072b2", "#d55e00", "#009e73", "#e69f00")


def load(argument):
    label, folder = argument.split("=", 1)
    columns = read_history(pathlib.Path(folder) / "history.csv")
    summary = json.loads((pathlib.Path(folder) / "summary.json").read_text(encoding="utf-8"))
    rows = slice(int(summary["shear_stage_first_row"]), None)
    return label, summary, {name: values[rows] for name, values in columns.items()}


def table(runs):
    print("| run | e | prepared at, ° | Z | " + " | ".join(f"q; p' at {100 * s:g} %, kPa" for s in STRAINS) + " |")
    print("|---" * (4 + len(STRAINS)) + "|")
    for label, summary, c in runs:
        cells = [f"{np.interp(s, c['eps_y'], c['q']) / 1e3:.1f}; {np.interp(s, c['eps_y'], c['p']) / 1e3:.1f}"
                 for s in STRAINS]
        print(f"| {label} | {summary['void_ratio']:.3f} | {summary['preparation_friction_deg']:.2f} | "
              f"{c['Z'][0]:.2f} | "
              + " | ".join(cells) + " |")


def figure(runs, path):
    plt.rcParams.update(STYLE)
    panels = plt.subplots(1, 3, figsize=(9.6, 3.2), layout="constrained")[1]
    for (label, summary, c), colour in zip(runs, COLOURS):
        small = c["eps_y"] <= 1e-3
        panels[0].plot(100 * c["eps_y"][small], c["q"][small] / 1e3, color=colour,
                       label=f"{label}, e = {summary['void_ratio']:.3f}")
        panels[1].plot(100 * c["eps_y"], c["q"] / 1e3, color=colour)
        panels[2].plot(c["p"] / 1e3, c["q"] / 1e3, color=colour)
    for axes, x, letter in zip(panels, ("Axial strain (%)", "Axial strain (%)", "p' (kPa)"), "abc"):
        axes.set(xlabel=x, ylabel="q (kPa)")
        axes.set_title(f"({letter})", loc="left", fontsize=9.5, fontweight="bold")
    panels[0].legend(loc="lower right", fontsize=7.5)
    plt.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("runs", nargs="+", metavar="LABEL=FOLDER")
    parser.add_argument("--out", required=True, help="figure, PNG")
    options = parser.parse_args()
    runs = [load(argument) for argument in options.runs]
    table(runs)
    figure(runs, options.out)


if __name__ == "__main__":
    main()

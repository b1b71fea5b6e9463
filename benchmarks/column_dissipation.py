#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What damping does to the ringing of a column that liquefies, and to its signal.

    column_dissipation.py BIN FOLDER [--docs docs]

BIN      folder of soil_column
FOLDER   runs of apps/scenes/column/recorded_motion.toml, made anew
--docs   where figures/column_dissipation.png goes (default: FOLDER); the table goes to standard output as Markdown
"""
import argparse
import json
import pathlib
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "apps"))
from figures.column_analysis import response_spectrum  # noqa: E402  (the path comes first)
from figures.column_results import Column  # noqa: E402
from figures.common import BLUE, GREY, ORANGE, panel_letter, plt  # noqa: E402

EVERY_STEP = ["output.history_interval=0.001 ms"]
FINE = [f"layer.{k}.cells={n}" for k, n in enumerate((8, 24, 28))]
PLAIN = ["analysis.highest_frequency=0.001 Hz"]
CASES = {  # name: keys
    "none": ["analysis.viscosity=0 ms"],
    "stiffness-proportional, 0.025 ms": ["analysis.viscosity=0.025 ms", *PLAIN],
    "0.05 ms": ["analysis.viscosity=0.05 ms", *PLAIN],
    "0.1 ms": ["analysis.viscosity=0.1 ms", *PLAIN],
    "above 25 Hz, 0.05 ms": ["analysis.viscosity=0.05 ms"],
    "the default, 0.1 ms": [],
    "0.2 ms": ["analysis.viscosity=0.2 ms"],
    "the default, half the step": ["analysis.time_step=0.3775 ms"],
    "none, half the elements": ["analysis.viscosity=0 ms", *FINE],
    "the default, half the elements": FINE,
}
PERIODS = np.array([0.023, 0.1, 0.3, 1.0])


def run(binary, folder, keys):
    settings = [part for key in keys for part in ("--set", key)]
    subprocess.run([binary, HERE.parent / "apps/scenes/column/recorded_motion.toml", "-o", folder, "--overwrite",
                    "--quiet", "--no-figures", *settings], check=True, stdout=subprocess.DEVNULL)
    return Column(folder), json.loads((folder / "summary.json").read_text(encoding="utf-8"))


def share(a, dt):
    """Of the squared Fourier amplitudes above 25 Hz."""
    power = np.abs(np.fft.rfft(a)) ** 2
    return power[np.fft.rfftfreq(len(a), dt) > 25].sum() / power.sum()


def row(name, column, summary):
    cells = [name]
    motion = {axis: column.motion(f"surface_a{axis}") for axis in "xy"}
    cells.append(", ".join(f"{100 * share(*motion[axis]):.0f} %" for axis in "xy"))
    cells.append(", ".join(f"{np.abs(motion[axis][0]).max():.2f}" for axis in "xy"))
    for axis in "xy":
        cells.append(", ".join(f"{value:.3g}" for value in response_spectrum(*motion[axis], PERIODS)))
    cells += [f"{100 * summary['peak_gamma']:.1f} %", f"{summary['max_ru']:.3f}", f"{summary['steps']:,}"]
    print("| " + " | ".join(cells) + " |", flush=True)


def draw(runs, path):
    figure, panels = plt.subplots(2, 2, figsize=(7.2, 5), layout="constrained", sharex="col", width_ratios=(1.5, 1))
    styles = (("none", "undamped, every step", GREY), ("the default, 0.1 ms", "default, every step", ORANGE),
              ("rows", "default, rows of 10 ms", BLUE))
    for k, axis in enumerate("xy"):
        for name, label, colour in styles:
            column = runs[name]
            panels[k, 0].plot(column.time, column[f"surface_a{axis}"], color=colour, linewidth=0.6, label=label)
            if name != "rows":
                panels[k, 1].plot(column.spectra["period"], column.spectra[f"surface_{axis}"], color=colour)
        panels[k, 0].set_xlim(1, 9)
        panels[k, 0].set_ylabel(f"$a_{axis}$ of the surface (m/s$^2$)")
        panels[k, 1].set_ylabel("$S_a$ (m/s$^2$), 5 % damping")
        panels[k, 1].set_xscale("log")
        panels[k, 1].axvspan(0.02, 0.04, color="#eeeeee", zorder=0)
        panels[k, 1].set_xlim(0.02, 5)
        panels[k, 1].set_ylim(bottom=0)
        panel_letter(panels[k, 0], "ac"[k])
        panel_letter(panels[k, 1], "bd"[k])
    panels[0, 0].legend(loc="lower right", fontsize=8)
    panels[1, 0].set_xlabel("Time (s)")
    panels[1, 1].set_xlabel("Period (s)")
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--docs", type=pathlib.Path)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    runs = {}
    print("| damping | above 25 Hz, x and y | peak, m/s2 | S_a(0.023, 0.1, 0.3, 1 s) along x, m/s2 | along y | "
          "peak strain | largest r_u | steps |\n|---|---|---|---|---|---|---|---|")
    for n, (name, keys) in enumerate({**{k: [*v, *EVERY_STEP] for k, v in CASES.items()}, "rows": []}.items()):
        runs[name], summary = run(options.bin.resolve() / "soil_column", options.folder / f"run{n}", keys)
        row("the default, rows of 10 ms" if name == "rows" else name, runs[name], summary)
    draw(runs, (options.docs / "figures" if options.docs else options.folder) / "column_dissipation.png")


if __name__ == "__main__":
    main()

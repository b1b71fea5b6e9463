#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The soil column against others: a hyperbola with Masing's rules, layer matrices, the equivalent-linear method.

    column_others.py [--quick] [--only masing published equivalent] [--build build/release]
                     [--folder results/column_others] [--report docs/results/column_others]

Runs soil_column on the cases of tests/apps/column_cases.py, solves them again with tests/apps/column_masing.py and
column_layers.py, and writes a table (CSV) and a figure of each comparison into REPORT (FOLDER if not given). Ten
minutes on one core; `--quick`, in a minute, shows that all works.
"""
import argparse
import csv
import pathlib
import subprocess
import sys

import h5py
import numpy as np
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests/apps"))
import column_cases as cases  # noqa: E402
from column_layers import Layers, equivalent_linear  # noqa: E402

BLUE, RED, GREY = "#0072b2", "#d55e00", "#7f7f7f"
PERIODS = np.geomspace(0.1, 2, 40)


class Bench:
    def __init__(self, options):
        self.program, self.quick = pathlib.Path(options.build) / "bin/soil_column", options.quick
        self.folder = pathlib.Path(options.folder)
        self.report = pathlib.Path(options.report or options.folder)
        for folder in (self.folder, self.report):
            folder.mkdir(parents=True, exist_ok=True)

    def run(self, name, scene):
        path = self.folder / f"{name}.toml"
        path.write_text(scene, encoding="utf-8")
        command = [self.program, path, "-o", self.folder / name, "--overwrite", "--quiet", "--no-figures"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with h5py.File(self.folder / name / "history.h5") as file:
            return {key: values[()] for key, values in file["history"].items()}

    def write(self, name, rows):
        print(f"\n{name}\n" + "\n".join("  ".join(f"{k} {v}" for k, v in row.items()) for row in rows), flush=True)
        with open(self.report / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
            table = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
            table.writeheader()
            table.writerows(rows)

    def save(self, name, figure):
        figure.savefig(self.report / f"{name}.png", dpi=130)
        plt.close(figure)


def percent(value):
    return f"{100 * value:.3g}"


# --- a hyperbola with Masing's rules ---------------------------------------------------------------------------------


def masing_row(label, rows, other):
    """Of one run beside the beam's (time, surface, strains)."""
    time, interval = rows["time"], rows["time"][1]
    surface = np.interp(time, other[0], other[1])
    strains = [np.interp(time, other[0], strain) for strain in other[2]]
    mine = [rows[f"d{k}_gamma_xz"] for k in range(2)]
    both = range(2)
    smooth = [cases.low_passed(a, interval, 10) for a in (rows["surface_ax"], surface, *mine, *strains)]
    spectra = [cases.response_spectrum(a, interval, PERIODS) for a in (rows["surface_ax"], surface)]
    return label | {
        "largest strain (%)": percent(max(np.abs(s).max() for s in strains)),
        "acceleration below 10 Hz (%)": percent(cases.largest_difference(smooth[0], smooth[1])),
        "strain below 10 Hz (%)": percent(max(cases.largest_difference(smooth[2 + k], smooth[4 + k]) for k in both)),
        "strain (%)": percent(max(cases.largest_difference(a, b) for a, b in zip(mine, strains))),
        "peak strain (%)": percent(max(abs(np.abs(a).max() / np.abs(b).max() - 1) for a, b in zip(mine, strains))),
        "spectrum 0.1 to 2 s (%)": percent(np.abs(spectra[0] / spectra[1] - 1).max())}


def masing(bench):
    table, shown = [], {}
    motions = (("harmonic 1", cases.HARMONIC.format(1), 5), ("harmonic 3", cases.HARMONIC.format(3), 5),
               ("record 5", cases.RECORDED.format(5), 16))
    plan = ((12, 80), (32, 80), (64, 80), (128, 40), (128, 80), (128, 160))
    for name, motion, duration in motions[1:2] if bench.quick else motions:
        pairs = ((12, 40), (128, 40)) if bench.quick else plan[::4] if name.startswith("record") else plan
        for elements, cells in pairs:
            step = 0.016 / cells
            rows = bench.run(f"masing_{name.replace(' ', '_')}_{elements}_{cells}",
                             cases.sand_scene(motion, cells=cells, elements=elements, step=step, duration=duration))
            ratio = 3 if cells < 160 else 1  # odd: the same depths are middles of elements
            depths = [(np.floor(z * cells / cases.HEIGHT) + 0.5) * cases.HEIGHT / cells for z in cases.DEPTHS]
            beam = cases.sand_beam(ratio * cells).run(rows["time"], rows["input_ax"], min(step, 1e-4), depths)
            label = {"motion (m/s2)": name, "elements of the sand": elements, "cells": cells,
                     "step (ms)": f"{1e3 * step:.3g}"}
            table.append(masing_row(label, rows, beam))
            if name == "harmonic 3" and cells == (40 if bench.quick else 80):
                shown[elements] = (rows, beam)
    bench.write("masing", table)
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), constrained_layout=True)
    for (elements, (rows, _)), colour in zip(((n, shown[n]) for n in (12, 128)), (RED, BLUE)):
        time, interval = rows["time"], rows["time"][1]
        axes[0].plot(100 * rows["d0_gamma_xz"], rows["d0_tau_xz"] / 1e3, color=colour, lw=1,
                     label=f"Iwan, {elements} elements")
        axes[1].plot(time, cases.low_passed(rows["surface_ax"], interval, 10), color=colour, lw=1)
    at, surface, strain, stress = shown[128][1]
    axes[0].plot(100 * strain[0], stress[0] / 1e3, "k:", lw=1.2, label="hyperbola, Masing's rules")
    axes[1].plot(at, cases.low_passed(surface, at[1], 10), "k:", lw=1.2)
    axes[0].set(xlabel="shear strain (%)", ylabel="shear stress (kPa)", title="Soil in the middle of the column")
    axes[1].set(xlabel="time (s)", ylabel="acceleration below 10 Hz (m/s²)", title="Surface")
    axes[0].legend(frameon=False)
    bench.save("masing", figure)


# --- layer matrices --------------------------------------------------------------------------------------------------


def published(bench):
    profile, frequency, amplification = cases.published()
    layers = Layers(*profile.T, rock=tuple(profile[-1, 1:]))
    own = np.abs(layers.surface(frequency)) / amplification - 1
    table = [{"solution": "own layer matrices", "elements": 0, "to (Hz)": 50, "largest (%)": percent(np.abs(own).max()),
              "median (%)": percent(np.median(np.abs(own)))}]
    plan = ((20, 5, 9),) if bench.quick else ((50, 4, 14), (50, 8, 14))
    figure, axes = plt.subplots(2, 1, figsize=(9, 6.4), sharex=True, constrained_layout=True)
    axes[0].plot(frequency, amplification, color="k", lw=1.2, label="nrattle, 400 layers")
    for (corner, per_wave, duration), colour in zip(plan, (RED, BLUE)):
        rows = bench.run(f"published_{per_wave}", cases.published_scene(bench.folder, corner, per_wave, duration))
        low = (frequency > 0) & (frequency <= corner)
        mine = cases.amplification(rows, frequency[low])
        off = mine / amplification[low] - 1
        table.append({"solution": "soil_column", "elements": per_wave, "to (Hz)": corner,
                      "largest (%)": percent(np.abs(off).max()), "median (%)": percent(np.median(np.abs(off)))})
        axes[0].plot(frequency[low], mine, "--", color=colour, lw=1)
        axes[1].plot(frequency[low], 100 * off, color=colour, lw=1,
                     label=f"soil_column, {per_wave} quadratic elements for the shortest wave")
    axes[1].plot(frequency, 100 * own, color=GREY, lw=1, label="own layer matrices")
    axes[0].set(ylabel="surface over outcrop (-)", title="8 km of undamped soil and rock")
    axes[1].set(xlabel="frequency (Hz)", ylabel="difference from nrattle (%)")
    for one in axes:
        one.legend(frameon=False)
    bench.write("published", table)
    bench.save("published", figure)


# --- equivalent linear -----------------------------------------------------------------------------------------------


def equivalent(bench):
    layers, reference = cases.sand_layers(80, cases.ROCK)
    table, spectra = [], {}
    for peak in (0.01, 3) if bench.quick else (0.001, 0.01, 0.1, 0.5, 1, 3, 8):
        scene = cases.sand_scene(cases.RECORDED.format(peak), elements=64, rows=5, duration=20, rock=cases.ROCK)
        rows = bench.run(f"equivalent_{peak}", scene)
        interval = rows["time"][1]
        surface, strains, change = equivalent_linear(layers, reference, rows["input_ax"], interval)
        mine, other = (cases.response_spectrum(a, interval, PERIODS) for a in (rows["surface_ax"], surface))
        spectra[peak] = mine / other
        depth = (np.arange(80) + 0.5) * cases.HEIGHT / 80
        strain = [np.abs(rows[f"d{k}_gamma_xz"]).max() / np.interp(z, depth, strains) - 1
                  for k, z in enumerate(cases.DEPTHS)]
        table.append({"peak of the outcrop (m/s2)": peak,
                      "largest strain over the reference strain": f"{(strains / reference).max():.3g}",
                      "spectrum, least (%)": percent(spectra[peak].min() - 1),
                      "most (%)": percent(spectra[peak].max() - 1),
                      "peak acceleration (%)": percent(np.abs(rows["surface_ax"]).max() / np.abs(surface).max() - 1),
                      "peak strain at 10 m (%)": percent(strain[0]), "at 20 m (%)": percent(strain[1]),
                      "last pass (%)": percent(change)})
    bench.write("equivalent", table)
    figure, axis = plt.subplots(figsize=(7, 4.4), constrained_layout=True)
    colours = plt.get_cmap("viridis")(np.linspace(0, 0.9, len(spectra)))
    for (peak, ratio), colour in zip(spectra.items(), colours):
        axis.semilogx(PERIODS, ratio, color=colour, lw=1.3, label=f"{peak} m/s²")
    axis.set(xlabel="period (s)", ylabel="response spectrum: Iwan over equivalent linear (-)", xlim=(0.1, 2))
    axis.legend(frameon=False, title="peak of the outcrop")
    bench.save("equivalent", figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parts = {"masing": masing, "published": published, "equivalent": equivalent}
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", nargs="+", choices=parts, default=list(parts))
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--folder", default="results/column_others")
    parser.add_argument("--report")
    options = parser.parse_args()
    bench = Bench(options)
    for name in options.only:
        parts[name](bench)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""An undrained column of packings beside an Iwan column that is fitted to the curve of such a packing.

    column_fitted.py [--build build/release] [--folder results/column_fitted] [--report docs/results/column_others]

A packing of 300 grains (apps/scenes/rve_library.toml) is sheared at constant volume at 100 and 200 kPa by element_test.
The Iwan sand has G and its exponent from the secants at a strain of 2e-5, and the strength ratio, mean of both, from
the hyperbolas of that G through the curves up to 0.5 %; it neither contracts nor dilates. Both columns have the same
mesh, water, motion and mass damping, in three strengths of shaking. Writes a table (fitted.csv) and a figure
(fitted.png) into REPORT. Two minutes on one core.
"""
import argparse
import csv
import pathlib
import subprocess

import h5py
import numpy as np
import matplotlib
from scipy import optimize

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

LIBRARY = pathlib.Path(__file__).resolve().parents[1] / "apps/scenes/rve_library.toml"
SIZE = {"grading.grains": "300", "grading.cloud_edge": "3.107 mm"}
PRESSURES, SMALL_STRAIN, LARGEST_STRAIN, PEAKS = (100e3, 200e3), 2e-5, 0.005, (0.02, 0.1, 0.2)
STAGE = '[[stage]]\nkind = "{}"\n{}\n'
COLUMN = """title = "{title}"
[mesh]
degree = 1
[water]
drainage = "undrained"
[[layer]]
name = "sand"
thickness = "10 m"
cells = 10
density = "1970 kg/m3"
porosity = 0.41
k0 = 1.0
{soil}
[load]
surcharge = "100 kPa"
[[motion]]
kind = "harmonic"
amplitude = "{peak} g"
frequency = "2 Hz"
duration = "4 s"
ramp = "1 s"
[analysis]
viscosity = "0 ms"
duration = "5 s"
time_step = "4 ms"
mass_damping = "0.2 1/s"
[output]
history_interval = "4 ms"
depths = ["9.5 m"]
"""
GREY, BLUE = "#7f7f7f", "#0072b2"


def hyperbola(strain, modulus, strength):
    return modulus * strain / (1 + modulus * strain / strength)


class Runs:
    def __init__(self, options):
        self.bin, self.folder = pathlib.Path(options.build).resolve() / "bin", pathlib.Path(options.folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def call(self, program, *arguments):
        subprocess.run([self.bin / program, *arguments], cwd=self.folder, check=True, stdout=subprocess.DEVNULL)

    def library(self):
        if not (self.folder / "library.h5").exists():
            sizes = [part for key, value in SIZE.items() for part in ("--set", f"{key}={value}")]
            self.call("isostat", "library", LIBRARY, "-o", "library.h5", "--pressures", "100 kPa", *sizes)

    def curve(self, pressure):
        """(gamma, tau) of undrained simple shear from an isotropic pressure."""
        head = LIBRARY.read_text(encoding="utf-8").split("[motion]")[0]
        compress = "" if pressure == 100e3 else STAGE.format("compress", f'pressure = "{pressure} Pa"')
        shear = STAGE.format("undrained-simple-shear", "strain = 0.01")
        name = f"shear_{pressure / 1e3:.0f}"
        (self.folder / f"{name}.toml").write_text(
            head + '[motion]\nstrain_rate = "0.1 1/s"\n' + compress + shear +
            '[output]\nrecord_stress = "0.2 kPa"\nrecord_strain = 2e-6\nsnapshots = "none"\nparaview = false\n',
            encoding="utf-8")
        sizes = [part for key, value in SIZE.items() for part in ("--set", f"{key}={value}")]
        self.call("element_test", f"{name}.toml", "-o", name, "--overwrite", "--no-figures", "--quiet", *sizes)
        with open(self.folder / name / "history.csv", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        last = rows[-1]["stage (-)"]
        rows = [row for row in rows if row["stage (-)"] == last]
        return np.array([[float(row[key]) for row in rows] for key in ("gamma_xy (-)", "tau_xy (Pa)")])

    def column(self, name, soil, peak):
        (self.folder / f"{name}.toml").write_text(COLUMN.format(title=name, soil=soil, peak=peak), encoding="utf-8")
        self.call("soil_column", f"{name}.toml", "-o", name, "--overwrite", "--no-figures", "--quiet")
        with h5py.File(self.folder / name / "history.h5") as file:
            return {key: values[()] for key, values in file["history"].items()}


def fit(curves):
    """(modulus, strength) of each curve, Pa, and the largest misfit over the largest stress."""
    found, misfit = [], 0
    for strain, stress in curves:
        part = (strain > 0) & (strain <= LARGEST_STRAIN)
        small = np.searchsorted(strain, SMALL_STRAIN)
        modulus = (stress[small] - stress[0]) / (strain[small] - strain[0])
        most, _ = optimize.curve_fit(lambda x, tau: hyperbola(x, modulus, tau), strain[part], stress[part], p0=5e4)
        values = modulus, most[0]
        misfit = max(misfit, np.abs(hyperbola(strain[part], *values) - stress[part]).max() / stress[part].max())
        found.append(values)
    return np.array(found), misfit


def draw(curves, fitted, results, path):
    figure, axes = plt.subplots(2, 3, figsize=(13, 7.4), constrained_layout=True)
    axis = axes[0, 0]
    for (strain, stress), values, pressure in zip(curves, fitted, PRESSURES):
        axis.plot(100 * strain, stress / 1e3, color=BLUE, lw=1.2)
        axis.plot(100 * strain, hyperbola(strain, *values) / 1e3, "k:", lw=1.2)
        axis.annotate(f"{pressure / 1e3:.0f} kPa", (100 * strain[-1], stress[-1] / 1e3), ha="right", va="top",
                      xytext=(0, -4), textcoords="offset points")
    axis.set(xlabel="shear strain (%)", ylabel="shear stress (kPa)", title="One packing, and hyperbolas fitted")
    for axis, (peak, (grains, iwan)) in zip(axes.flat[1:4], results.items()):
        for rows, colour, label in ((grains, BLUE, "packings"), (iwan, "k", "Iwan")):
            axis.plot(rows["time"], rows["surface_ax"], color=colour, lw=1 if colour == BLUE else 0.9, label=label,
                      ls="-" if colour == BLUE else ":")
        axis.set(xlabel="time (s)", ylabel="surface acceleration (m/s²)", title=f"Base at {peak} g")
    axes[0, 1].legend(frameon=False)
    for axis, peak in zip(axes.flat[4:], PEAKS[1:]):
        for rows, colour in zip(results[peak], (BLUE, "k")):
            axis.plot(100 * rows["d0_gamma_xz"], rows["d0_tau_xz"] / 1e3, color=colour, lw=0.9,
                      ls="-" if colour == BLUE else ":")
        axis.set(xlabel="shear strain (%)", ylabel="shear stress (kPa)", title=f"At 9.5 m, base at {peak} g")
    figure.savefig(path, dpi=130)


def compare(peak, grains, iwan):
    """A row of the table; parted: when strains at 9.5 m first differ by a fifth of the Iwan column's largest."""
    time, limit = grains["time"], 0.2 * np.abs(iwan["d0_gamma_xz"]).max()
    apart = np.abs(grains["d0_gamma_xz"] - iwan["d0_gamma_xz"]) > limit
    first = int(np.argmax(apart)) if apart.any() else None
    before = np.maximum.accumulate(grains["d0_ru"])

    def peaks(name, scale):
        return [f"{scale * np.abs(rows[name]).max():.3g}" for rows in (grains, iwan)]
    row = {"base (g)": peak}
    row["surface, packings (m/s2)"], row["Iwan (m/s2)"] = peaks("surface_ax", 1)
    row["strain at 9.5 m, packings (%)"], row["Iwan (%)"] = peaks("d0_gamma_xz", 100)
    rms = np.sqrt(np.mean((grains["surface_ax"] - iwan["surface_ax"]) ** 2) / np.mean(iwan["surface_ax"] ** 2))
    row["surface, rms of the difference (%)"] = f"{100 * rms:.3g}"
    row["largest r_u at 9.5 m (-)"] = f"{before[-1]:.3g}"
    row["parted (s)"] = f"{time[first]:.2f}" if apart.any() else "-"
    row["r_u then (-)"] = f"{before[first]:.3g}" if apart.any() else "-"
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--folder", default="results/column_fitted")
    parser.add_argument("--report", default="docs/results/column_others")
    options = parser.parse_args()
    runs, report = Runs(options), pathlib.Path(options.report)
    report.mkdir(parents=True, exist_ok=True)
    runs.library()
    curves = [runs.curve(pressure) for pressure in PRESSURES]
    fitted, misfit = fit(curves)
    exponent = np.log(fitted[1, 0] / fitted[0, 0]) / np.log(PRESSURES[1] / PRESSURES[0])
    ratios = fitted[:, 1] / PRESSURES
    print(f"G {fitted[:, 0] / 1e6} MPa, exponent {exponent:.3f}, strength ratios {ratios}, misfit {100 * misfit:.2f} %")
    soil = (f'material = "iwan"\nshear_modulus = "{fitted[0, 0] / 1e6} MPa"\nexponent = {exponent}\n'
            f"strength_ratio = {ratios.mean()}\ncontraction = 0\ndilation = 0\nelements = 64")
    packings = 'material = "grains"\nrelative_density = 0.5\n[grains]\nlibrary = "library.h5"\ncache = "in_situ.h5"'
    kinds = ("packings", packings), ("iwan", soil)
    results = {peak: [runs.column(f"{name}_{peak}", text, peak) for name, text in kinds] for peak in PEAKS}
    rows = [compare(peak, *pair) for peak, pair in results.items()]
    with open(report / "fitted.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    print("\n".join(str(row) for row in rows))
    draw(curves, fitted, results, report / "fitted.png")


if __name__ == "__main__":
    main()

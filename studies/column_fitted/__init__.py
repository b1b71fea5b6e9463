# SPDX-License-Identifier: BSD-3-Clause
"""An undrained column of packings next to an Iwan column that is fitted to the curve of such a packing.

A packing of 300 grains (apps/scenes/rve_library.toml) is sheared at constant volume at 100 and 200 kPa by element_test.
The Iwan sand has G and its exponent from the secants at a strain of 2e-5, and the strength ratio, mean of both, from
the hyperbolas of that G through the curves up to 0.5 %; it neither contracts nor dilates. Both columns have the same
mesh, water, motion and mass damping, in three strengths of shaking.
"""
import isostat
import numpy as np
from scipy import optimize

from figures.common import BLUE, plt
from isostat.campaign.runs import Run as Process, complete
from isostat.results import read_table
from studies.columns import SCENES, Run, histories, library
from studies.drawing import save
from studies.tables import write_tables

DEFAULTS, QUICK, PAGE = {}, {}, "column_others"
SIZE = {"grading.grains": 300, "grading.cloud_edge": "3.107 mm"}
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


def hyperbola(strain, modulus, strength):
    return modulus * strain / (1 + modulus * strain / strength)


def curve_run(folder, pressure):
    """Undrained simple shear of a packing from an isotropic pressure, by element_test."""
    scene = (SCENES / "rve_library.toml").read_text(encoding="utf-8").split("[motion]")[0]
    scene += '[motion]\nstrain_rate = "0.1 1/s"\n'
    scene += "" if pressure == 100e3 else STAGE.format("compress", f'pressure = "{pressure} Pa"')
    scene += STAGE.format("undrained-simple-shear", "strain = 0.01")
    scene += '[output]\nrecord_stress = "0.2 kPa"\nrecord_strain = 2e-6\nsnapshots = "none"\nparaview = false\n'
    return Process.below(folder / "curves", f"shear_{pressure / 1e3:.0f}", isostat.Scene(scene, set=SIZE))


def curve(run):
    """(gamma, tau)."""
    h = read_table(run.results / "history.csv")
    return np.array([h[name][h["stage"] == h["stage"][-1]] for name in ("gamma_xy", "tau_xy")])


def curves_of(folder):
    return [curve(curve_run(folder, pressure)) for pressure in PRESSURES]


def prepare(options, executor):
    library(options.output / "library.h5", executor, 1, ["100 kPa"], SIZE)
    needed = [curve_run(options.output, pressure) for pressure in PRESSURES]
    complete(executor, [run for run in needed if not run.is_finished])


def runs(options):
    files = options.output / "library.h5", *(curve_run(options.output, p).results / "summary.json" for p in PRESSURES)
    iwan = iwan_of(*fit(curves_of(options.output))) if all(file.is_file() for file in files) else ""
    packings = (f'material = "grains"\nrelative_density = 0.5\n[grains]\nlibrary = "{files[0]}"\n'
                f'cache = "{options.output / "in_situ.h5"}"')
    return [Run((kind, peak), COLUMN.format(title=f"{kind}_{peak}", soil=soil, peak=peak), seconds=seconds, needs=files)
            for peak in PEAKS for kind, soil, seconds in (("packings", packings, 600 * peak), ("iwan", iwan, 4))]


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


def iwan_of(fitted, misfit):
    """The Iwan sand with this fit."""
    exponent = np.log(fitted[1, 0] / fitted[0, 0]) / np.log(PRESSURES[1] / PRESSURES[0])
    ratios = fitted[:, 1] / PRESSURES
    print(f"G {fitted[:, 0] / 1e6} MPa, exponent {exponent:.3f}, strength ratios {ratios}, misfit {100 * misfit:.2f} %")
    return (f'material = "iwan"\nreference_pressure = "{PRESSURES[0] / 1e3} kPa"\n'
            f'shear_modulus = "{fitted[0, 0] / 1e6} MPa"\nexponent = {exponent}\n'
            f"strength_ratio = {ratios.mean()}\ncontraction = 0\ndilation = 0\nelements = 64")


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
    save(figure, path, dpi=130)


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


def report(store, planned, folder):
    found = histories(store, planned)
    results = {peak: [found["packings", peak], found["iwan", peak]] for peak in PEAKS
               if {("packings", peak), ("iwan", peak)} <= found.keys()}
    rows = [compare(peak, *pair) for peak, pair in results.items()]
    if rows:
        write_tables(folder, {"fitted": (list(rows[0]), [list(row.values()) for row in rows])})
    if len(results) == len(PEAKS):
        curves = curves_of(store.run(planned[0]).scene.parents[1])
        draw(curves, fit(curves)[0], results, folder / "fitted.png")

# SPDX-License-Identifier: BSD-3-Clause
"""The soil column against others: a hyperbola with Masing's rules, layer matrices, the equivalent-linear method.

The cases are in studies/column_cases.py; studies/column_masing.py and studies/column_layers.py solve them again, which
takes as long as the runs.
"""
import numpy as np

from figures.common import BLUE, GREY, RED, plt
from studies import column_cases as cases
from studies.column_layers import Layers, equivalent_linear, hyperbola
from studies.columns import Run, histories
from studies.drawing import save
from studies.tables import write_tables

DEFAULTS, QUICK = {}, {}
PERIODS = np.geomspace(0.1, 2, 40)
MOTIONS = {"harmonic 1": (cases.HARMONIC.format(1), 5), "harmonic 3": (cases.HARMONIC.format(3), 5),
           "record 5": (cases.RECORDED.format(5), 16)}  # and duration, s
MESHES = (12, 80), (32, 80), (64, 80), (128, 40), (128, 80), (128, 160)  # elements of the sand, cells


def step_of(cells):
    return 0.016 / cells


def corner(options):
    """Highest frequency of the published example, Hz."""
    return 20 if options.quick else 50


def prepare(options, _executor):
    cases.write_published(options.output, corner(options))


def runs(options):
    quick, files = options.quick, options.output
    sands = [("harmonic 3", 12, 40), ("harmonic 3", 128, 40)] if quick else [
        (motion, *mesh) for motion in MOTIONS for mesh in MESHES[::4 if motion == "record 5" else 1]]
    found = [Run(("masing", motion, elements, cells), cases.sand_scene(
        MOTIONS[motion][0], cells=cells, elements=elements, step=step_of(cells), duration=MOTIONS[motion][1]))
        for motion, elements, cells in sands]
    found += [Run(("published", corner(options), per_wave), cases.published_scene(
        files, corner(options), per_wave, 9 if quick else 14), needs=(files / "pulse.txt",))
        for per_wave in ((5,) if quick else (4, 8))]
    return found + [Run(("equivalent", peak), cases.sand_scene(
        cases.RECORDED.format(peak), elements=64, rows=5, duration=20, rock=cases.ROCK))
        for peak in ((0.01, 3) if quick else (0.001, 0.01, 0.1, 0.5, 1, 3, 8))]


def percent(value):
    return f"{100 * value:.3g}"


# --- a hyperbola with Masing's rules ---------------------------------------------------------------------------------


def masing_row(label, rows, other):
    """Of one run next to the beam's (time, surface, strains)."""
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


def masing(results, path):
    table, shown = [], {}
    for (name, elements, cells), rows in results:
        step, ratio = step_of(cells), 3 if cells < 160 else 1  # odd: the same depths are middles of elements
        depths = [(np.floor(z * cells / cases.HEIGHT) + 0.5) * cases.HEIGHT / cells for z in cases.DEPTHS]
        beam = cases.sand_beam(ratio * cells).run(rows["time"], rows["input_ax"], min(step, 1e-4), depths)
        label = {"motion (m/s2)": name, "elements of the sand": elements, "cells": cells,
                 "step (ms)": f"{1e3 * step:.3g}"}
        table.append(masing_row(label, rows, beam))
        if name == "harmonic 3" and cells in (40, 80):  # 40 where there is no other
            shown[elements] = (rows, beam)
    if {12, 128} <= shown.keys():
        draw_masing(shown, path)
    return table


def draw_masing(shown, path):
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
    save(figure, path, dpi=130)


# --- layer matrices --------------------------------------------------------------------------------------------------


def published(results, path):
    profile, frequency, amplification = cases.published()
    layers = Layers(*profile.T, rock=tuple(profile[-1, 1:]))
    own = np.abs(layers.surface(frequency)) / amplification - 1
    table = [{"solution": "own layer matrices", "elements": 0, "to (Hz)": 50, "largest (%)": percent(np.abs(own).max()),
              "median (%)": percent(np.median(np.abs(own)))}]
    figure, axes = plt.subplots(2, 1, figsize=(9, 6.4), sharex=True, constrained_layout=True)
    axes[0].plot(frequency, amplification, color="k", lw=1.2, label="nrattle, 400 layers")
    for ((corner, per_wave), rows), colour in zip(results, (RED, BLUE)):
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
    save(figure, path, dpi=130)
    return table


# --- equivalent linear -----------------------------------------------------------------------------------------------


def equivalent(results, path):
    layers, reference = cases.sand_layers(80, cases.ROCK)
    table, spectra = [], {}
    for (peak,), rows in results:
        interval = rows["time"][1]
        surface, strains, change = equivalent_linear(layers, lambda x: hyperbola(x / reference), rows["input_ax"],
                                                     interval)
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
    figure, axis = plt.subplots(figsize=(7, 4.4), constrained_layout=True)
    colours = plt.get_cmap("viridis")(np.linspace(0, 0.9, len(spectra)))
    for (peak, ratio), colour in zip(spectra.items(), colours):
        axis.semilogx(PERIODS, ratio, color=colour, lw=1.3, label=f"{peak} m/s²")
    axis.set(xlabel="period (s)", ylabel="response spectrum: Iwan over equivalent linear (-)", xlim=(0.1, 2))
    axis.legend(frameon=False, title="peak of the outcrop")
    save(figure, path, dpi=130)
    return table


def report(store, planned, folder):
    results = histories(store, planned)
    tables = {}
    for part in (masing, published, equivalent):
        of_part = [(case[1:], rows) for case, rows in results.items() if case[0] == part.__name__]
        if of_part:
            rows = part(of_part, folder / f"{part.__name__}.png")
            tables[part.__name__] = list(rows[0]), [list(row.values()) for row in rows]
    write_tables(folder, tables)

# SPDX-License-Identifier: BSD-3-Clause
"""Tables and figures of the fit, the cyclic test and the slopes."""
import itertools

import h5py
import matplotlib.pyplot as plt
import numpy as np

from isostat.figures.common import legend_below
from isostat.results import read_table
from studies.drawing import BLUE, GREEN, GREY, ORANGE, panels, save
from studies.ensembles import ensemble
from studies.history import parsed
from studies.leap_slope import cyclic, drained
from studies.tables import read_csv, write_csv

DEPTHS = (0.8, 1.8, 2.8, 3.8)  # m, near those of the centrifuges' transducers, 1 to 4 m
BUOYANT = 10.08  # unit weight of the scene, kN/m3
PACKINGS = {"slope": "compacted", "opened": "opened"}
TIMES = np.arange(0, 20, 0.05)  # s, of curves


def done(store, planned, kind):
    return [(run, store.folder(run)) for run in planned if run.kind == kind and store.is_done(run)]


def strengths(store, planned):
    """{(friction, limit, preparation, seed): strength} of the grid, and the runs of the fitted sand with theirs."""
    found = [(run, drained.strength(read_table(folder / "history.csv")))
             for run, folder in done(store, planned, "drained")]
    return ({(run.friction, run.limit, run.preparation, run.seed): value for run, value in found if run.friction},
            [(run, value) for run, value in found if run.void_ratio])


def fit_rows(grid):
    """Of all packings, and of those of each seed alone."""
    seeds = sorted({key[3] for key in grid})
    for of in ([seeds] if len(seeds) == 1 else [seeds, *([seed] for seed in seeds)]):
        part = {key: value for key, value in grid.items() if key[3] in of}
        if len(part) < len(of) * len(drained.FRICTIONS) * len(drained.LIMITS) * len(drained.PREPARATIONS):
            continue
        friction, limit, misfit, tests = drained.fit(part)
        for e0, (laboratory, peak, preparation) in tests.items():
            yield {"seeds": " ".join(map(str, of)), "friction (deg)": friction, "eta_r": limit, "misfit (deg)": misfit,
                   "e0": e0, "laboratory (deg)": laboratory, "fit (deg)": peak, "preparation (deg)": preparation}


def made_of(run):
    return PACKINGS["opened" if run.expansion else "slope"]


def check_rows(checked):
    for made, row in itertools.product(PACKINGS.values(), drained.tests()):
        mode = "compression" if row["mode"] == "TC" else "extension"
        values = [value for run, value in checked if (run.void_ratio, run.pressure, run.direction, made_of(run)) ==
                  (row["e0"], row["sigma_3 (kPa)"], mode, made)]
        if not values:
            continue
        (peak, deviation, _, n), (strain, *_), (e, *_) = map(ensemble, zip(*values))
        yield {"packings": made, "e0": row["e0"], "direction": mode, "sigma_3 (kPa)": row["sigma_3 (kPa)"],
               "fitted": drained.is_fitted(row) and made == "compacted",
               "laboratory (deg)": row["peak friction (deg)"], "packings (deg)": peak,
               "s.d.": deviation, "n": n, "difference (deg)": peak - row["peak friction (deg)"],
               "strain at the peak, laboratory (%)": abs(row["strain at the peak (%)"]), "packings (%)": 100 * strain,
               "e of packings": e}


def modulus_rows(store, planned):
    """G next to the sand for which E was chosen, and at the void ratio of the packings."""
    for made in PACKINGS.values():
        found = [store.run(run).result for run, _ in done(store, planned, "modulus") if made_of(run) == made]
        if found:
            (g, deviation, _, n), (e, *_) = (ensemble([one[name] for one in found]) for name in ("G", "void_ratio"))
            yield {"packings": made, "e of packings": e, "G (MPa)": g, "s.d.": deviation, "n": n,
                   "sand of e 0.604 (MPa)": drained.hardin_richart(0.604, 100),
                   "sand of that e (MPa)": drained.hardin_richart(e, 100)}


def cyclic_rows(store, planned):
    for run, folder in done(store, planned, "cyclic"):
        yield {"packings": made_of(run), "e0": run.void_ratio, "seed": run.seed, **cyclic.cycles(folder)}


def slope_of(folder):
    """Displacement of the surface against the base, and r_u at DEPTHS, at TIMES."""
    rows = read_table(folder / "history.csv")
    with h5py.File(folder / "profiles.h5") as file:
        depth, time, ru = (file[name][()] for name in ("depth", "time", "ru"))
    at = [int(np.abs(depth - z).argmin()) for z in DEPTHS]
    return (np.interp(TIMES, rows["time"], rows["surface_ux"]),
            np.stack([np.interp(TIMES, time, ru[:, k]) for k in at], axis=1))


def centrifuge():
    """{depth: least and largest r_u of test CU1 in one cycle}, m."""
    return {row["depth (m)"]: [row[name] / (BUOYANT * row["depth (m)"])
                               for name in ("least excess pressure (kPa)", "largest (kPa)")]
            for row in read_csv(drained.LABORATORY / "leap_cu1.csv")}


def slope_rows(store, planned):
    for run, folder in done(store, planned, "column"):
        if run.case[0] == "box":
            continue
        _, ru = slope_of(folder)
        yield {"packings": PACKINGS[run.case[0]], "lot": run.case[1], "downslope (m)": parsed(folder)["downslope"],
               **{f"largest r_u at {z:g} m": float(ru[:, k].max()) for k, z in enumerate(DEPTHS)}}


def box_rows(store, planned):
    for run, folder in done(store, planned, "column"):
        if run.case[0] == "box":
            motion = parsed(folder)["surface_motion"]
            yield {"box": run.case[1], "mid-slope along x (m)": motion["along_x"],
                   "settlement (m)": motion["settlement"], "heave (m)": motion["heave"]}


def draw_drained(rows, path):
    """Peak friction and the strain there, of packings over those of the laboratory. Hollow: opened packings."""
    figure, (axes,) = panels(1, 2)
    compression, extension = "compression", "extension"
    kinds = (("o", BLUE, "compression, 100 to 300 kPa, of the fit",
              lambda row: row["direction"] == compression and row["sigma_3 (kPa)"] <= 300),
             ("s", ORANGE, "500 to 700 kPa",
              lambda row: row["direction"] == compression and row["sigma_3 (kPa)"] > 300),
             ("^", GREEN, extension, lambda row: row["direction"] == extension))
    for (marker, colour, label, belongs), made in itertools.product(kinds, PACKINGS.values()):
        part = [row for row in rows if row["packings"] == made and belongs(row)]
        for axis, laboratory, packings in ((axes[0], "laboratory (deg)", "packings (deg)"),
                                           (axes[1], "strain at the peak, laboratory (%)", "packings (%)")):
            axis.plot([row[laboratory] for row in part], [row[packings] for row in part], marker, color=colour,
                      markersize=4, label=label if made == "compacted" else None,
                      markerfacecolor=None if made == "compacted" else "none")
    for axis, name in zip(axes, ("peak friction (deg)", "axial strain at the peak (%)")):
        ends = [min(axis.get_xlim()[0], axis.get_ylim()[0]), max(axis.get_xlim()[1], axis.get_ylim()[1])]
        axis.plot(ends, ends, color=GREY, linewidth=0.8, zorder=0)
        axis.set(xlabel=f"laboratory: {name}", ylabel=f"packings: {name}")
    legend_below(figure, axes[0], 0.08, 3)
    save(figure, path)


def draw_slopes(members, box, path):
    """Displacement of the surface, and r_u at the depths: {packings: members}, thin, and their medians."""
    figure, axes = plt.subplots(1, 3, figsize=(7.2, 2.9), layout="constrained")
    for letter, axis in zip("abc", axes):
        axis.set_title(f"({letter})", loc="left", fontweight="bold", fontsize=9)
        axis.set_xlabel("time (s)")
    for (name, runs), colour in zip(members.items(), (BLUE, GREEN)):
        curves = [np.column_stack([1e3 * moved, ru[:, 0], ru[:, 3]]) for moved, ru in runs]
        for axis, of_axis in zip(axes, np.transpose(curves, (2, 0, 1))):
            for curve in of_axis:
                axis.plot(TIMES, curve, color=colour, linewidth=0.5, alpha=0.4)
            axis.plot(TIMES, np.median(of_axis, axis=0), color=colour, label=f"{name} packings, median of {len(runs)}")
    if box is not None:
        axes[0].plot(box["time"], 1e3 * box["surface_ux"], color=ORANGE, label="box of Iwan sand")
    axes[0].set_yscale("symlog", linthresh=10)
    axes[0].set_ylabel("surface downslope (mm)")
    for k, axis, depth in ((0, axes[1], 1), (3, axes[2], 4)):
        low, high = centrifuge()[depth]
        axis.errorbar([13.7], [(low + high) / 2], [(high - low) / 2], fmt="k*", markersize=7, capsize=2, linewidth=0.8,
                      label=f"centrifuge CU1, {depth} m")
        axis.legend(handles=axis.containers, loc="upper right")
        axis.set(ylabel=f"$r_u$ at {DEPTHS[k]:g} m", ylim=(-0.05, 1.7))
    legend_below(figure, axes[0], 0.11, 3)
    save(figure, path)


def report(store, planned, folder):
    grid, checked = strengths(store, planned)
    tables = {"fit": list(fit_rows(grid)), "drained": list(check_rows(checked)),
              "moduli": list(modulus_rows(store, planned)), "cyclic": list(cyclic_rows(store, planned)),
              "slopes": list(slope_rows(store, planned)),
              "box": list(box_rows(store, planned))}
    for name, rows in tables.items():
        if rows:
            write_csv(folder / f"{name}.csv", rows, 4)
    if tables["drained"]:
        draw_drained(tables["drained"], folder / "drained.png")
    columns = {run.case: path for run, path in done(store, planned, "column")}
    members = {name: [slope_of(path) for case, path in columns.items() if case[0] == kind]
               for kind, name in PACKINGS.items()}
    members = {name: runs for name, runs in members.items() if runs}
    if members:
        box = read_table(columns["box", "iwan"] / "history.csv") if ("box", "iwan") in columns else None
        draw_slopes(members, box, folder / "slope.png")

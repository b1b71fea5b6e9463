# SPDX-License-Identifier: BSD-3-Clause
"""Draws the bands of an ensemble of soil columns from what `isostat ensemble` left.

    python3 -m figures column_ensemble RESULTS

A band holds 16 to 84 % of the members at each depth, period or time for itself; no single member need follow it. Of
less than three members there is none. Members with the packings of an earlier one are left out.
"""
import csv

import numpy as np

from .column_results import broken
from .common import BLACK, BLUE, GREY, ORANGE, BadInput, legend_below, letters, plt, read_history
from .drawing import Drawing, draws
from .files import read_parsed

LABELS = {"max_ru": "largest $r_u$", "max_gamma": "largest shear strain (%)",
          "max_acceleration": "largest acceleration (m/s$^2$)", "min_I_R": "smallest $I_R$",
          "final_I_R": "$I_R$ at the end", "settlement": "settlement (mm)", "surface_ax": "$a_x$ (m/s$^2$)",
          "surface_ay": "$a_y$ (m/s$^2$)", "surface_ux": "$u_x$ (m)"}
FACTORS = {"max_gamma": 100, "settlement": 1000}
NUMBERS = (("peak_surface", "peak surface\n(m/s$^2$)", 1), ("surface_Sa_0.3s", "$S_a$(0.3 s)\n(m/s$^2$)", 1),
           ("arias_intensity", "Arias intensity\n(m/s)", 1), ("liquefied_thickness", "liquefied\nthickness (m)", 1),
           ("settlement", "settlement\n(mm)", 1000), ("downslope", "moved\ndownslope (m)", 1),
           ("surface_along_x", "moved\nalong x (m)", 1), ("final_redundancy", "$I_R$\nat the end", 1))
MEMBER_FILES = {"points": ("max_ru", "max_gamma"), "nodes": ("max_acceleration",)}


class Ensemble:
    """`bands`: tables by kind, each with its abscissa first; `members`: numbers by name, one for each member."""

    def __init__(self, folder):
        self.numbers = read_parsed(folder / "ensemble.json")
        self.title = self.numbers.get("title")
        self.bands = {path.stem.removeprefix("bands_"): read_history(path)
                      for path in sorted(folder.glob("bands_*.csv"))}
        if "points" not in self.bands or "history" not in self.bands:
            raise BadInput(f"{folder}: no bands_points.csv and bands_history.csv; run the ensemble again")
        with open(folder / "members.csv", newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if not row.get("same_as")]
        self.names = [row["member"] for row in rows]
        self.members = {name.split(" (")[0]: np.array([float(row[name]) for row in rows])
                        for name in (rows[0] if rows else {})
                        if name not in ("member", "packings", "record", "same_as")}
        self.has_records = any(row["record"] for row in rows)
        self.folders = [folder / "members" / name for name in self.names]
        self.boundaries = [depth for path in self.folders[:1] for depth in boundaries_of(path)]

    def curve(self, kind, name):
        """Abscissa and the table {mean, p16, p50, p84} of a curve, in the units of its label; None: there is none."""
        table = self.bands.get(kind, {})
        if f"{name}_p50" not in table:
            return None
        factor = FACTORS.get(name, 1)
        return next(iter(table.values())), {key: factor * table[f"{name}_{key}"]
                                            for key in ("mean", "p16", "p50", "p84")}

    def each(self, kind, name):
        """(abscissa, values) of every member, in the same units."""
        factor = FACTORS.get(name, 1)
        for folder in self.folders:
            yield from ((x, factor * y) for x, y in member_curve(folder, kind, name))


def boundaries_of(folder):
    """Depths between the layers of a run, m; none if its summary is missing."""
    try:
        layers = read_parsed(folder / "summary.json").get("layers", [])
        return [layer["bottom"] for layer in layers[:-1] if layer["bottom"] is not None]
    except OSError:
        return []


def member_curve(folder, kind, name):
    """The curve of one member, or nothing where its file does not exist."""
    try:
        if kind in MEMBER_FILES:
            import h5py  # pylint: disable=import-outside-toplevel  (other figures do without)
            with h5py.File(folder / "profiles.h5") as file:
                yield (file["node_depth" if kind == "nodes" else "depth"][()], file[name.replace("max_", "peak_")][()])
        elif kind == "spectra":
            table = read_history(folder / "spectra.csv")
            axes = [table[key] for key in ("surface_x_SA", "surface_y_SA") if key in table]
            yield table["period"], np.max(axes, axis=0)
        elif kind == "history":
            table = read_history(folder / "history.csv")
            yield table["time"], table[name]
        elif kind == "grains":
            table = read_history(folder / "grain_profiles/history.csv")
            packings = [key.removesuffix("_IR") for key in table if key.endswith("_IR")]
            pick = {"min_I_R": np.nanmin, "final_I_R": lambda index: index[-1]}[name]
            yield (np.array([table[f"{p}_depth"][0] for p in packings]),
                   np.array([pick(table[f"{p}_IR"]) for p in packings]))
    except (OSError, KeyError, BadInput):
        return


def draw(axes, ensemble, kind, name, upright=False, alone=False):
    """Band, median and members; `upright`: the abscissa is the depth, downwards; `alone`: members without the rest."""
    x, band = ensemble.curve(kind, name)
    layers = ensemble.boundaries if upright and kind != "nodes" else []  # values of points jump between them
    band = {key: broken(layers, x, values)[1] for key, values in band.items()}
    x = broken(layers, x, x)[1]
    has_band = np.isfinite(band["p16"]).any()
    for k, (x_member, y) in enumerate(ensemble.each(kind, name)):
        x_member, y = broken(layers, x_member, y)
        axes.plot(*((y, x_member) if upright else (x_member, y)), color=GREY, linewidth=0.5, alpha=0.6,
                  label=None if k or alone else "member")
    if alone:
        return
    if has_band:
        (axes.fill_betweenx if upright else axes.fill_between)(x, band["p16"], band["p84"], color=BLUE, alpha=0.25,
                                                              linewidth=0, label="16 to 84 %")
    label = "median" if has_band else f"mean of {len(ensemble.names)}, no band"
    axes.plot(*((band["p50"], x) if upright else (x, band["p50"])), color=BLACK, label=label)


def over_depth(ensemble, panels):
    """A row of panels over the depth, or None if none of their curves is there."""
    panels = [(kind, name) for kind, name in panels if ensemble.curve(kind, name) is not None]
    if not panels:
        return None
    figure, rows = plt.subplots(1, len(panels), figsize=(2.6 * len(panels) + 0.6, 4.2), sharey=True, squeeze=False,
                                layout="constrained")
    letters(rows)
    for axes, (kind, name) in zip(rows[0], panels):
        draw(axes, ensemble, kind, name, upright=True)
        axes.set(xlabel=LABELS[name], xlim=(0, None))
        level = {"max_ru": ensemble.numbers["liquefied_ru"], "min_I_R": 1, "final_I_R": 1}.get(name)
        if level:
            axes.axvline(level, color=ORANGE, linewidth=0.8, linestyle="--")
            axes.set_title(f"dashed: {level:g}", loc="right", fontsize=8.5, pad=5)
    rows[0][0].set(ylabel="Depth (m)", ylim=(0, None))
    rows[0][0].invert_yaxis()
    rows[0][-1].legend(loc="best")
    return figure


@draws("fig_ensemble_profiles")
def profiles(ensemble):
    """Over the depth: largest r_u, shear strain and acceleration; black: median, shaded: 16 to 84 % of the members,
    grey: each member."""
    wet = np.any(ensemble.bands["points"]["max_ru_mean"] > 0)
    return over_depth(ensemble, ([("points", "max_ru")] if wet else [])
                      + [("points", "max_gamma"), ("nodes", "max_acceleration")])


@draws("fig_ensemble_redundancy")
def redundancy(ensemble):
    """Packings of grains: smallest and last redundancy index I_R over the depth, likewise."""
    return over_depth(ensemble, [("grains", "min_I_R"), ("grains", "final_I_R")])


@draws("fig_ensemble_spectra")
def spectra(ensemble):
    """Response spectra of the surface, likewise (of two axes the larger)."""
    if ensemble.curve("spectra", "surface_Sa") is None:
        return None
    figure, axes = plt.subplots(figsize=(5.2, 3.6), layout="constrained")
    draw(axes, ensemble, "spectra", "surface_Sa")
    axes.set(xscale="log", xlabel="Period (s)", ylabel="$S_a$ of the surface (m/s$^2$)", ylim=(0, None))
    axes.legend()
    return figure


@draws("fig_ensemble_histories")
def histories(ensemble):
    """Acceleration and settlement of the surface, and largest r_u anywhere, likewise; of slopes and boxes also its
    displacement along x."""
    return rows_in_time(ensemble, ("surface_ax", "surface_ay", "surface_ux", "max_ru", "settlement"))


@draws("fig_ensemble_ru")
def pore_pressure(ensemble):
    """r_u at each of the scene's depths, likewise."""
    depths = ensemble.numbers.get("depths") or []
    return rows_in_time(ensemble, [f"d{k}_ru" for k in range(len(depths))],
                        {f"d{k}_ru": f"$r_u$, {depth:.3g} m" for k, depth in enumerate(depths)})


def rows_in_time(ensemble, names, labels=None):
    labels = {**LABELS, **(labels or {})}
    names = [name for name in names if ensemble.curve("history", name) is not None]
    names = [name for name in names if np.abs(ensemble.curve("history", name)[1]["mean"]).max() > 1e-9]
    if not names:
        return None
    figure, rows = plt.subplots(len(names), 1, figsize=(7.2, 1.8 * len(names) + 0.5), sharex=True, squeeze=False,
                                layout="constrained")
    letters(rows)
    for axes, name in zip(rows[:, 0], names):
        # of different motions at one moment there is no median
        draw(axes, ensemble, "history", name, alone=ensemble.has_records and name.startswith("surface_a"))
        axes.set_ylabel(labels[name])
    with_bands = [axes for axes in rows[:, 0] if axes.get_legend_handles_labels()[0]]
    if with_bands:
        with_bands[0].legend(loc="upper left", ncols=2)
    rows[-1, 0].set_xlabel("Time (s)")
    return figure


@draws("fig_ensemble_numbers")
def numbers(ensemble):
    """Numbers of each member (points), their mean with its standard error (bar), and the band."""
    shown = [(name, label, factor) for name, label, factor in NUMBERS
             if name in ensemble.members and np.nan_to_num(ensemble.members[name]).any()]
    figure, row = plt.subplots(1, len(shown), figsize=(1.35 * len(shown) + 0.4, 3.4), squeeze=False,
                               layout="constrained")
    for axes, (name, label, factor) in zip(row[0], shown):
        values, table = factor * ensemble.members[name], ensemble.numbers["numbers"][name]
        if table["p16"] is not None:
            axes.axhspan(factor * table["p16"], factor * table["p84"], color=BLUE, alpha=0.25, linewidth=0,
                         label="16 to 84 %")
        axes.plot(np.zeros(len(values)), values, "o", color=GREY, markersize=4, markerfacecolor="none", label="member")
        axes.errorbar([0.25], [factor * table["mean"]], yerr=[factor * (table["standard_error"] or 0)], fmt="s",
                      color=BLACK, markersize=4, capsize=3, label="mean, standard error")
        axes.set_xlim(-0.3, 0.5)
        axes.set_xticks([])
        axes.set_title(label, fontsize=8.5)
        if values.min() >= 0:
            axes.set_ylim(0, 1.08 * max(axes.get_ylim()[1], values.max()))
    legend_below(figure, row[0][0], 0.09)
    return figure


DRAWING = Drawing(Ensemble, [profiles, redundancy, spectra, histories, pore_pressure, numbers])

# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of a micromechanical analysis from the tables that `micromechanics` wrote.

    python3 -m figures micromechanics RESULTS

Onset is the first snapshot with p'/p0' < 0.01; without one, that of the smallest p' stands in for it,
if it is neither the first nor the last.
"""
import numpy as np
from matplotlib.ticker import MaxNLocator

from .common import BLACK, BLUE, GREEN, GREY, ORANGE, RED, legend_below, letters, plain, plt, read_history
from .drawing import Drawing, draws
from .files import read_parsed

COLOURS = {"first": BLUE, "onset": RED, "smallest p'": RED, "last": ORANGE}


class Analysis:
    """The tables of a folder, and which snapshots stand for first, onset and last."""

    title = None

    def __init__(self, folder):
        self.rows = read_history(folder / "micromechanics.csv")
        self.forces = read_history(folder / "force_distribution.csv")
        self.roses = read_history(folder / "roses.csv")
        onset = read_parsed(folder / "micromechanics.json")["onset"]
        self.is_axial = np.ptp(self.rows["eps_y"]) > 1e-9  # simple shear has no axial strain
        last = len(self.rows["p"]) - 1
        self.chosen = {"first": 0}
        if last > 0:
            smallest = int(np.argmin(self.rows["p"]))
            if onset is None and 0 < smallest < last:
                self.chosen["smallest p'"] = smallest
            elif onset is not None:
                self.chosen["onset"] = onset
            self.chosen["last"] = last

    def label(self, name):
        k = self.chosen[name]
        strain = f"$\\varepsilon_1$ = {100 * self.rows['eps_y'][k]:.3f} %, " if self.is_axial else ""
        return f"{name}: {strain}p' = {self.rows['p'][k] / 1e3:.3g} kPa"


@draws("fig_force_distribution")
def force_distribution(analysis):
    """Probability density of fn/<fn> and |fs|/<fn>, first, onset and last snapshot."""
    figure, panels = plt.subplots(1, 2, figsize=(7.2, 3.3), layout="constrained", sharey=True)
    for name, index in analysis.chosen.items():
        of_snapshot = analysis.forces["snapshot"] == index
        middle = 0.5 * (analysis.forces["force_low"] + analysis.forces["force_high"])[of_snapshot]
        for axes, kind in zip(panels, ("normal", "tangential")):
            density = analysis.forces[f"{kind}_density"][of_snapshot]
            seen = density > 0
            axes.plot(middle[seen], density[seen], "o-", markersize=2.5, linewidth=0.8, color=COLOURS[name],
                      label=analysis.label(name))
    letters(panels)
    for axes, text in zip(panels, (r"$f_n/\langle f_n\rangle$", r"$|f_s|/\langle f_n\rangle$")):
        axes.set(yscale="log", xlabel=text, xlim=(0, None))
    panels[0].set_ylabel("Probability density")
    legend_below(figure, panels[0], 0.18, 1)
    return figure


@draws("fig_roses")
def roses(analysis):
    """Contact normals in the x-y plane and about y: number (bars) and mean force (line)."""
    n = len(analysis.chosen)
    figure, panels = plt.subplots(2, n, figsize=(2.5 * n + 0.4, 5.6), subplot_kw={"projection": "polar"},
                                  layout="constrained", squeeze=False)
    for column, (name, index) in enumerate(analysis.chosen.items()):
        of_snapshot = analysis.roses["snapshot"] == index
        low = np.radians(analysis.roses["angle_low"][of_snapshot])
        width = np.radians(analysis.roses["angle_high"][of_snapshot]) - low
        for row, (plane, second) in enumerate((("xy", "y"), ("xz", "z"))):
            axes = panels[row, column]
            density = analysis.roses[f"{plane}_density"][of_snapshot]
            force = analysis.roses[f"{plane}_force"][of_snapshot]
            axes.bar(low + width / 2, density, width=width, color=COLOURS[name], alpha=0.45, edgecolor="white",
                     linewidth=0.3, label="number of contacts")
            closed = np.append(low + width / 2, low[0] + width[0] / 2)
            axes.plot(closed, np.append(force, force[0]), color=BLACK, linewidth=0.9, label="mean normal force")
            axes.plot(np.linspace(0, 2 * np.pi, 181), np.ones(181), color=GREY, linewidth=0.7, linestyle="--",
                      label="isotropic")
            axes.set_xticks(np.radians([0, 90, 180, 270]), ["x", second, "", ""])
            axes.set_yticks([1, 2], ["1", "2"])
            axes.set_ylim(0, max(1.6, min(3.5, 1.05 * max(density.max(), force.max()))))
            axes.tick_params(labelsize=7, pad=0)
            if row == 0:
                axes.set_title(plain(name) + "\n" + analysis.label(name).split(": ")[1].replace(", ", "\n"), fontsize=8)
    legend_below(figure, panels[0, 0], 0.06)
    return figure


@draws("fig_anisotropies")
def anisotropies(analysis):
    """a_c, a_n, a_t along y, and the fabric of strong and weak contacts, against axial strain (simple shear: p')."""
    # left against strain; right against the number of the snapshot, which sets cycles before liquefaction apart
    rows = analysis.rows
    if len(rows["p"]) < 2:
        return None
    figure, panels = plt.subplots(2, 2, figsize=(9.0, 5.2), sharex="col", sharey="row", layout="constrained")
    of_forces = [("$a_c$ contacts", rows["a_c"], BLUE), ("$a_n$ normal forces", rows["a_n"], ORANGE),
                 ("$a_t$ tangential forces", rows["a_t"], GREEN)]
    of_fabric = [(label, rows[f"{name}yy"] - 0.5 * (rows[f"{name}xx"] + rows[f"{name}zz"]), colour)
                 for label, name, colour in (("all contacts", "F", BLUE), ("strong", "F_strong_", ORANGE),
                                             ("weak", "F_weak_", GREEN))]
    left = 100 * rows["eps_y"] if analysis.is_axial else rows["p"] / 1e3
    for column, x in enumerate((left, np.arange(len(rows["p"])))):
        for row, curves in enumerate((of_forces, of_fabric)):
            axes = panels[row, column]
            for label, y, colour in curves:
                axes.plot(x, y, color=colour, label=label, marker="o", markersize=2.5, linewidth=0.5)
            axes.axhline(0, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
            for name, index in analysis.chosen.items():
                if name not in ("first", "last"):
                    axes.axvline(x[index], color=COLOURS[name], linewidth=0.8, linestyle=":", label=name)
    letters(panels)
    panels[0, 0].set_ylabel("Anisotropy along y")
    panels[1, 0].set(ylabel=r"$F_{yy} - (F_{xx}+F_{zz})/2$",
                     xlabel=r"Axial strain $\varepsilon_1$ (%)" if analysis.is_axial else "p' (kPa)")
    panels[1, 1].set_xlabel("Snapshot")
    panels[1, 1].xaxis.set_major_locator(MaxNLocator(integer=True))
    for row in (0, 1):
        handles, labels = panels[row, 0].get_legend_handles_labels()
        panels[row, 1].legend(handles, labels, loc="center left", bbox_to_anchor=(1.02, 0.5), handlelength=1.2,
                              fontsize=7.5)
    return figure


DRAWING = Drawing(Analysis, [force_distribution, roses, anisotropies])

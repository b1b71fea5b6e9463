# SPDX-License-Identifier: BSD-3-Clause
"""Draws the liquefaction resistance that `isostat resistance` found.

    python3 -m figures resistance RESULTS
"""
import csv

import numpy as np
from matplotlib.transforms import ScaledTranslation

from .common import BLACK, BLUE, GREY, ORANGE, RED, BadInput, plt
from .drawing import Drawing
from .files import read_parsed

CAPTIONS = {
    "resistance": "cyclic stress ratio against cycles to initial liquefaction: every realisation, arrows for those "
                  "that did not liquefy, mean over realisations, fit CSR = a N^-b with the CSR at 15 cycles",
}

MIN_CYCLES = 0.25  # liquefaction before the first reversal
REFERENCE = 15  # cycles that stand for an earthquake of magnitude 7.5
RATIO_NAMES = {"simple shear": r"$\tau_{amp}/\sigma_{v0}^\prime$", "triaxial": r"$q_{amp}/(2\,p_0^\prime)$"}


def read_runs(path):
    """(CSR, cycles to liquefaction or None, cycles applied, status) of every run."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = [{name.split(" (")[0]: cell for name, cell in row.items()} for row in csv.DictReader(file)]
    return [(float(row["CSR"]), float(row["N_liquefaction"]) if row["N_liquefaction"] else None,
             float(row["N_applied"]), row["status"]) for row in rows]


def shift(axes, points):
    """Upwards on the page."""
    return ScaledTranslation(0, points / 72, axes.figure.dpi_scale_trans)


def draw_runs(axes, runs):
    """Dots, arrows for what did not liquefy; those that agree are one above the other."""
    labels = {"liquefied": "realisation", "censored": "not liquefied", "strain": "strain limit before liquefaction"}
    drawn = [(ratio, n or max(applied, MIN_CYCLES), status) for ratio, n, applied, status in runs if status in labels]
    for ratio, n, status in sorted(set(drawn)):
        times = drawn.count((ratio, n, status))
        for k in range(times):
            place = axes.transData + shift(axes, 5.5 * (k - (times - 1) / 2))
            colour = BLUE if status == "liquefied" else ORANGE
            axes.plot(n, ratio, "x" if status == "strain" else "o", color=colour, markersize=5, markerfacecolor="none",
                      markeredgewidth=1.1, zorder=3, transform=place, label=labels[status])
            labels[status] = None
            if status == "censored":
                axes.plot(n, ratio, marker=r"$\rightarrow$", color=colour, markersize=11, markeredgewidth=0, zorder=3,
                          transform=place + ScaledTranslation(9 / 72, 0, axes.figure.dpi_scale_trans))


def draw_means(axes, runs):
    """Geometric means of the ratios at which every realisation liquefied."""
    means = []
    for ratio in sorted({run[0] for run in runs}):
        cycles = [n for r, n, _, status in runs if r == ratio and status != "missing" and status != "failed"]
        if cycles and all(cycles):
            means.append((np.exp(np.mean(np.log(cycles))), ratio))
    if means:
        axes.plot(*zip(*means), "-D", color=BLACK, linewidth=1.0, markersize=4, zorder=4, label="mean of realisations")


def draw_fit(axes, fit, low, high):
    n = np.geomspace(low, high, 200)
    text = rf"$CSR = {fit['a']:.3f}\,N^{{-{fit['b']:.3f}}}$"
    if fit["b_error"] is None:
        text += "  (of two runs: no error)"
    else:
        text += rf"  ($b \pm {fit['b_error']:.3f}$, $R^2 = {fit['R2']:.2f}$)"
    axes.plot(n, fit["a"] * n ** -fit["b"], color=RED, linewidth=1.2, linestyle=(0, (5, 2)), zorder=2, label=text)
    axes.axvline(REFERENCE, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
    axes.plot(REFERENCE, fit["CSR_15"], "s", color=RED, markersize=5.5, zorder=5,
              label=f"CSR at {REFERENCE} cycles: {fit['CSR_15']:.3f}")


def resistance(campaign):
    runs, summary = campaign.runs, campaign.summary
    figure, axes = plt.subplots(figsize=(6.2, 4.2), layout="constrained")
    axes.set_xscale("log")
    cycles = [n or max(applied, MIN_CYCLES) for _, n, applied, status in runs if status not in ("missing", "failed")]
    low, high = 0.7 * min(cycles + [REFERENCE]), 1.6 * max(cycles + [REFERENCE])
    axes.set_xlim(low, high)
    axes.set_ylim(0, 1.2 * max(run[0] for run in runs))
    draw_runs(axes, runs)
    draw_means(axes, runs)
    if summary["fit"]:
        draw_fit(axes, summary["fit"], low, high)
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.set_xlabel(rf"Cycles to initial liquefaction $N$ ($p^\prime/p_0^\prime < {summary['liquefaction_ratio']:g}$)")
    axes.set_ylabel(f"Cyclic stress ratio {RATIO_NAMES[summary['test']]}")
    axes.legend(loc="upper right")
    return figure


class Campaign:
    """What `isostat resistance` left in a folder."""

    def __init__(self, folder):
        self.runs = read_runs(folder / "resistance.csv")
        self.summary = read_parsed(folder / "resistance.json")
        self.title = self.summary["title"]
        if all(status in ("missing", "failed") for _, _, _, status in self.runs):
            raise BadInput("no run has ended; nothing to draw")


DRAWING = Drawing(Campaign, {"resistance": resistance}, CAPTIONS)

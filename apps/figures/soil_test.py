# SPDX-License-Identifier: BSD-3-Clause
"""Draws the element tests that `isostat soil-test` made.

    python3 -m figures soil_test RESULTS
"""
import numpy as np

from .common import BLACK, BLUE, GREY, ORANGE, RED, letters, mark_level, plain_log_ticks, plt, read_history
from .drawing import Drawing, draws
from .files import read_parsed

REFERENCE = 15  # cycles that stand for an earthquake of magnitude 7.5


def draw_modulus(axes, modulus):
    axes.semilogx(100 * modulus["gamma"], modulus["G_ratio"], "-o", color=BLUE, markersize=3, label=r"$G/G_{max}$")
    axes.semilogx(100 * modulus["gamma"], modulus["damping"], "-s", color=ORANGE, markersize=3, label="damping ratio")
    axes.set(xlabel=r"Shear strain $\gamma$ (%)", ylabel=r"$G/G_{max}$, damping ratio", ylim=(0, 1.05))
    axes.legend()


def draw_resistance(axes, resistance, summary):
    n, ratio = resistance["N_liquefaction"], resistance["CSR"]
    axes.semilogx(n, ratio, "-o", color=BLUE, markersize=4, label="test")
    if summary["CRR_15"]:
        axes.plot(REFERENCE, summary["CRR_15"], "s", color=RED, markersize=5.5,
                  label=f"CRR = {summary['CRR_15']:.3f} at {REFERENCE} cycles")
    if summary["CRR_of_scene"]:
        mark_level(axes, summary["CRR_of_scene"], "scene")
    plain_log_ticks(axes.xaxis)
    axes.set(xlabel=r"Cycles to $r_u = 0.95$ or $|\gamma| = 3$ %", ylabel=r"$\tau_{amp}/\sigma_{v0}^\prime$")
    if len(ratio):
        axes.set_ylim(0, 1.3 * max(ratio))
        axes.legend()
    if not np.isfinite(n).any():
        axes.text(0.5, 0.5, "does not liquefy", transform=axes.transAxes, ha="center", va="center")
        axes.set_axis_off()


def draw_path(axes, path, summary):
    vertical = summary["sigma_v0"]
    axes.plot(path["sigma_v"] / vertical, path["tau"] / vertical, color=BLUE, linewidth=0.7)
    axes.set(xlabel=r"$\sigma_v^\prime/\sigma_{v0}^\prime$", ylabel=r"$\tau/\sigma_{v0}^\prime$")
    axes.axhline(0, color=BLACK, linewidth=0.6)


def draw_loops(axes, path, summary):
    axes.plot(100 * path["gamma"], path["tau"] / summary["sigma_v0"], color=BLUE, linewidth=0.7)
    axes.axvline(0, color=GREY, linewidth=0.6)
    axes.set(xlabel=r"Shear strain $\gamma$ (%)", ylabel=r"$\tau/\sigma_{v0}^\prime$")


@draws("soil_test")
def soil_test(test):
    """Element tests on one point of the soil: (a) secant modulus and damping of the last of three drained cycles; (b)
    cycles to liquefaction in undrained simple shear, with the CRR of 15 cycles; (c) stress path and (d) loops at that
    CRR."""
    figure, panels = plt.subplots(2, 2, figsize=(7.4, 6), layout="constrained")
    letters(panels)
    draw_modulus(panels[0, 0], test.modulus)
    draw_resistance(panels[0, 1], test.resistance, test.summary)
    draw_path(panels[1, 0], test.path, test.summary)
    draw_loops(panels[1, 1], test.path, test.summary)
    return figure


class Test:
    """What `isostat soil-test` left in a folder."""

    def __init__(self, folder):
        self.summary = read_parsed(folder / "soil_test.json")
        self.title = self.summary["title"]
        self.modulus, self.path = (read_history(folder / f"{name}.csv") for name in ("modulus", "path"))
        self.resistance = ({"CSR": np.array([]), "N_liquefaction": np.array([])} if self.summary["CRR_15"] is None
                           else read_history(folder / "resistance.csv"))


DRAWING = Drawing(Test, [soil_test])

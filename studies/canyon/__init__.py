# SPDX-License-Identifier: BSD-3-Clause
"""A semi-circular canyon under SH waves that come up vertically: amplification of its surface and the exact solution.

The scene is apps/scenes/column/canyon.toml.   tested: tests/studies/canyon_test.py
"""
import numpy as np
from scipy.special import h2vp, hankel2, jvp

from figures.column_box import amplification
from figures.column_results import Column
from figures.common import BLUE, GREY, ORANGE, plt
from studies.columns import SCENES, Run
from studies.drawing import save
from studies.tables import write_tables

DEFAULTS, QUICK = {}, {}
RADIUS, VELOCITY = 100.0, 400.0  # of the scene, m, m/s
ETA = (0.5, 1.0)  # diameter over wave length
FAR = 3  # radii within which errors are taken


def runs(_options):
    return [Run(("canyon",), SCENES / "column/canyon.toml", seconds=10)]


def trifunac(x, eta, terms=30):
    """|w| of the surface over that of level ground (2 times the incident wave) at x radii from the middle of the
    canyon: the series of Trifunac (1973), doi:10.1002/eqe.4290010307, for vertical incidence. cos(k z) is the sum of
    e_n J_2n(k r) cos(2 n phi), and waves that leave take dw/dr off the surface of the canyon."""
    k = np.pi * eta  # of unit radius
    r, phi = np.maximum(np.abs(x), 1), np.arccos(np.clip(x, -1, 1))
    scattered = sum((2 if n else 1) * np.cos(2 * n * phi) * jvp(2 * n, k) / h2vp(2 * n, k) * hankel2(2 * n, k * r)
                    for n in range(terms))
    return np.abs(np.cos(k * np.sin(phi)) - scattered)


def compared(column):
    """x in radii, and for each ETA what was found and what is exact, in units of the incident wave."""
    x, ratios = amplification(column, "y", np.multiply(ETA, VELOCITY / (2 * RADIUS)))
    x = (x - x[-1] / 2) / RADIUS
    near = np.abs(x) <= FAR
    return x[near], [(2 * ratio[near], 2 * trifunac(x[near], eta)) for eta, ratio in zip(ETA, ratios)]


def report(store, planned, folder):
    for run in filter(store.is_done, planned):
        x, pairs = compared(Column(store.folder(run)))
        write_tables(folder, {"canyon": (
            ["eta", "largest exact amplification", "largest error", "root mean square"],
            [[eta, exact.max(), np.abs(found - exact).max(), np.sqrt(np.mean((found - exact) ** 2))]
             for eta, (found, exact) in zip(ETA, pairs)])})
        figure, axes = plt.subplots(figsize=(7.2, 2.8), layout="constrained")
        for eta, (found, _), colour in zip(ETA, pairs, (ORANGE, BLUE)):
            fine = np.linspace(-FAR, FAR, 601)
            axes.plot(fine, 2 * trifunac(fine, eta), color=GREY, linewidth=0.8)
            axes.plot(x, found, "o", color=colour, markersize=3, label=rf"$\eta$ = {eta:g}")
        axes.set(xlabel="x/a", ylabel="|w| over the incident wave", xlim=(-FAR, FAR), ylim=(0, None))
        axes.legend(title="lines: Trifunac (1973)", ncols=2)
        save(figure, folder / "canyon.png", dpi=110)

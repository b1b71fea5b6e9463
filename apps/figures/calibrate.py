# SPDX-License-Identifier: BSD-3-Clause
"""Draws what `isostat calibrate` found.

    python3 -m figures calibrate RESULTS
"""
import csv

import numpy as np
from matplotlib.ticker import MaxNLocator

from .common import BLACK, BLUE, GREY, ORANGE, RED, BadInput, legend_below, number, plain, plain_log_ticks, plt
from .drawing import Drawing, draws
from .files import read_parsed

COLUMNS = 4  # curves side by side
SHOWN = 3.0  # misfits beyond this many times the best have one colour


class Curve:
    """The rows of one curve in curves.csv; what failed is nan."""

    def __init__(self, name, rows):
        self.name, self.blind, self.second = name, rows[0]["blind (-)"] == "1", rows[0]["second"]
        column = {key: np.array([number(row[key]) for row in rows]) for key in rows[0]
                  if key not in ("curve", "second")}
        self.strain = 100 * column["eps_1 (-)"]
        self.q = {who: column[f"q {who} (Pa)"] / 1e3 for who in ("laboratory", "start", "best", "best s.d.")}
        scale = 100 if self.drained else 1e-3
        self.other = {who: scale * column[f"second {who}"] for who in ("laboratory", "start", "best", "best s.d.")}

    @property
    def drained(self):
        return self.second.startswith("eps_v")


class Calibration:
    """What calibrate left in a folder."""

    def __init__(self, folder):
        self.summary = read_parsed(folder / "calibrate.json")
        self.title = self.summary["title"]
        with open(folder / "curves.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        names = list(dict.fromkeys(row["curve"] for row in rows))
        self.curves = [Curve(name, [row for row in rows if row["curve"] == name]) for name in names]
        with open(folder / "trials.csv", newline="", encoding="utf-8") as file:
            trials = list(csv.DictReader(file))
        if not trials:
            raise BadInput("trials.csv: no trial has ended; nothing to draw")
        self.trial = np.array([int(row["trial (-)"]) for row in trials])
        self.misfit = np.array([float(row["misfit (-)"]) for row in trials])
        self.failed = np.array([bool(row["failed curves"]) for row in trials])
        self.parameters = self.summary["parameters"]
        self.values = {p["label"]: np.array([float(row[p["label"]]) for row in trials]) for p in self.parameters}
        self.best = int(np.flatnonzero(self.trial == self.summary["best"])[0])


def draw_band(axes, x, values):
    axes.fill_between(x, values["best"] - values["best s.d."], values["best"] + values["best s.d."], color=BLUE,
                      alpha=0.2, linewidth=0, label="best, s.d. over seeds")


def draw_curve(upper, lower, curve):
    """q over strain above; below what else was compared."""
    styles = {"laboratory": {"color": BLACK, "marker": "o", "markersize": 2.5, "linestyle": "none"},
              "start": {"color": GREY, "linestyle": (0, (4, 2))}, "best": {"color": BLUE, "linewidth": 1.4}}
    for who, style in styles.items():
        upper.plot(curve.strain, curve.q[who], label=who, **style)
        if curve.drained:
            lower.plot(curve.strain, curve.other[who], **style)
        else:
            lower.plot(curve.other[who], curve.q[who], **style)
    draw_band(upper, curve.strain, curve.q)
    if curve.drained:
        draw_band(lower, curve.strain, curve.other)
    upper.set_title(plain(curve.name) + (" (blind)" if curve.blind else ""), fontsize=8.5,
                    color=RED if curve.blind else BLACK)
    upper.set_xlabel(r"$\varepsilon_1$ (%)")
    lower.set_xlabel(r"$\varepsilon_1$ (%)" if curve.drained else r"$p^\prime$ (kPa)")


@draws("curves")
def curves(results):
    """Each laboratory curve with the model's at the start and at the best set: q and volumetric strain over axial
    strain, of undrained tests the stress path; band: standard deviation over the seeds."""
    n = len(results.curves)
    if n == 0:
        return None
    columns, blocks = min(n, COLUMNS), -(-n // COLUMNS)
    size = (max(5.2, 1.2 + 2.3 * columns), 4.2 * blocks)
    figure, panels = plt.subplots(2 * blocks, columns, figsize=size, squeeze=False,
                                  layout="constrained")
    for k in range(columns * blocks):
        upper, lower = (panels[2 * (k // columns) + row][k % columns] for row in (0, 1))
        if k >= n:
            upper.set_axis_off()
            lower.set_axis_off()
            continue
        draw_curve(upper, lower, results.curves[k])
        if k % columns == 0:
            upper.set_ylabel(r"$q$ (kPa)")
            lower.set_ylabel(r"$\varepsilon_v$ (%)" if results.curves[k].drained else r"$q$ (kPa)")
    legend_below(figure, panels[0][0], 0.07 / blocks)
    return figure


@draws("convergence")
def convergence(results):
    """Misfit of each trial, and the best so far."""
    figure, axes = plt.subplots(figsize=(6.2, 3.4), layout="constrained")
    good = ~results.failed
    axes.plot(results.trial[good], results.misfit[good], "o", color=BLUE, markersize=4, markerfacecolor="none",
              label="trial")
    if results.failed.any():
        axes.plot(results.trial[results.failed], results.misfit[results.failed], "x", color=ORANGE, markersize=5,
                  label="trial with a run that failed")
    if good.any():
        axes.step(results.trial[good], np.minimum.accumulate(results.misfit[good]), where="post", color=RED,
                  label="best so far")
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_yscale("log")
    plain_log_ticks(axes.yaxis)
    axes.set(xlabel="Trial", ylabel="Misfit (-)")
    axes.legend(loc="upper right")
    return figure


def scale_of(axis, parameter):
    low, high = float(parameter["low"]), float(parameter["high"])
    if parameter["log"]:
        axis("log")
    return low, high


def short(label):
    """"specimen.preparation_friction of dense (deg)" as it fits a panel."""
    return label.partition(".")[2].replace(".", " ").replace("_", " ").replace(" of ", "\nof ")


@draws("tradeoffs")
def tradeoffs(results):
    """Misfit over each parameter, and as colour over each pair of them."""
    # below the diagonal pairs, on it each parameter against the misfit
    labels, n = list(results.values), len(results.parameters)
    figure, panels = plt.subplots(n, n, figsize=(1.6 + 2.2 * n, 1.2 + 2.0 * n), squeeze=False, layout="constrained")
    lowest = results.misfit[results.best]
    order = np.argsort(-results.misfit)  # the best on top
    colours = None
    for i in range(n):
        for j in range(n):
            axes = panels[i][j]
            if j > i:
                axes.set_axis_off()
                continue
            axes.set_xlim(*scale_of(axes.set_xscale, results.parameters[j]))
            x, y = results.values[labels[j]], results.misfit if i == j else results.values[labels[i]]
            colours = axes.scatter(x[order], y[order], c=results.misfit[order], cmap="viridis_r", s=22, vmin=lowest,
                                   vmax=SHOWN * lowest, edgecolors=GREY, linewidths=0.3, zorder=3, clip_on=False)
            axes.plot(x[results.best], y[results.best], "*", color=RED, markersize=11, markeredgecolor=BLACK, zorder=4,
                      clip_on=False)
            if i == j:
                axes.set_yscale("log")
                plain_log_ticks(axes.yaxis)
            else:
                axes.set_ylim(*scale_of(axes.set_yscale, results.parameters[i]))
            axes.set_ylabel("Misfit (-)" if i == j else short(labels[i]) if j == 0 else "", fontsize=8)
            axes.set_xlabel(short(labels[j]) if i == n - 1 else "", fontsize=8)
    figure.colorbar(colours, ax=panels[:, -1], label="Misfit (-); star: best", extend="max", shrink=min(0.8, 2 / n),
                    aspect=25)
    return figure


DRAWING = Drawing(Calibration, [curves, convergence, tradeoffs])

# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of a run of rve_replay from its history.csv and grain_history.

    python3 -m figures rve_replay RESULTS
"""
import numpy as np

from .common import BLACK, BLUE, ORANGE, RED, index_label, letters, plt, read_history, read_summary
from .drawing import Drawing, draws

class Replay:
    def __init__(self, folder):
        self.rows = read_history(folder / "history.csv")
        self.grains = read_history(folder / "grain_history/history.csv")
        summary = read_summary(folder / "summary.json")
        same = summary["equal"] == summary["increments"]
        self.title = f"Packing at {summary['depth']:.4g} m, alone" + (
            ": the stress of the column bit for bit" if same else
            f": {100 * summary['shear_error']:.2g} % off in shear stress, "
            f"{100 * summary['pressure_error']:.2g} % in p'")


def both(axes, run, x, y):
    """The column in grey below, the packing alone in blue."""
    for suffix, colour, width, label in (("_column", ORANGE, 2.2, "in the column"), ("", BLUE, 0.7, "alone")):
        values = [run.rows.get(name + suffix, run.rows[name]) for name in (x, y)]
        scale = [1e-3 if name in ("p", "tau") else 100 if name == "gamma" else 1 for name in (x, y)]
        axes.plot(scale[0] * values[0], scale[1] * values[1], color=colour, linewidth=width, label=label)


@draws("fig_path")
def path(run):
    """Stress path, stress against strain and effective pressure over time, in the column and alone."""
    figure, axes = plt.subplots(1, 3, figsize=(10.0, 3.1), constrained_layout=True)
    labels = {"p": "Effective pressure $p'$ (kPa)", "tau": r"Shear stress $\tau_{xz}$ (kPa)",
              "gamma": r"Shear strain $\gamma_{xz}$ (%)", "time": "Time (s)"}
    letters(axes)
    for panel, (x, y) in zip(axes, (("p", "tau"), ("gamma", "tau"), ("time", "p"))):
        both(panel, run, x, y)
        panel.set(xlabel=labels[x], ylabel=labels[y])
    axes[0].set_xlim(left=0)
    axes[2].set_ylim(bottom=0)
    axes[2].legend()
    return figure


@draws("fig_grains")
def grains(run):
    """Redundancy index and coordination number over time, below the pressure."""
    if len(run.grains["time"]) < 2:
        return None
    figure, axes = plt.subplots(2, 1, figsize=(6.4, 4.2), sharex=True, constrained_layout=True)
    axes[0].plot(run.grains["time"], run.grains["p"] / 1e3, color=BLACK)
    axes[0].set(ylabel="$p'$ (kPa)", ylim=(0, None))
    axes[1].plot(run.grains["time"], run.grains["IR"], color=BLUE,
                 label=index_label(run.grains.get("IR_constraints", 6)))
    axes[1].plot(run.grains["time"], np.asarray(run.grains["Z"]) / 4, color=ORANGE, label="$Z/4$")
    axes[1].axhline(1, color=RED, linewidth=0.8, linestyle=(0, (4, 3)))
    axes[1].set(ylim=(0, None), xlabel="Time (s)")
    axes[1].legend()
    return figure


DRAWING = Drawing(Replay, [path, grains])

# SPDX-License-Identifier: BSD-3-Clause
"""Figures of simple shear in a periodic cell: stress path, stress-strain curve, rotation of principal stresses."""
import numpy as np

from .common import (BLACK, GREY, coloured_parts, draw_path, legend_below, legend_of_path, letters, mark_onset, plt,
                     progress_axes)
from .drawing import draws

FAINT = 1e-3  # p'/p0' below which a handful of contacts carries the stress: it has no direction to speak of


def shear_path(run):
    figure, panels = plt.subplots(1, 3, figsize=(9.6, 3.3), sharey=True, layout="constrained")
    tau = run["tau_xy"] / 1e3
    specs = ((run["sigma_y"] / 1e3, r"Vertical effective stress $\sigma_v^\prime$ (kPa)"),
             (run["p"] / 1e3, r"Mean effective stress $p^\prime$ (kPa)"), (100 * run.strain, run.strain_label))
    letters(panels)
    for axes, (x, label) in zip(panels, specs):
        draw_path(run, axes, x, tau)
        axes.set_xlabel(label)
    for axes in panels[:2]:
        axes.set_xlim(left=min(0.0, axes.dataLim.xmin))
    if run.cyclic:
        panels[2].axvline(0, color=BLACK, linewidth=0.6, zorder=1.4)
    panels[0].set_ylabel(r"Shear stress $\tau$ (kPa)")
    legend_of_path(run, figure, panels[0])
    return figure


@draws("fig_principal_stress")
def rotation(run):
    """Direction of the major principal stress against (a) cycles or gamma, (b) tau / sigma'_v."""
    # points, because it jumps where tau changes sign
    if not run.shear or not run.has("sigma1_angle"):
        return None
    strong = run.p_ratio > FAINT
    angle = np.where(strong, run["sigma1_angle"], np.nan)
    ratio = np.where(strong, run["tau_xy"] / np.where(strong, run["sigma_y"], 1.0), np.nan)
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.4), width_ratios=(1.5, 1), sharey=True,
                                         layout="constrained")
    progress_axes(run, [left])
    for axes, x in ((left, run.progress), (right, ratio)):
        for rows, colour, label in coloured_parts(run):
            axes.plot(x[rows], angle[rows], ".", color=colour, markersize=2, markeredgewidth=0, label=label)
        for level in (-45, 45):
            axes.axhline(level, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
    mark_onset(run, [left])
    left.set_ylim(-90, 90)
    left.set_yticks(range(-90, 91, 45))
    left.set_ylabel(r"Direction of $\sigma_1^\prime$ from the vertical (deg)")
    right.set_xlabel(r"Stress ratio $\tau/\sigma_v^\prime$")
    letters([left, right])
    legend_below(figure, left, 0.07, markerscale=4)
    return figure

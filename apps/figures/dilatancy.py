# SPDX-License-Identifier: BSD-3-Clause
"""Stress ratio and dilatancy of a drained stage."""
import numpy as np

from .common import BLUE, GREY, ORANGE, letters, mark_level, plt
from .drawing import draws

SHARE = 0.05  # of the strain of the stage: window of the slopes, as in dem/measure/strength.hpp


def rates(axial, volumetric):
    """D = -d eps_v/d|eps| at each row whose window is whole, by least squares; elsewhere not a number."""
    span = abs(axial[-1] - axial[0])
    direction = np.sign(axial[-1] - axial[0])
    found = np.full(axial.size, np.nan)
    for row, centre in enumerate(axial):
        rows = abs(axial - centre) <= 0.5 * SHARE * span
        inside = min(abs(centre - axial[0]), abs(axial[-1] - centre)) >= 0.5 * SHARE * span
        if inside and np.count_nonzero(rows) > 2:
            found[row] = -direction * np.polyfit(axial[rows] - centre, volumetric[rows], 1)[0]
    return found


@draws("fig_dilatancy")
def dilatancy(run):
    """Of the last drained stage (a) q/p' and (b) the rate of dilatancy D = -d eps_v/d eps against axial strain, (c)
    q/p' against D."""
    if not run.drained_stages or run.shear:
        return None
    stage = run.drained_stages[-1]
    rows = run["stage"] == stage["stage"]
    others = np.flatnonzero(~rows[:np.flatnonzero(rows)[-1]])
    rows[:others[-1] + 1 if others.size else 0] = False  # of a stage that is repeated the last time
    if np.count_nonzero(rows) < 3:
        return None
    axial = run["eps_y"][rows]
    rate = rates(axial, (run["eps_x"] + run["eps_y"] + run["eps_z"])[rows])
    ratio = run["q"][rows] / run["p"][rows]
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(9.6, 3.3), layout="constrained")
    left.plot(100 * axial, ratio, color=BLUE, linewidth=0.8)
    left.plot(100 * stage["strain_at_peak"], stage["q_over_p_peak"], "D", color=ORANGE, markersize=4,
              label=rf"largest, $\varphi$ = {stage['friction_peak_deg']:.1f}°")
    left.legend(loc="lower right")
    left.set_ylabel(r"Stress ratio $q/p^\prime$")
    middle.plot(100 * axial, rate, color=BLUE, linewidth=0.8)
    mark_level(middle, 0.0, "", GREY)
    middle.set_ylabel(r"Dilatancy $D = -\mathrm{d}\varepsilon_v/\mathrm{d}\varepsilon$")
    right.plot(rate, ratio, color=BLUE, linewidth=0.8)
    right.set(xlabel=r"Dilatancy $D$", ylabel=r"Stress ratio $q/p^\prime$")
    for axes in (left, middle):
        axes.set_xlabel(run.strain_label)
    letters([left, middle, right])
    return figure

# SPDX-License-Identifier: BSD-3-Clause
"""Paths of tests at equal stress or strain, and their distances."""
import numpy as np

Q_GRID = np.arange(-58e3, 58.1e3, 1e3)  # Pa; the ends, where walls brake, are in the reversal itself
STRAIN_SPACING = 1e-5


def cyclic_path(history, n_reversals):
    """p'/p0' of the first half cycles at equal q and at the reversals, point by point; None if the test ended before.

    Half cycle k runs from reversal k to reversal k + 1. There q is made monotonic by its running maximum along the
    direction of loading; p' is interpolated linearly on Q_GRID (the first half cycle from 0) and at the reversal.
    """
    ends = history.reversal_rows
    if len(ends) < n_reversals:
        return None
    points = []
    begin, direction = 0, 1
    for k in range(n_reversals):
        rows = slice(begin, ends[k] + 1)
        q = np.maximum.accumulate(direction * history.q[rows])
        p = history.p[rows]
        grid = Q_GRID[Q_GRID >= 1e3] if k == 0 else Q_GRID
        points.append(np.interp(grid, q, p))
        points.append(p[-1:])
        begin, direction = ends[k], -direction
    return np.concatenate(points) / history.p0


def monotonic_path(history, strain):
    """p'/p0' and q/p0' at equal axial strain from 0 to `strain`, shape (2, points); None if the test ended before."""
    if history.eps_y[-1] < strain * (1 - 1e-3):
        return None
    grid = np.linspace(0, strain, round(strain / STRAIN_SPACING) + 1)
    order = np.maximum.accumulate(history.eps_y)
    return np.array([np.interp(grid, order, column) for column in (history.p, history.q)]) / history.p0


def deviation(path, reference):
    """Distance from the reference in the p'-q plane, over p0', point by point: its root mean square and its largest."""
    if path is None or reference is None:
        return None
    difference = path - reference
    distance = np.abs(difference) if difference.ndim == 1 else np.hypot(*difference)
    return float(np.sqrt(np.mean(distance**2))), float(distance.max())

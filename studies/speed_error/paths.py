# SPDX-License-Identifier: BSD-3-Clause
"""What is measured on the history of a run."""
import csv
import json

import numpy as np

# two-sided 95 % by number of values
STUDENT = {2: 12.7, 3: 4.30, 4: 3.18, 5: 2.78, 6: 2.57, 8: 2.36, 10: 2.26, 12: 2.20, 15: 2.14, 20: 2.09}
Q_GRID = np.arange(-58e3, 58.1e3, 1e3)  # Pa; the ends, where walls brake, stand in the reversal itself
STRAIN_SPACING = 1e-5


class History:
    """Columns of history.csv by name without unit, and p0', Pa."""

    def __init__(self, folder):
        with open(folder / "history.csv", newline="") as file:
            rows = list(csv.reader(file))
        names = [name.split(" ")[0] for name in rows[0]]
        table = np.array(rows[1:], dtype=float)
        for name, column in zip(names, table.T):
            setattr(self, name, column)
        self.summary = json.loads((folder / "summary.json").read_text())
        self.p0 = self.p[0]

    @property
    def onset(self):
        """Row of initial liquefaction, or None."""
        rows = np.flatnonzero(self.liquefied)
        return int(rows[0]) if rows.size else None

    @property
    def reversal_rows(self):
        """Row in which each reversal is recorded, the first load reversal first."""
        return [int(np.flatnonzero(self.reversals >= k)[0]) for k in range(1, int(self.reversals[-1]) + 1)]


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


def ensemble(values):
    """Mean, standard deviation, standard error and number of the values that are there."""
    values = np.array([v for v in values if v is not None and np.isfinite(v)], dtype=float)
    n = values.size
    if n == 0:
        return float("nan"), float("nan"), float("nan"), 0
    deviation_ = values.std(ddof=1) if n > 1 else float("nan")
    return float(values.mean()), float(deviation_), float(deviation_ / np.sqrt(n)), n


def mean_and_interval(values):
    """Mean, and half the width of its 95 % interval."""
    mean, _, error, n = ensemble(values)
    return mean, STUDENT[max(k for k in STUDENT if k <= n)] * error if n > 1 else float("nan")

# SPDX-License-Identifier: BSD-3-Clause
"""The history of a run, as studies take it."""
import json

import numpy as np

from isostat.results import read_table


def parsed(folder, name="summary"):
    """summary.json or times.json of a run."""
    return json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))


class History:
    """Columns of history.csv as attributes, the summary, and p0', Pa."""

    def __init__(self, folder):
        vars(self).update(read_table(folder / "history.csv"))
        self.summary = parsed(folder)
        self.p0 = self.p[0]

    def keep(self, rows):
        """Of every column these rows alone; p0' stays what it is."""
        vars(self).update({name: column[rows] for name, column in vars(self).items() if isinstance(column, np.ndarray)})

    @property
    def onset(self):
        """Row of initial liquefaction, or None."""
        rows = np.flatnonzero(self.liquefied)
        return int(rows[0]) if rows.size else None

    @property
    def reversal_rows(self):
        """Row in which each reversal is recorded, the first load reversal first."""
        return [int(np.flatnonzero(self.reversals >= k)[0]) for k in range(1, int(self.reversals[-1]) + 1)]

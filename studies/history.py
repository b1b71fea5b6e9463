# SPDX-License-Identifier: BSD-3-Clause
"""The history of a run, as studies take it."""
import json

import numpy as np

from isostat.results import read_table


class History:
    """Columns of history.csv as attributes, the summary, and p0', Pa."""

    def __init__(self, folder):
        vars(self).update(read_table(folder / "history.csv"))
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

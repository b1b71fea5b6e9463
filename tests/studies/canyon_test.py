# SPDX-License-Identifier: BSD-3-Clause
"""The canyon between free fields against its exact solution."""
import sys

import numpy as np

from column_support import SCENES, ColumnTest
from figures import column_box
from figures.column_results import Column
from studies import canyon
from support import BIN

sys.argv[0] = str(BIN / "isostat")  # next to the programs


class Canyon(ColumnTest):
    def test_amplification_is_that_of_trifunac(self):
        self.assert_done(self.run_column(SCENES / "canyon.toml", "-o", "run"))
        column = Column(self.folder / "run")
        self.assertIsNotNone(column_box.surface_amplification(column))
        x, pairs = canyon.compared(column)
        self.assertGreater(len(x), 60)
        for (found, exact), tolerance in zip(pairs, (0.02, 0.03)):
            self.assert_near(found, exact, tolerance, "sides and base six and five radii away, half-radius elements")

    def test_the_exact_solution_is_level_ground_far_away(self):
        for eta in canyon.ETA:
            self.assert_near(canyon.trifunac(np.array([1e4]), eta), 1, 0.02, "waves that leave fall by 1/sqrt(r)")
            edge = canyon.trifunac(np.array([1 - 1e-9, 1 + 1e-9]), eta)
            self.assert_near(edge[0], edge[1], 1e-3, "continuous at the edge")

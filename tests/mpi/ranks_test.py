# SPDX-License-Identifier: BSD-3-Clause
"""One mesh over 1, 2 and 3 ranks gives the same numbers to 1e-10 (distributed_waves.cpp)."""
import numpy as np

from column_support import ColumnTest
from support import BIN


class Ranks(ColumnTest):
    def numbers_on(self, ranks):
        """Cells of the smallest part, and the rows of numbers that the program prints."""
        run = self.run_command(["mpirun", "--oversubscribe", "-n", str(ranks), BIN / "distributed_waves"])
        self.assert_done(run)
        lines = [line.split() for line in run.stdout.splitlines()]
        fewest = min(int(words[2]) for words in lines if words[0] == "cells")
        return fewest, np.array([words for words in lines if words[0] != "cells"], dtype=float)

    def test_numbers(self):
        _, expected = self.numbers_on(1)
        self.assertEqual(len(expected), 5)
        self.assertTrue((np.abs(expected[:, 1]) > 1e-5).all(), expected)
        for ranks in (2, 3):
            fewest, found = self.numbers_on(ranks)
            self.assertGreater(fewest, 0, "a rank without cells: nothing is shared out")
            self.assert_near(found, expected, 1e-10 * np.where(expected == 0, 1, np.abs(expected)),
                             "round-off of sums over the ranks")

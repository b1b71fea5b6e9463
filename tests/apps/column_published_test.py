# SPDX-License-Identifier: BSD-3-Clause
"""The soil column against the published example of the program nrattle (tests/reference/nrattle)."""
import numpy as np

from column_support import ColumnTest
from studies import column_cases as cases
from studies.column_layers import Layers


class Published(ColumnTest):
    def test_layer_matrix(self):
        profile, frequency, amplification = cases.published()
        self.assertEqual(profile.shape, (400, 3))
        layers = Layers(*profile.T, rock=(3500.0, 2720.0))
        self.assert_near(np.abs(layers.surface(frequency)), amplification, 1e-4, "the five digits that are published")

    def test_column(self):
        """8 km of soil and rock in 206 layers, to 10 Hz; to 50 Hz in docs/results/column_others.md."""
        _, frequency, amplification = cases.published()
        cases.write_published(self.folder, 10)
        rows, _ = self.rows_of(cases.published_scene(self.folder, corner=10, per_wave=5, duration=9))
        low = (frequency > 0) & (frequency <= 10)
        off = np.abs(cases.amplification(rows, frequency[low]) / amplification[low] - 1)
        self.assert_below(off, 0.005, "five quadratic elements for the wave of 10 Hz")
        self.assert_below(np.median(off), 5e-4, "waves still in the ground after 9 s")

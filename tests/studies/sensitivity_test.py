# SPDX-License-Identifier: BSD-3-Clause
"""Sensitivities of observables whose dependence on the parameters is known."""
import math
import unittest

import numpy as np

from isostat.campaign import study


class Sensitivities(unittest.TestCase):
    def test_powers_are_found_and_scatter_is_not(self):
        of = study.load("sand_sensitivity")
        powers = {"friction": 2, "young": -0.5}  # of all observables
        noise = np.random.default_rng(1)
        found = {}
        for run in of.runs(study.parse([], "sand_sensitivity", of)):
            value = of.FACTOR**(run.side * powers.get(run.parameter, 0)) * (1 + 0.02 * noise.standard_normal())
            found[run.law, run.seed, run.parameter, run.side] = {name: 50 * value for name in of.OBSERVABLES}
        rows = of.sensitivities(found)
        self.assertEqual(len(rows), sum(map(len, of.LAWS.values())) * len(of.OBSERVABLES))
        for row in rows:
            power = powers.get(row["parameter"], 0)
            exact = math.tanh(power * math.log(of.FACTOR)) / math.log(of.FACTOR)
            self.assertLess(abs(row["S"] - exact), 3 * row["interval"])
            if power:
                self.assertTrue(of.is_seen(row))

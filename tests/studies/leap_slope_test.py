# SPDX-License-Identifier: BSD-3-Clause
"""Peak friction and the fit of the study leap_slope, from what is known."""
import itertools

import numpy as np

from isostat.campaign import study
from support import ToleranceTest

DRAINED = study.load("leap_slope").drained


def history(q, p):
    q, p = np.array(q, dtype=float), np.array(p, dtype=float)
    return {"q": q, "p": p, "eps_y": np.linspace(0, 0.1, len(q)), "e": np.full(len(q), 0.6)}


class LeapSlope(ToleranceTest):
    def test_peak_friction_of_known_states(self):
        """100 and 300 kPa: sin(phi) = 200/400, whichever of them is axial."""
        for q, p in ((200e3, 500e3 / 3), (-200e3, 700e3 / 3)):
            friction, strain, e = DRAINED.strength(history([0, q, q / 2], [100e3, p, p]))
            self.assert_close(friction, 30, 1e-12, "rounding")
            self.assertEqual((strain, e), (0.05, 0.6))

    def test_packings_of_a_void_ratio(self):
        found = [(2, 42, 0.01, 0.55), (8, 38, 0.1, 0.65), (8, 40, 0.1, 0.65)]
        friction, preparation = DRAINED.at_void_ratio(found, 0.6)
        self.assert_close(friction, 40.5, 1e-12, "mean of 42 and 39, rounding")
        self.assert_close(preparation, 4, 1e-12, "geometric mean of 2 and 8, rounding")

    def test_fit_finds_what_made_the_strengths(self):
        """The laboratory's mean peak friction of each density, plus what friction and limit are off."""
        laboratory = DRAINED.fitted()
        self.assertEqual(list(laboratory), [0.584, 0.604, 0.724])
        known, limits = (23.0, 0.07), np.log(DRAINED.LIMITS)
        densities = dict(zip(DRAINED.PREPARATIONS, (*laboratory, 0.9)))
        strengths = {}
        for friction, limit, preparation in itertools.product(DRAINED.FRICTIONS, DRAINED.LIMITS, densities):
            e = densities[preparation]
            off = friction - known[0] + (1 + 9 * e) * (np.log(limit) - np.log(known[1])) / (limits[1] - limits[0])
            strengths[friction, limit, preparation, 1] = (laboratory.get(e, 30) + off, 0.1, e)
        friction, limit, misfit, tests = DRAINED.fit(strengths)
        self.assert_close(friction, known[0], 0.005, "steps of 0.05")
        self.assert_close(limit, known[1], 0.02, "steps of 0.7 %")
        self.assert_near(misfit, 0, 0.05, "deg, as steps are finite")
        self.assert_close(tests[0.604][2], DRAINED.PREPARATIONS[1], 1e-9, "rounding")

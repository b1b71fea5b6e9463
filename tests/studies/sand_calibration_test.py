# SPDX-License-Identifier: BSD-3-Clause
"""Densities of specimens and friction angles of the study sand_calibration, from what is known."""
import numpy as np

from isostat.campaign import study
from isostat.campaign.calibrate.curves import Curve
from support import ToleranceTest

OF = study.load("sand_calibration")
PREDICTIONS, RESULTS = OF.predictions, OF.results


class Densities(ToleranceTest):
    def test_relative_densities_are_those_that_the_laboratory_states(self):
        rows = PREDICTIONS.read_csv(PREDICTIONS.LABORATORY / "drained/programme.csv")
        self.assertEqual(len(rows), 25)
        for row in rows:
            self.assert_near(100 * PREDICTIONS.relative_density(row["e_0[-]"]), row["Dr_0[%]"], 0.06,
                             "percent with one decimal")

    def test_preparation_friction_follows_the_fitted_ones(self):
        fit = object.__new__(PREDICTIONS.Fit)
        fit.frictions = {"loose": 24.0, "medium": 12.0, "dense": 3.0}
        of = {group: PREDICTIONS.densities()[test][0] for group, test in PREDICTIONS.fitted().items()}
        for group, friction in fit.frictions.items():
            self.assert_close(fit.preparation(of[group]), friction, 1e-12, "rounding")
        between = fit.preparation((of["medium"] + of["dense"]) / 2)
        self.assert_close(between, 6, 1e-12, "geometric mean, rounding")
        beyond = fit.preparation(2 * of["dense"] - of["medium"])
        self.assert_close(beyond, 0.75, 1e-12, "a quarter again, rounding")


class Measures(ToleranceTest):
    def test_friction_angle_of_a_known_state(self):
        q = np.array([50e3, 200e3, 180e3])  # 100 kPa: sin(phi) = 200/(200 + 200)
        self.assert_close(RESULTS.peak(Curve(q, q, q), 100e3), 30, 1e-12, "rounding")

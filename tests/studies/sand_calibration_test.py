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

    def test_preparation_follows_the_fitted_ones(self):
        frictions = {"loose": 24.0, "medium": 12.0, "dense": 3.0}
        of = {group: PREDICTIONS.densities()[test][0] for group, test in PREDICTIONS.fitted().items()}
        for group, friction in frictions.items():
            self.assert_close(PREDICTIONS.at_density(frictions, of[group]), friction, 1e-12, "rounding")
        between = PREDICTIONS.at_density(frictions, (of["medium"] + of["dense"]) / 2)
        self.assert_close(between, 6, 1e-12, "geometric mean, rounding")
        beyond = PREDICTIONS.at_density(frictions, 2 * of["dense"] - of["medium"])
        self.assert_close(beyond, 0.75, 1e-12, "a quarter again, rounding")
        self.assertEqual(PREDICTIONS.at_density(dict.fromkeys(frictions, 0), 0.9), 0, "packings that are not opened")


class Posterior(ToleranceTest):
    def test_of_linear_curves_finds_parameters_and_width(self):
        random = np.random.default_rng(2)
        places, truth = random.random((40, 8)), np.array([0.5, 0.4, *3 * [0.6], 0.5, 0.5, 0.5])
        concerned = {name: [0, 1, 2 + k, 5 + k] for k, name in enumerate(("loose", "medium", "dense"))}
        slope = {name: random.standard_normal((4, 60)) for name in concerned}
        curves = {name: places[:, on] @ slope[name] + 0.1 * random.standard_normal((40, 60))
                  for name, on in concerned.items()}
        laboratory = {name: truth[on] @ slope[name] for name, on in concerned.items()}
        found, shares = OF.posterior.posterior(places, curves, laboratory, concerned), OF.posterior.shares
        self.assert_near(np.abs(shares(found.best) - truth).max(), 0, 0.03, "0.1 over the root of a trial's 60 values")
        self.assert_close(found.missed, 0.1, 0.1, "noise of the trial left out; 40 trials for five numbers")
        self.assert_close(found.expected**2, found.misfit**2 + found.missed**2 * 5 / 40, 1e-12, "rounding")
        self.assert_close(found.tied, found.misfit, 0.05, "the truth has one expansion; 40 trials, noise 0.1")
        width = np.std([shares(sample)[7] for sample in found.samples])
        self.assert_close(width, found.expected / 2**0.5, 0.25, "nearly orthogonal slopes, mean square 1 / 3")


class Measures(ToleranceTest):
    def test_friction_angle_of_a_known_state(self):
        q = np.array([50e3, 200e3, 180e3])  # 100 kPa: sin(phi) = 200/(200 + 200)
        self.assert_close(RESULTS.peak(Curve(q, q, q), 100e3), 30, 1e-12, "rounding")

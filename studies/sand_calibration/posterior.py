# SPDX-License-Identifier: BSD-3-Clause
"""From a design of trials: the best set of parameters, and which others the tests leave possible.

At the compared strains each fitted curve is taken linear in the p - 1 parameters that it depends on (least squares over
the n trials), so that the square of the misfit M (docs/campaigns/calibrate.md) is a quadratic form. The posterior is

    P ~ exp(-D (M^2 - M_min^2)/(2 s^2)),     s^2 = M_min^2 + V^2 p/n,     D = 2 for each fitted curve

within the bounds: what the best set misses and how well the mean of packings is known, in the measure of M^2. V^2 is
the mean square by which a trial misses the prediction of all others: scatter of packings and curvature together. D
counts q and volumetric strain of a test as one datum each: what a curve misses at one strain it misses at the next.

tested: tests/studies/sand_calibration_test.py
"""
import dataclasses
import functools

import numpy as np
from scipy.optimize import lsq_linear

from isostat.campaign.calibrate.curves import compare, read_laboratory, read_model
from isostat.campaign.calibrate.plan import read_plan
from isostat.campaign.calibrate.scenes import in_si
from studies.tables import read_csv

PARAMETERS = [{"key": "contact.friction", "bounds": ["18 deg", "28 deg"], "start": "23 deg"},
              {"key": "contact.rolling.limit", "bounds": [0.05, 0.2], "start": 0.1, "scale": "log"},
              *({"key": "specimen.expansion", "bounds": [0.004, 0.04], "start": 0.013, "scale": "log", "curve": group}
                for group in ("loose", "medium", "dense")),
              *({"key": "specimen.preparation_friction", "bounds": [f"{low} deg", f"{high} deg"],
                 "start": f"{start} deg", "curve": group} for group, low, start, high in
                (("loose", 18, 26, 34), ("medium", 9, 14, 20), ("dense", 1, 4, 8)))]
SAMPLES = 200_000


def number(value):
    return float(str(value).split()[0])


def shares(values):
    """Where values are between the bounds; inverse of values_at()."""
    low, high = np.array([[number(bound) for bound in one["bounds"]] for one in PARAMETERS]).T
    log = np.array(["scale" in one for one in PARAMETERS])
    return np.where(log, np.log(np.divide(values, low)) / np.log(high / low), np.subtract(values, low) / (high - low))


def values_at(place):
    low, high = np.array([[number(bound) for bound in one["bounds"]] for one in PARAMETERS]).T
    log = np.array(["scale" in one for one in PARAMETERS])
    return np.where(log, low * (high / low)**place, low + place * (high - low))


@dataclasses.dataclass
class Posterior:
    best: np.ndarray  # values in the units of the keys
    misfit: float  # of the best set, by the linear curves
    missed: float  # V
    expected: float  # s
    tied: float  # misfit of the best set with one expansion for all densities
    samples: np.ndarray  # one set each row

    def band(self):
        """16 %, 50 % and 84 % of each parameter."""
        return np.quantile(self.samples, (0.16, 0.5, 0.84), axis=0)

    def correlation(self):
        return np.corrcoef(self.samples.T)

    def draw(self, k):
        """The best set (0), then sets at random."""
        return self.best if k == 0 else self.samples[k]


def posterior(places, curves, laboratory, concerned):
    """places: shares of the trials   curves: {curve: row for each trial}   laboratory: {curve: row}, all over the
    largest value   concerned: {curve: which parameters}"""
    linear, missed, n = {}, [], len(places)
    for name, rows in curves.items():
        design = np.column_stack([np.ones(n), places[:, concerned[name]]])
        linear[name] = np.linalg.lstsq(design, rows, rcond=None)[0]
        leverage = np.einsum("ij,ji->i", design, np.linalg.pinv(design))  # a trial left out misses by r/(1 - h)
        missed.append(np.mean(((rows - design @ linear[name]) / (1 - leverage)[:, None])**2))

    share = [1 / np.sqrt(len(laboratory) * row.size) for row in laboratory.values()]  # M^2 = |a x - b|^2
    b = np.concatenate([scale * (row - linear[name][0]) for scale, (name, row) in zip(share, laboratory.items())])
    blocks = [np.zeros((places.shape[1], row.size)) for row in laboratory.values()]
    for block, scale, name in zip(blocks, share, laboratory):
        block[concerned[name]] = scale * linear[name][1:]
    a = np.hstack(blocks).T
    best = lsq_linear(a, b, (0, 1)).x
    # one expansion: the columns of the three are summed
    first = [next(j for j, one in enumerate(PARAMETERS) if j == k or one["key"] == key == "specimen.expansion")
             for k, key in enumerate(one["key"] for one in PARAMETERS)]
    tied = np.eye(len(first))[first]
    shared = a @ tied[:, sorted(set(first))]
    least, missed = np.sum((a @ best - b)**2), np.mean(missed)
    expected = least + missed * design.shape[1] / n
    covariance = expected / (2 * len(laboratory)) * np.linalg.inv(a.T @ a)
    free = np.random.default_rng(1).multivariate_normal(np.linalg.lstsq(a, b, rcond=None)[0], covariance, SAMPLES)
    inside = free[((free > 0) & (free < 1)).all(axis=1)]
    of_tied = 2 * lsq_linear(shared, b, (0, 1)).cost
    return Posterior(values_at(best), *map(float, np.sqrt([least, missed, expected, of_tied])), values_at(inside))


@functools.cache
def fit(output):
    """Of the design in the folder of a study."""
    plan = read_plan(output / "plans/design.toml")
    trials = [row for row in read_csv(output / "design/trials.csv") if not isinstance(row["failed curves"], str)]
    places = np.array([shares([row[name] for name in list(row)[1:1 + len(PARAMETERS)]]) for row in trials])
    curves, laboratory, concerned = {}, {}, {}
    for curve in (curve for curve in plan.curve if not curve.blind):
        measured = read_laboratory(curve, in_si(curve.pressure))
        found = [compare(measured, [read_model(output / "design" / row["folder"] / f"{curve.name}_seed{seed}", curve)
                                    for seed in range(1, 1 + plan.specimens.seeds)], curve, plan.misfit)
                 for row in trials]
        scales = [np.abs(column).max() for column in found[0].laboratory[1:]]
        curves[curve.name], (laboratory[curve.name], *_) = (
            np.array([np.concatenate([column / scale for column, scale in zip(which[1:], scales)]) for which in some])
            for some in ([one.mean for one in found], [found[0].laboratory]))
        concerned[curve.name] = [k for k, one in enumerate(PARAMETERS) if one.get("curve") in (None, curve.group)]
    return posterior(places, curves, laboratory, concerned)

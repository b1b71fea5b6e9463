# SPDX-License-Identifier: BSD-3-Clause
"""The curve of a test, measured or computed, and how far two of them are apart.

tested: tests/python/calibration_curves_test.py
"""
import dataclasses
import math
import pathlib
from typing import Any, NamedTuple

import numpy as np

from isostat import _core
from isostat.campaign.calibrate.scenes import direction
from isostat.results import read_table


class Curve(NamedTuple):
    """A monotonic test, row by row. Compression positive, as the files have it; but `strain` grows in the direction of
    the test, in extension as in compression."""

    strain: np.ndarray  # axial, linear or logarithmic as the laboratory has it
    q: np.ndarray  # axial minus radial stress, Pa
    other: np.ndarray  # drained: volumetric strain, from 0; undrained: mean effective stress p', Pa


@dataclasses.dataclass
class Comparison:
    """A laboratory curve and the model's at the compared strains: mean and standard deviation over the seeds."""

    laboratory: Curve
    mean: Curve
    deviation: Curve
    misfit: float
    scatter: float | None  # standard error of the mean, in the measure of the misfit; None for one seed


def read_model(folder: pathlib.Path, plan: Any) -> Curve:
    """history.csv of a finished run of element_test, with strains as the laboratory has them.   Raises InputError"""
    history = read_table(folder / "history.csv")
    try:
        x, y, z, p, q = (history[name] for name in ("eps_x", "eps_y", "eps_z", "p", "q"))
    except KeyError as error:
        raise _core.InputError(f"{folder / 'history.csv'}: is damaged ({error.args[0]}).") from error
    def as_measured(strains):
        return strains if plan.strains == "logarithmic" else np.array([-math.expm1(-strain) for strain in strains])
    strain = direction(plan) * as_measured(y)
    rows = np.flatnonzero(np.diff(np.maximum.accumulate(strain), prepend=-np.inf) > 0)  # a step may have two rows
    return Curve(strain[rows], q[rows], (as_measured(x + y + z) if plan.test == "drained" else p)[rows])


def interpolated(curve: Curve, strains: np.ndarray) -> Curve:
    x = curve.strain
    k = np.clip(np.searchsorted(x, strains), 1, len(x) - 1)
    t = (strains - x[k - 1]) / (x[k] - x[k - 1])
    return Curve(strains, *(np.where(strains > x[-1], y[-1], y[k - 1] + t * (y[k] - y[k - 1])) for y in curve[1:]))


def compared_strains(laboratory: Curve, plan: Any, settings: Any) -> np.ndarray:
    """strain_end i/n or strain_end (i/n)^2, i = 1..n, without those before the laboratory's first row."""
    share = np.arange(1, settings.points + 1) / settings.points
    strains = plan.strain_end * (share * share if settings.spacing == "quadratic" else share)
    return strains[strains >= laboratory.strain[0]]


def compare(laboratory: Curve, models: list[Curve], plan: Any, settings: Any) -> Comparison:
    """The distance of the mean of the model's curves to the laboratory's, with v the volumetric strain of a drained and
    p' of an undrained test:

        misfit^2 = 1/(2n) sum_i [ ((q_i - q_i^lab)/max|q^lab|)^2 + ((v_i - v_i^lab)/max|v^lab|)^2 ]

    Maxima over the compared strains; between rows curves are straight. The scatter has the standard error of the mean
    in place of the differences: a misfit of this size cannot be distinguished from none.

    Raises InputError: a laboratory curve that is zero throughout; a model curve that ends too early
    """
    strains = compared_strains(laboratory, plan, settings)
    for model in models:
        last = model.strain[-1] if len(model.strain) else 0
        if len(model.strain) < 2 or last < 0.99 * plan.strain_end:
            raise _core.InputError(f"the run ended at a strain of {last:g}, before {plan.strain_end:g}")
    measured, there = interpolated(laboratory, strains), [interpolated(model, strains) for model in models]
    n, means, deviations, off, scatter = len(models), [], [], np.zeros(len(strains)), np.zeros(len(strains))
    for k, what in ((1, "q"), (2, "the volumetric strain" if plan.test == "drained" else "p'")):
        scale = np.abs(measured[k]).max()
        if scale == 0:
            raise _core.InputError(f"{plan.path}: {what} is zero throughout ({plan.where}); must vary because misfits "
                                   "are shares of its largest value. Give another curve.")
        rows = np.array([model[k] for model in there])
        means.append(running_sum(rows / n))
        deviations.append(np.sqrt(running_sum((rows - means[-1]) ** 2) / (n - 1)) if n > 1 else np.zeros(len(strains)))
        off += ((means[-1] - measured[k]) / scale) ** 2
        scatter += (deviations[-1] / scale) ** 2
    count = 2 * len(strains)
    return Comparison(measured, Curve(strains, *means), Curve(strains, *deviations),
                      math.sqrt(running_sum(off) / count),
                      math.sqrt(running_sum(scatter) / count / n) if n > 1 else None)


def running_sum(rows: np.ndarray) -> Any:
    """Row after row: the same to the last bit on any machine, which the search builds on."""
    return np.add.accumulate(rows)[-1]


def total_misfit(misfits: list[float], plan: Any) -> float:
    """sqrt(sum w m^2 / sum w) over the fitted curves of `misfits`, which are in the order of the plan."""
    fitted = np.array([(curve.weight * misfit * misfit, curve.weight) for curve, misfit in zip(plan.curve, misfits)
                       if not curve.blind])
    squares, weights = running_sum(fitted)
    return math.sqrt(squares / weights)

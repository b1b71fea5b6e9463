# SPDX-License-Identifier: BSD-3-Clause
"""Where to look for better parameters.   tested: tests/python/calibration_test.py"""
from collections.abc import Callable
from typing import Any

import numpy as np

from isostat.campaign.engines import library

ALGORITHMS = {"bobyqa": "LN_BOBYQA", "sbplx": "LN_SBPLX", "crs2": "GN_CRS2_LM"}
SEED = 1  # of CRS2


class BudgetUsed(Exception):
    """Raised by an objective whose budget is used up: why."""


def nlopt() -> Any:
    """The library.   Raises InputError (it is not installed)"""
    return library("nlopt", "python3-nlopt", "calibrate")


def sobol_design(dimensions: int, n: int) -> list[list[float]]:
    """n points of a design: a Sobol sequence in the unit cube (Sobol 1967), without the origin."""
    sequence = library("scipy.stats", "python3-scipy", "calibrate").qmc.Sobol(dimensions, scramble=False)
    sequence.fast_forward(1)
    return sequence.random(n).tolist()


def search(settings: Any, start: list[float], objective: Callable[[list[float]], float]) -> str:
    """Looks for a smaller value from `start` on, in the unit cube, by NLopt: BOBYQA (Powell 2009), Sbplx (Rowan 1990)
    or CRS2 with local mutation (Kaelo and Ali 2006). It always asks for the same points in the same order, so that it
    can be repeated from known values. The best point is not returned: the objective knows what it has been asked.

    Returns why it ended.   Raises what the objective raises, except for BudgetUsed
    """
    optimiser = nlopt()
    optimiser.srand(SEED)
    n = len(start)
    algorithm = optimiser.opt(getattr(optimiser, ALGORITHMS[settings.method]), n)
    algorithm.set_lower_bounds(np.zeros(n))
    algorithm.set_upper_bounds(np.ones(n))
    algorithm.set_initial_step(np.full(n, settings.first_step))
    algorithm.set_xtol_abs(settings.tolerance)
    raised: list[BaseException] = []  # NLopt does not pass on all that is raised

    def guarded(shares, _):
        try:
            return objective(shares.tolist()) if not raised else 0.0
        except BaseException as error:
            raised.append(error)
            algorithm.force_stop()
            return 0.0

    algorithm.set_min_objective(guarded)
    ending = f"steps became smaller than {settings.tolerance:g} of the bounds"
    try:
        algorithm.optimize(start)
    except optimiser.ForcedStop:
        pass
    except optimiser.RoundoffLimited:
        ending = "no step of the method makes the misfit smaller"
    if raised and not isinstance(raised[0], BudgetUsed):
        raise raised[0]
    return str(raised[0]) if raised else ending

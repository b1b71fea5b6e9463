# SPDX-License-Identifier: BSD-3-Clause
"""What one run says about resistance, and the line through all.   tested: tests/apps/resistance_test.py"""
import dataclasses
import math
import pathlib
from typing import Any

import numpy as np

from isostat.campaign.runs import read_summary
from isostat.results import read_table

DOUBLE_AMPLITUDE, SINGLE_AMPLITUDE = 0.03, 0.0375  # of gamma: what counts as failure
REFERENCE = 15  # cycles that stand for an earthquake of magnitude 7.5


@dataclasses.dataclass(frozen=True)
class Kind:
    """A cyclic test, in the words of scenes and of the report."""

    test: str
    ratio: str  # how CSR is defined
    strain: str  # column of the driven strain in history.csv
    gamma_factor: float  # engineering shear strain over driven strain at constant volume

    def amplitude(self, ratio: float, p0: float) -> dict[str, Any]:
        """The key of the stage that gives this CSR; p0 in Pa."""
        return {"deviator_amplitude": f"{2 * ratio * p0!r} Pa"} if self.test == "triaxial" else {"stress_ratio": ratio}


@dataclasses.dataclass
class Outcome:
    """What one run says. Numbers of cycles are half those of load reversals, at least 0.25; None: not reached."""

    ratio: float
    seed: int
    status: str = "missing"  # liquefied, censored (not within the cycles), strain (4 % came first), failed, missing
    cycles: float = 0  # applied in all
    to_liquefaction: float | None = None  # to p'/p0' < liquefaction_ratio
    to_double_amplitude: float | None = None  # gamma swings by 3 % within one half cycle
    to_single_amplitude: float | None = None  # |gamma| reaches 3.75 %
    void_ratio: float | None = None
    seconds: float | None = None
    note: str = ""

    def read(self, folder: pathlib.Path, stage: int, kind: Kind, max_strain: float) -> None:
        """Takes what a finished run left.   Raises InputError (damaged files)"""
        history = read_table(folder / "history.csv")
        rows = history["stage"] == stage
        reversals, strain = history["reversals"][rows], history[kind.strain][rows]
        self.cycles = 0.5 * reversals[-1] if len(reversals) else 0
        self.to_liquefaction = first_cycle(reversals, history["liquefied"][rows] != 0)
        gamma = kind.gamma_factor * strain
        before = np.concatenate([reversals[:1], reversals[:-1]])  # a row with a reversal still ends the half cycle before
        self.to_single_amplitude = first_cycle(before, np.abs(gamma) >= SINGLE_AMPLITUDE)
        self.to_double_amplitude = first_cycle(before, swings(reversals, gamma) >= DOUBLE_AMPLITUDE)
        largest = np.abs(strain).max(initial=0)
        self.status = ("liquefied" if self.to_liquefaction is not None else
                       "strain" if largest >= max_strain else "censored")
        summary = read_summary(folder)
        self.void_ratio, self.seconds = summary.get("void_ratio"), summary.get("seconds")


def first_cycle(reversals, met) -> float | None:
    return max(0.25, 0.5 * reversals[np.argmax(met)]) if met.any() else None


def swings(reversals, gamma):
    """Range of gamma within the half cycle of each row, so far; the row of a reversal belongs to both half cycles."""
    found = np.zeros(len(gamma))
    turns = [0, *np.flatnonzero(np.diff(reversals)) + 1, len(gamma)]
    for start, end in zip(turns, turns[1:]):
        part = gamma[start:end + 1]
        found[start + 1:end + 1] = (np.maximum.accumulate(part) - np.minimum.accumulate(part))[1:]
    return found


def fit_power_law(outcomes: list[Outcome]) -> dict[str, Any] | None:
    """CSR = a N^-b through the liquefied runs: least squares of log N, which scatters at a given CSR.

    b_error is the standard error of b; it and R2 are None for two runs, through which a line always goes. None if fewer
    than two ratios have a liquefied run, or if all liquefied within a cycle: counted by half cycles, these give no slope.
    """
    found = [outcome for outcome in outcomes if outcome.to_liquefaction is not None]
    ratio, cycles = (np.log([getattr(outcome, name) for outcome in found]) for name in ("ratio", "to_liquefaction"))
    if len(set(ratio)) < 2 or cycles.max() <= 0:
        return None
    x, y = ratio - ratio.mean(), cycles - cycles.mean()
    xx, xy, yy = float(x @ x), float(x @ y), float(y @ y)
    if xy == 0:
        return None
    slope, n = xy / xx, len(found)
    scatter = max(0.0, yy - slope * xy)
    a, b = math.exp(ratio.mean() - cycles.mean() / slope), -1 / slope
    return {"a": a, "b": b, "b_error": math.sqrt(scatter / (n - 2) / xx) / slope**2 if n > 2 else None,
            "R2": (1 - scatter / yy if yy > 0 else 0.0) if n > 2 else None, "runs": n,
            "left_out": sum(outcome.status in ("censored", "strain") for outcome in outcomes),
            "CSR_15": a * REFERENCE ** -b}

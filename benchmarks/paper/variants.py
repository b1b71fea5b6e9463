# SPDX-License-Identifier: BSD-3-Clause
"""What hangs on how specimens are made, and on how fast they are tested: a row for each variant."""
import numpy as np

from paper import plan, states
from speed_error import paths


def row_of(name, value, histories, columns):
    """Mean and standard error of each column, a function of the history, over those of which it is a number."""
    row = {name: value, "seeds": len(histories), "liquefied": sum(h.onset is not None for h in histories)}
    for column, function in columns.items():
        row[column], _, row[f"{column} s.e."], _ = paths.ensemble([function(h) for h in histories])
    return row


def cycles(history):
    return np.nan if history.onset is None else history.reversals[history.onset] / 2


def ratio_after(history, n):
    """p'/p0' at the end of n cycles; not a number of a test that ended before."""
    rows = np.flatnonzero(history.reversals >= 2 * n)
    return history.p[rows[0]] / history.p0 if rows.size else np.nan


def of_halves(column, value=float):
    """Mean over the whole half cycles after the onset."""
    return lambda history: paths.ensemble([value(row[column]) for row in states.half_cycles(history)])[0]


def at_onset(column):
    return lambda history: np.nan if history.onset is None else getattr(history, column)[history.onset]


def strain_after(sign):
    def value(history):
        return np.nan if history.onset is None else (sign * 100 * history.eps_y[history.onset:]).max()
    return value


WAYS = {"e": lambda h: h.e[0], "Z at the start": lambda h: h.Z[0], "cycles to liquefaction": cycles,
        "p'/p0' after 10 cycles": lambda h: ratio_after(h, 10), "p'/p0' at the end": lambda h: h.p[-1] / h.p0}
RATES = {"cycles to liquefaction": cycles, "steps": lambda h: h.step[-1] - h.step[0],
         "I_R at the onset": at_onset("IR"),
         "I_R as p'/p0' first passes 0.01": of_halves("I_R as p'/p0' first passes 0.01"),
         "I_R as it last does": of_halves("I_R as it last does"),
         "least I_R of a half cycle": of_halves("least I_R"),
         "p'/p0' at the most sliding": of_halves("p'/p0' at the most sliding"), "f_R at the onset": at_onset("f_R"),
         "largest strain after, compression (%)": strain_after(1),
         "largest strain after, extension (%)": strain_after(-1)}


def tests_of_paper(tests, way="", rate=0):
    """(packing, history) of cyclic tests at its amplitude and pressure, with specimens made so and tested so fast."""
    return [(run.packing, h) for run, h in tests if run.kind == "cyclic" and run.ratio == plan.PAPER_RATIO
            and run.packing.pressure == plan.P0 and run.packing.way == way and run.rate == rate]


def ways(tests):
    """Of specimens of the density of the paper, by way of making them."""
    rows = []
    for way in plan.WAYS:
        found = [h for packing, h in tests_of_paper(tests, way) if way or packing.relative_density == plan.PAPER[1]]
        if found:
            rows.append(row_of("way", way or "as all others", found, WAYS))
    return rows if len(rows) > 1 else []


def rates(tests):
    """Of one preparation, by strain rate."""
    rows = []
    for rate in (0, *plan.RATES):
        found = [h for packing, h in tests_of_paper(tests, rate=rate) if packing.degrees == plan.RATE_DEGREES]
        if found:
            rows.append(row_of("strain rate (1/s)", f"{rate:g}" if rate else "by inertial number", found, RATES))
    return rows if len(rows) > 1 else []

# SPDX-License-Identifier: BSD-3-Clause
"""What hangs on how specimens are made, and on how fast they are tested: a row for each variant."""
import numpy as np

from paper import plan, states
from speed_error import paths


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


def below_one(history):
    """p'/p0' in the first row, up to the onset, in which I_R is below 1."""
    end = len(history.p) if history.onset is None else history.onset + 1
    rows = np.flatnonzero(history.IR[:end] < 1)
    return history.p[rows[0]] / history.p0 if rows.size else np.nan


def strain_after(sign):
    def value(history):
        return np.nan if history.onset is None else (sign * 100 * history.eps_y[history.onset:]).max()
    return value


WAYS = {"e": lambda h: h.e[0], "Z at the start": lambda h: h.Z[0], "cycles to liquefaction": cycles,
        "p'/p0' after 10 cycles": lambda h: ratio_after(h, 10), "p'/p0' at the end": lambda h: h.p[-1] / h.p0}
PACES = {"cycles to liquefaction": cycles, "steps": lambda h: h.step[-1] - h.step[0],
         "I_R at the onset": at_onset("IR"), "p'/p0' where I_R falls below 1": below_one,
         "I_R as p'/p0' first passes 0.01": of_halves("I_R as p'/p0' first passes 0.01"),
         "I_R as it last does": of_halves("I_R as it last does"),
         "least I_R of a half cycle": of_halves("least I_R"),
         "p'/p0' at the most sliding": of_halves("p'/p0' at the most sliding"),
         "f_R at the onset": at_onset("f_R"),
         "largest strain after, compression (%)": strain_after(1),
         "largest strain after, extension (%)": strain_after(-1)}


def tests_of_paper(tests, way="", pace=""):
    """(run, history) of cyclic tests at its amplitude and pressure, with specimens made so and tested so fast."""
    return [(run, h) for run, h in tests if run.kind == "cyclic" and run.ratio == plan.PAPER_RATIO
            and run.packing.pressure == plan.P0 and run.packing.way == way and run.pace == pace]


def rows_of(variant, found, columns):
    return [{"variant": variant, "seed": run.seed, **{name: value(h) for name, value in columns.items()}}
            for run, h in found]


def ways(tests):
    """A row for each test of a specimen of the density of the paper, by way of making it; none without other ways."""
    rows = []
    for way in plan.WAYS:
        found = [(run, h) for run, h in tests_of_paper(tests, way)
                 if way or run.packing.relative_density == plan.PAPER[1]]
        rows += rows_of(way or "as all others", found, WAYS)
    return rows if len({row["variant"] for row in rows}) > 1 else []


def paces(tests):
    """A row for each test of one preparation, by pace; none without other paces."""
    rows = []
    for pace in plan.PACES:
        found = [(run, h) for run, h in tests_of_paper(tests, pace=pace)
                 if run.packing.degrees == plan.PACE_DEGREES]
        rows += rows_of(pace or "default", found, PACES)
    return rows if len({row["variant"] for row in rows}) > 1 else []


def markdown(rows):
    """Means over the seeds, ± their standard error where there are several, with the number where it is not all."""
    variants = list(dict.fromkeys(row["variant"] for row in rows))
    columns = [name for name in rows[0] if name not in ("variant", "seed")]
    lines = ["| | n | " + " | ".join(columns) + " |", "|---" * (len(columns) + 2) + "|"]
    for variant in variants:
        tests = [row for row in rows if row["variant"] == variant]
        cells = [cell([row[name] for row in tests]) for name in columns]
        lines.append(f"| {variant} | {len(tests)} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def cell(values):
    mean, _, error, n = paths.ensemble(values)
    if n == 0:
        return "–"
    text = f"{mean:.4g}" + (f" ± {error:.2g}" if n > 1 else "")
    return text if n == len(values) else f"{text} ({n} of {len(values)})"

# SPDX-License-Identifier: BSD-3-Clause
"""What depends on how specimens are made, and on how fast they are tested: a row for each variant."""
import numpy as np

from studies.ensembles import ensemble
from studies.paper import plan, states


HALVES = {"I_R as p'/p0' first passes 0.01": "I_R as p'/p0' first passes 0.01",
          "I_R as it last does": "I_R as it last does", "least I_R of a half cycle": "least I_R",
          "p'/p0' at the most sliding": "p'/p0' at the most sliding"}


def ratio_after(history, n):
    """p'/p0' at the end of n cycles; not a number of a test that ended before."""
    rows = np.flatnonzero(history.reversals >= 2 * n)
    return history.p[rows[0]] / history.p0 if rows.size else np.nan


def of_way(history):
    return {"e": history.e[0], "Z at the start": history.Z[0],
            "cycles to liquefaction": states.cyclic_numbers(history)["cycles"],
            "p'/p0' after 10 cycles": ratio_after(history, 10), "p'/p0' at the end": history.p[-1] / history.p0}


def of_pace(history):
    """Of half cycles the mean over the whole ones after the onset."""
    numbers, halves = states.cyclic_numbers(history), states.half_cycles(history)
    strains = [f"largest strain after, {direction} (%)" for direction in ("compression", "extension")]
    return {"cycles to liquefaction": numbers["cycles"], "steps": history.step[-1] - history.step[0],
            "I_R at the onset": numbers["I_R at onset, Eq. 2"],
            "p'/p0' where I_R falls below 1": numbers["p'/p0' where I_R falls below 1, Eq. 2"],
            **{name: ensemble([row[column] for row in halves])[0] for name, column in HALVES.items()},
            "f_R at the onset": np.nan if history.onset is None else history.f_R[history.onset],
            **{name: numbers.get(name, np.nan) for name in strains}}


def tests_of_paper(tests, way="", pace=plan.DEFAULT):
    """(run, history) of cyclic tests at its amplitude and pressure, with specimens made so and tested so fast."""
    return [(run, h) for run, h in tests if run.kind == "cyclic" and run.ratio == plan.PAPER_RATIO
            and run.packing.pressure == plan.P0 and run.packing.way == way and run.pace == pace]


def rows_of(variant, found, numbers):
    return [{"variant": variant, "seed": run.seed, **numbers(h)} for run, h in found]


def ways(tests):
    """A row for each test of a specimen of the density of the paper, by way of making it; none without other ways."""
    rows = []
    for way in plan.WAYS:
        found = [(run, h) for run, h in tests_of_paper(tests, way)
                 if way or run.packing.relative_density == plan.PAPER[1]]
        rows += rows_of(way or "as all others", found, of_way)
    return rows if len({row["variant"] for row in rows}) > 1 else []


def paces(tests):
    """A row for each test of one preparation, by pace; none without other paces."""
    rows = []
    for pace in plan.PACES:
        found = [(run, h) for run, h in tests_of_paper(tests, pace=pace)
                 if run.packing.degrees == plan.PACE_DEGREES]
        rows += rows_of(pace, found, of_pace)
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
    mean, _, error, n = ensemble(values)
    if n == 0:
        return "–"
    text = f"{mean:.4g}" + (f" ± {error:.2g}" if n > 1 else "")
    return text if n == len(values) else f"{text} ({n} of {len(values)})"

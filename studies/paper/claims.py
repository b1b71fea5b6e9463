# SPDX-License-Identifier: BSD-3-Clause
"""Sentences of the paper that can be true or false, each with what the tests say of it."""
import dataclasses
import operator

import numpy as np

from studies.ensembles import ensemble, mean_and_interval
from studies.paper import plan, states

TABLES = ("undrained_states", "cyclic_tests", "half_cycles")  # that they are judged by
MARGIN = 0.2  # of the number of the paper
SURE = 0.9  # share of tests in which a sentence must hold to be called so, and below 1 - SURE to be called wrong


@dataclasses.dataclass(frozen=True)
class Claim:
    """`values(tests)`: one number for each seed, the mean over its tests and their half cycles, because tests of one
    cloud are not independent. `expected`: the number of the paper or the laboratory; None of a sentence that holds (1)
    or does not (0)."""

    text: str
    values: object
    expected: float | None = None
    unit: str = ""
    source: str = "paper"  # of the expected number or sentence; or "laboratory"
    why: str = ""  # the cause of what differs, as far as it is known


def verdict(claim, values):
    """Of a number, by the 95 % interval of its mean: the same if all of it is within the margin of the paper's, higher
    or lower if none of it is. Of a sentence: whether it holds in nearly all tests, in nearly none, or in some."""
    if not values:
        return "not tested"
    mean, half = mean_and_interval(values)
    if claim.expected is None:
        return "holds" if mean >= SURE else "does not hold" if mean <= 1 - SURE else "in some tests"
    away, margin = mean - claim.expected, MARGIN * abs(claim.expected)
    if abs(away) + half <= margin:
        return f"the same within {100 * MARGIN:g} %"
    if abs(away) - half > margin:
        return "ours is higher" if away > 0 else "ours is lower"
    return "undecided"


class Tests:
    """The tables, asked for the numbers of the specimens of the paper."""

    def __init__(self, tables):
        self.tables = tables

    def undrained(self, density, direction, column, young=None):
        label = f"D_r {density:.2f}, {plan.P0} kPa" + (f", E {young:g} GPa" if young else "")
        return [row[column] for row in self.tables["undrained_states"]
                if row["specimen"] == label and row["direction"] == direction]

    def cyclic(self, label):
        return [row for row in self.tables["cyclic_tests"] if row["specimen"] == label and row["pace"] == plan.DEFAULT]

    def paper(self):
        """Cyclic tests at the density of the paper."""
        return self.cyclic(f"D_r {plan.PAPER[1]:.2f}, {plan.P0} kPa")

    def liquefied(self):
        """Cyclic tests that liquefied: the slow ones."""
        return slowest([row for row in self.tables["cyclic_tests"] if np.isfinite(row["cycles"])])

    def halves(self, least=1):
        """Half cycles after the onset of those tests, test by test, where there are enough."""
        tests = {}
        for row in slowest(self.tables["half_cycles"]):
            tests.setdefault((row["specimen"], row["seed"]), []).append(row)
        return [rows for rows in tests.values() if len(rows) >= least]


def slowest(rows):
    """Those of the slow pace, if there are any."""
    return [row for row in rows if row["pace"] == plan.SLOW] or rows


def of_loose(state, column, direction="compression"):
    return lambda t: t.undrained(plan.PAPER[0], direction, f"{state}: {column}")


def by_seed(pairs):
    """Means of the numbers of each seed, from (seed, number); without what is not a number."""
    seeds = {}
    for seed, number in pairs:
        if np.isfinite(number):
            seeds.setdefault(seed, []).append(number)
    return [float(np.mean(numbers)) for numbers in seeds.values()]


def of_liquefied(number):
    """number(row) of the tests that liquefied."""
    return lambda t: by_seed((row["seed"], number(row)) for row in t.liquefied())


def column(name):
    return lambda row: row[name]


def above(one, other):
    """Whether one column is above the other."""
    return lambda row: float(row[one] > row[other])


def sentence(holds, *names):
    """Whether it holds of the numbers in these columns; not a number where one of them is none."""
    def value(row):
        numbers = [row.get(name, np.nan) for name in names]
        return float(holds(*numbers)) if np.isfinite(numbers).all() else np.nan
    return value


def of_halves(number):
    """number(row), averaged over the half cycles of a test in which it is one."""
    return lambda t: by_seed((rows[0]["seed"], ensemble([number(row) for row in rows])[0]) for rows in t.halves())


def correlated(one, other, least):
    """Whether the rank correlation of |one| and |other| over the half cycles of a test is above `least`."""
    def value(rows):
        ranks = [np.argsort(np.argsort([abs(row[name]) for row in rows])) for name in (one, other)]
        return float(np.corrcoef(ranks)[0, 1] > least)
    return lambda t: by_seed((rows[0]["seed"], value(rows)) for rows in t.halves(5))


def of_loose_share(column, number):
    """Whether it is above the number, of tests that have it."""
    return lambda t: [float(v > number) for v in t.undrained(plan.PAPER[0], "compression", column) if np.isfinite(v)]


LEAST, END = "least p': p' (kPa)", "end: p' (kPa)"


def contracts(density):
    """Whether p' falls by more than 5 % and rises again."""
    def value(t):
        least, end = (t.undrained(density, "compression", name) for name in (LEAST, END))
        return [float(low < 0.95 * plan.P0 and last > 1.05 * low) for low, last in zip(least, end)]
    return value


def dilates(density):
    """Whether p' never falls by more than 1 %."""
    return lambda t: [float(p > 0.99 * plan.P0) for p in t.undrained(density, "compression", LEAST)]


PRIME_IR, LAST_IR = "I_R at onset, Eq. 2", "I_R as it last does"
NO_TWIST = "I_R at onset, without twisting"

MONOTONIC = (
    Claim("D_r = 0.30: p' falls before it rises (compression)", contracts(0.30)),
    Claim("D_r = 0.30: q at the instability state", of_loose("instability", "q (kPa)"), 77.9, "kPa", "laboratory",
          why="small loose boxes scatter: with 2,000 grains by a half"),
    Claim("D_r = 0.30: least p'", of_loose("least p'", "p' (kPa)"), 46.4, "kPa", "laboratory",
          why="D_r counts from deposits under gravity, which are looser than packings under 200 kPa: specimens at "
              "0.30 are near the loosest there are, and collapse"),
    Claim("D_r = 0.30: least p' in extension", of_loose("least p'", "p' (kPa)", "extension"), 7.9, "kPa",
          "laboratory",
          why="as in compression"),
    Claim("D_r = 0.30: q/p' at the least p'", of_loose("least p'", "q/p'"), 61.6 / 46.4, source="laboratory",
          why="hardly any stress is left there; see also the next row"),
    Claim("D_r = 0.30: q/p' of the steady state, compression", of_loose("end", "q/p'"), 1.335, source="laboratory",
          why="these contacts are stronger than the sand: drained tests show it, too. No steady state: p' still "
              "rises at 20 %"),
    Claim("D_r = 0.30: q/p' of the steady state, extension", of_loose("end", "q/p'", "extension"), 0.924,
          source="laboratory", why="as in compression"),
    Claim("D_r = 0.64: dilates from the start", dilates(0.64)),
    Claim("D_r = 0.88: dilates from the start", dilates(0.88)),
    Claim("D_r = 0.64: least p'", lambda t: t.undrained(0.64, "compression", "least p': p' (kPa)"), 96.1,
          "kPa", "laboratory",
          why="the paper has the same. It blames friction that is raised after compression"),
    Claim("D_r = 0.88: least p'", lambda t: t.undrained(0.88, "compression", "least p': p' (kPa)"), 143.5,
          "kPa", "laboratory", why="as at 0.64"),
    Claim("D_r = 0.30: the model overestimates q at the instability", of_loose_share("instability: q (kPa)", 77.9),
          why="none of the sizes and ways tried here does"),
    Claim("D_r = 0.30: stiffer than the sand, less strain to the instability",
          lambda t: [1 - v for v in of_loose_share("instability: strain (%)", 0.37)(t)], source="laboratory",
          why="contacts of 10 GPa"))
CYCLIC = (
    Claim("D_r = 0.64: liquefies", lambda t: [float(np.isfinite(row["cycles"])) for row in t.paper()],
          why="a box of this void ratio is dense inside and loose at its walls; packings without walls "
              "liquefy at it"),
    Claim("D_r = 0.64: cycles to liquefaction, of those that liquefy",
          lambda t: [r["cycles"] for r in t.paper() if np.isfinite(r["cycles"])], 17),
    Claim("D_r = 0.64: more cycles than the 11 of the laboratory",
          lambda t: [float(row["cycles applied"] > 11) for row in t.paper()]),
    Claim("Strain before liquefaction", of_liquefied(column("largest strain before (%)")), 0.05, "%",
          why="most of it comes in the last half cycle"),
    Claim("More strain in extension than in compression after the onset",
          of_liquefied(above("largest strain after, extension (%)", "largest strain after, compression (%)")),
          why="not known"),
    Claim("Strain accumulates while q is near zero: more than half of it below q_amp/10, after the onset",
          of_liquefied(sentence(lambda part: part > 0.5, "share of strain at |q| < q_amp/10 after"))),
    Claim("p' comes back in each half cycle after the onset, above 0.01 p0'",
          of_halves(sentence(lambda ratio: ratio > states.LIQUEFIED, "largest p'/p0'"))),
    Claim("I_R above 1 at the start", of_liquefied(lambda row: float(row["IR at the start"] > 1))),
    Claim("I_R varies cyclically before the onset: by more than 5 % within a half cycle, on average",
          of_liquefied(sentence(lambda swing, start: swing > 0.05 * start,
                                "mean range of IR in a half cycle before", "IR at the start"))),
    Claim("I_R decreases before the onset: mean of the last third of the cycles below that of the first",
          of_liquefied(sentence(operator.lt, "mean I_R in the last third", "mean I_R in the first third"))),
    Claim("I_R below 1 at the onset (Eq. 2)", of_liquefied(lambda row: float(row[PRIME_IR] < 1))),
    Claim("I_R below 1 at the onset (without twisting)", of_liquefied(lambda row: float(row[NO_TWIST] < 1))),
    Claim("I_R passes 1 at the onset: p'/p0' where it first does so",
          of_liquefied(column("p'/p0' where I_R falls below 1, Eq. 2")), states.LIQUEFIED,
          why="rate: the slower the test, the nearer"),
    Claim("I_R as p'/p0' comes back above 0.01", of_halves(lambda r: r[LAST_IR]), 1.3, why="rate"),
    Claim("Each reversal after the onset drops I_R, by more than a tenth",
          of_halves(sentence(lambda least, begin: least < 0.9 * begin, "least I_R", "I_R at its beginning"))),
    Claim("Least I_R of a half cycle after the onset", of_halves(lambda r: r["least I_R"]), 0.35),
    Claim("More contacts slide than roll, before", of_liquefied(above("f_S before", "f_R before"))),
    Claim("More contacts slide than roll, after", of_liquefied(above("f_S after", "f_R after"))),
    Claim("More contacts slide and roll at once than roll only, after", of_liquefied(above("f_SR after", "f_R after"))),
    Claim("The sliding fraction swings more than the rolling one before the onset",
          of_liquefied(sentence(operator.gt, "mean range of f_S in a half cycle before",
                                "mean range of f_R in a half cycle before"))),
    Claim("More contacts roll after the onset than before", of_liquefied(above("f_R after", "f_R before")),
          why="rolling alone is rare on average, 1 to 2 % of contacts, 3 to 8 % at the onset"),
    Claim("The sliding fraction is largest where p'/p0' passes 0.01",
          of_halves(lambda r: r["p'/p0' at the most sliding"]), states.LIQUEFIED,
          why="rate"),
    Claim("The sliding fraction falls afterwards, by 5 % or more to the end of the half cycle",
          of_halves(lambda r: float(r["f_S at its end"] < 0.95 * r["largest f_S"])),
          why="it is largest late in the half cycle, or at its end"),
    Claim("F_xx and F_zz evolve alike: largest difference below a tenth of the largest anisotropy, before",
          of_liquefied(lambda row: float(row["largest |F_xx - F_zz| before"] < 0.1 * row["largest |F_yx| before"])),
          why="N grains have some 2 N contacts: the fabric scatters by 0.02 with 2,000 grains, 0.01 with 10,000"),
    Claim("Anisotropy grows before the onset: last third of the cycles above the first",
          of_liquefied(above("largest |F_yx| in the last third", "largest |F_yx| in the first third"))),
    Claim("Anisotropy is larger after the onset than before",
          of_liquefied(above("largest |F_yx| after", "largest |F_yx| before"))),
    Claim("Contacts turn with the load: F_yy - F_xx has its sign at the end of a half cycle",
          of_halves(lambda r: float((r["F_yx at its end"] > 0) == (r["direction"] == "compression")))),
    Claim("Anisotropy changes its sign where I_R is below 1",
          of_halves(sentence(lambda index: index < 1, "I_R as F_yx changes sign"))),
    Claim("High redundancy goes with uniform contacts: I_R and anisotropy correlate negatively, after",
          of_liquefied(sentence(lambda correlation: correlation < 0, "correlation of I_R and |F_yx| after"))),
    Claim("Anisotropy falls as the network forms again: less at the end of a half cycle than at its largest",
          of_halves(lambda r: float(abs(r["F_yx at its end"]) < 0.95 * r["largest |F_yx|"]))),
    Claim("Anisotropy grows with the half cycles after the onset (rank correlation > 0)",
          correlated("half cycle", "F_yx at its end", 0)),
    Claim("Anisotropy depends on the strain of the half cycle (rank correlation > 0.5)",
          correlated("strain travelled (%)", "F_yx at its end", 0.5)))


CLAIMS = MONOTONIC + CYCLIC


def table(tables):
    """Rows of claims.csv: of all that was tested."""
    tests, rows = Tests(tables), []
    for claim in CLAIMS:
        values = [v for v in claim.values(tests) if np.isfinite(v)]
        mean, _, error, n = ensemble(values)
        if n:
            rows.append({"claim": claim.text, "expected": "" if claim.expected is None else claim.expected,
                         "by": claim.source, "unit": claim.unit if claim.expected is not None else "share of tests",
                         "ours": mean, "standard error": error, "n": n, "verdict": verdict(claim, values)})
    return rows


HEADER = """Which statements of the paper hold, and which do not? Of slow tests, at a tenth of the default rate;
n is the number of seeds. A statement that holds in 3 of 3 seeds holds in at least 29 % of
specimens, in 5 of 5 in at least 48 % (95 %). Tests of 10,000 grains are of 25 November 2026, not run again since.

"""


def markdown(sizes):
    """The table for people, of {size: its rows}, with the causes."""
    found = {size: {row["claim"]: row for row in rows} for size, rows in sizes.items() if rows}
    lines = ["| claim | paper | laboratory | " + "".join(f"{size} | n | verdict | " for size in found) + "why |",
             "|---|---|---|" + "---|---|---|" * len(found) + "---|"]
    for claim in CLAIMS:
        rows = [of_size.get(claim.text) for of_size in found.values()]
        if any(rows):
            lines.append(f"| {claim.text} | {expected_by(next(filter(None, rows)))} | "
                         + "".join(f"{measured(row)} | " for row in rows) + f"{claim.why} |")
    return HEADER + "\n".join(lines) + "\n"


def expected_by(row):
    """The cells of paper and laboratory."""
    number = "yes" if row["unit"] == "share of tests" else f"{row['expected']:.3g}{unit_of(row)}"
    return f"{number} | " if row["by"] == "paper" else f" | {number}"


def unit_of(row):
    """With a blank before it; nothing where the table has an empty cell."""
    return f" {row['unit']}" if isinstance(row["unit"], str) and row["unit"] else ""


def measured(row):
    """The cells of one size; empty where it was not tested."""
    if row is None:
        return " |  | "
    ours = (f"in {100 * row['ours']:.0f} %" if row["unit"] == "share of tests" else
            f"{row['ours']:.3g} ± {row['standard error']:.2g}{unit_of(row)}")
    return f"{ours} | {row['n']} | {row['verdict']}"

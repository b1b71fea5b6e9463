# SPDX-License-Identifier: BSD-3-Clause
"""Gathers the tests that are done into tables: a row for each test, and curves as mean and standard deviation."""
import numpy as np

from studies.ensembles import ensemble
from studies.history import History
from studies.paper import lab, plan, states
from studies.tables import number, read_csv

STRAINS = np.concatenate([np.arange(0, 0.1, 0.001), np.arange(0.1, 0.5, 0.01), np.arange(0.5, 20.01, 0.1)])  # %
PHASED = (*states.COUNTS, *states.FRACTIONS, "Fxx", "Fyy", "Fzz", "F_yx", "F_yz")
PAPER_CYCLES = 17
UNDRAINED = ("strain (%)", "p' (kPa)", "q (kPa)", "q/p'")


def identity(run, history):
    """What a row begins with."""
    e = history.e[0]
    return {"specimen": run.packing.label, "grains": run.packing.grains, "seed": run.seed, "e": e,
            "D_r (paper's limits)": relative_density(e, plan.PAPER_LIMITS),
            "D_r (limits of its scene)": relative_density(e, run.packing.limits)}


def relative_density(e, limits):
    return (limits[1] - e) / (limits[1] - limits[0])


def history_of(run, folder):
    """The history; that of a cyclic test with the redundancy index that counts walls."""
    history = History(folder)
    if run.kind == "cyclic":
        history.IR_walls = states.redundancy_with_walls(history, run.packing.grains)
    return history


class Results:
    def __init__(self, store, runs):
        self.tests = [(run, history_of(run, store.folder(run))) for run in runs
                      if run.kind != "prepare" and store.is_done(run)]

    def of(self, *kinds):
        return [(run, history) for run, history in self.tests if run.kind in kinds]

    def groups(self, *kinds):
        """Tests that differ in their seed alone."""
        found = {}
        for run, history in self.of(*kinds):
            found.setdefault((run.kind, run.packing.label, run.pace), []).append((run, history))
        return found

    def tables(self):
        return {"undrained_states": self.undrained_states(), "undrained_curves": self.undrained_curves(),
                  "drained_states": self.drained_states(), "drained_curves": self.drained_curves(),
                  "cyclic_tests": self.cyclic_tests(), "half_cycles": self.half_cycles(),
                  "cyclic_curves": self.cyclic_curves(), "cyclic_path": self.cyclic_path()}

    def undrained_states(self):
        rows = []
        for run, history in self.of("compression", "extension"):
            row = {"direction": run.kind, **identity(run, history)}
            for state, numbers in states.undrained_numbers(history).items():
                row.update({f"{state}: {name}": value for name, value in zip(UNDRAINED, numbers)})
            strain = np.maximum.accumulate(np.abs(history.eps_y))
            for name, column in (("p'", history.p), ("q", np.abs(history.q))):
                row[f"{name} at 3 % (kPa)"] = np.interp(0.03, strain, column, right=np.nan) / 1e3
            rows.append(row)
        return rows

    def undrained_curves(self):
        return curves(self.groups("compression", "extension"),
                      lambda h: np.array([h.p, np.abs(h.q)]) / 1e3, ("p' (kPa)", "q (kPa)"))

    def drained_states(self):
        rows = []
        for run, h in self.of("drained"):
            volume = h.eps_x + h.eps_y + h.eps_z
            axial, radial = h.p + 2 * h.q / 3, h.p - h.q / 3
            rows.append({**identity(run, h), "laboratory test": "",
                         **states.drained_numbers(h.eps_y, volume, axial, radial)})
        end = max((h.eps_y[-1] for _, h in self.of("drained")), default=0)
        for test in (test.until(end) for test in lab.drained_tests() if rows):
            rows.append({"specimen": f"laboratory, {test.pressure:g} kPa", "e": test.void_ratio,
                         "D_r (limits of its scene)": test.relative_density, "laboratory test": test.name,
                         **states.drained_numbers(test.strain, test.volume_strain, test.axial, test.radial)})
        return rows

    def drained_curves(self):
        return curves(self.groups("drained"),
                      lambda h: np.array([h.q / 1e3, 100 * (h.eps_x + h.eps_y + h.eps_z)]), ("q (kPa)", "eps_v (%)"))

    def cyclic_tests(self):
        rows = []
        for run, history in self.of("cyclic"):
            row = {**identity(run, history), "pace": run.pace, "steps": history.step[-1] - history.step[0],
                   **states.cyclic_numbers(history)}
            rows.append(row)
        return rows

    def half_cycles(self):
        return [{"specimen": run.packing.label, "pace": run.pace, "seed": run.seed, "half cycle": k + 1, **row}
                for run, history in self.of("cyclic") for k, row in enumerate(states.half_cycles(history))]

    def cyclic_curves(self):
        """Of slow tests: means over the seeds that liquefy, on the axis of states.phases()."""
        rows = []
        for (_, label, pace), tests in self.groups("cyclic").items():
            found = [(history, states.phases(history)) for _, history in tests if history.onset is not None]
            if pace != plan.SLOW or not found:
                continue
            for k, (x, _) in enumerate(min((axis for _, axis in found), key=len)):
                row = {"specimen": label, "pace": pace, "phase": x, "seeds": len(found)}
                for column in ("p'/p0'", *PHASED):
                    row.update(phase_numbers(column, [(history, axis[k][1]) for history, axis in found]))
                rows.append(row)
        return rows

    def cyclic_path(self):
        """Of the slow test that takes nearest to the 17 cycles of the paper; rows between which p' changes by 1 % of
        p0', q by 4 kPa or strain by 0.01 %, and the reversals."""
        found = [(run, h) for run, h in self.of("cyclic") if run.looks_behind_onset and h.onset is not None]
        if not found:
            return []
        run, h = min(found, key=lambda test: abs(test[1].reversals[test[1].onset] / 2 - PAPER_CYCLES))
        rows, last, reversals = [], np.full(3, -np.inf), set(h.reversal_rows)
        for k in range(len(h.p)):
            here = np.array([h.p[k] / (0.01 * h.p0), h.q[k] / 4e3, h.eps_y[k] / 1e-4])
            if k in reversals or np.abs(here - last).max() >= 1:
                last = here
                rows.append({"specimen": run.packing.label, "pace": run.pace, "seed": run.seed,
                             "p' (kPa)": h.p[k] / 1e3,
                             "q (kPa)": h.q[k] / 1e3, "eps_1 (%)": 100 * h.eps_y[k]})
        return rows


def phase_numbers(column, found):
    """Mean and standard deviation over the seeds, and the means of their least and largest value, in rows of one phase;
    of p'/p0' those of its logarithm, and of fabric where enough contacts carry."""
    logarithmic = column == "p'/p0'"
    seeds = []  # mean, least and largest value of each
    for history, rows in found:
        ratio = history.p[rows] / history.p0
        values = np.log(np.maximum(ratio, 1e-9)) if logarithmic else getattr(history, column)[rows]
        values = values[ratio > states.FABRIC_FLOOR] if column.startswith("F") else values
        if values.size:
            seeds.append((values.mean(), values.min(), values.max()))
    if len(seeds) < max(1, len(found) / 2):
        return dict.fromkeys((column, f"{column} low", f"{column} high"), np.nan)
    means, lows, highs = zip(*seeds)
    mean, deviation, *_ = ensemble(means)
    back = np.exp if logarithmic else float
    return {column: back(mean), f"{column} s.d. of ln" if logarithmic else f"{column} s.d.": deviation,
            f"{column} low": back(np.mean(lows)), f"{column} high": back(np.mean(highs))}


def curves(groups, values, names):
    """Mean and standard deviation at equal |axial strain|, to the strain that all seeds reach."""
    rows = []
    for (kind, label, _), tests in groups.items():
        end = min(100 * np.abs(history.eps_y[-1]) for _, history in tests)
        grid = STRAINS[STRAINS <= end * (1 + 1e-9)]
        found = []
        for _, history in tests:
            order = np.maximum.accumulate(100 * np.abs(history.eps_y))
            found.append([np.interp(grid, order, column) for column in values(history)])
        found = np.array(found)  # seeds, columns, strains
        for k, strain in enumerate(grid):
            row = {"test": kind, "specimen": label, "seeds": len(tests), "|eps_1| (%)": strain}
            for column, name in enumerate(names):
                row[name], row[f"{name} s.d."], *_ = ensemble(found[:, column, k])
            rows.append(row)
    return rows


# Tables whose rows stand for themselves
ADDED = ("undrained_states", "undrained_curves", "drained_states", "drained_curves", "cyclic_tests", "half_cycles",
         "cyclic_curves")
# Columns of which two rows of one test or curve differ in none
TEST = ("test", "direction", "specimen", "grains", "seed", "pace", "laboratory test")


def merged(path, rows):
    """These rows behind those of the existing table, except for the tests and curves that are in `rows`."""
    before = read_csv(path)
    new = {test_of(row) for row in rows}
    return [row for row in before if test_of(row) not in new] + rows


def test_of(row):
    """To which test or curve a row belongs."""
    return tuple(str(number(row.get(name, ""))) for name in TEST)

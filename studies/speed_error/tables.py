# SPDX-License-Identifier: BSD-3-Clause
"""Gathers the runs that are done: one row per setting and kind of specimen, its errors next to its cost."""
import collections
import warnings

import numpy as np

import isostat
from studies.ensembles import mean_and_error, mean_and_interval
from studies.history import History
from studies.speed_error import plan

REVERSALS = 10  # up to here paths are compared
STRAINS = (0.001, 0.002, 0.005)  # of monotonic tests
MARGINS = (1e-9, 1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3)  # of the yield test
NOT_CONVERGED = 1.0  # % of p0': specimens farther from the finest path are listed


def half_cycles(history):
    """(q, p'/p0') of the rows of each half cycle, q monotonic along the load; None if the test ends before the last."""
    ends = history.reversal_rows
    if len(ends) < REVERSALS:
        return None
    rows = [slice(begin, end + 1) for begin, end in zip([0, *ends], ends[:REVERSALS])]
    return [(np.maximum.accumulate((-1) ** k * history.q[part]), history.p[part] / history.p0)
            for k, part in enumerate(rows)]


def distance(path, reference):
    """Largest difference in p'/p0' at equal q, at the rows of the one that has fewer: between its states in balance a
    static test says nothing."""
    pairs = [sorted(pair, key=lambda half: len(half[0])) for pair in zip(path, reference)]
    return max(np.abs(p - np.interp(q, *finer)).max() for (q, p), finer in pairs)


def one_way_distance(history, reference, strain):
    """The same in the p'-q plane at equal strain, at the rows of the one that has fewer."""
    tracks = [(h.eps_y[h.eps_y <= strain], h) for h in (history, reference)]
    at = min((strains for strains, _ in tracks), key=len)
    return np.hypot(*(np.subtract(*(np.interp(at, h.eps_y, getattr(h, name)) for _, h in tracks))
                      for name in ("p", "q"))).max() / history.p0


class Cyclic:
    """What one cyclic test says. Steps are time steps, or evaluations of all forces where it is static."""

    def __init__(self, history, cpu, to_the_onset):
        steps = history.step - history.step[0]
        self.path = half_cycles(history)
        self.path_steps = steps[history.reversal_rows[REVERSALS - 1]] if self.path is not None else np.nan
        self.milliseconds = 1e3 * cpu / steps[-1]
        self.cycles = self.steps = np.nan
        self.before, self.after = (np.nan, np.nan), (np.nan, np.nan)  # p'/p0' and I_R of the rows about the onset
        onset = history.onset
        if to_the_onset and onset is not None:
            self.cycles, self.steps = history.reversals[onset] / 2, steps[onset]
            self.before, self.after = ((history.p[row] / history.p0, history.IR[row]) for row in (onset - 1, onset))


def indices_by_margin(folder):
    """I_R for each margin at reversal 10 and at the last one before the onset, and p'/p0' there. Snapshot k of a test
    whose only stage is cyclic is that of reversal k, 0 of its start."""
    history = History(folder)
    results = isostat.read(folder)
    found = {}
    for place, number in (("reversal 10", REVERSALS), ("last reversal", int(history.reversals[history.onset]))):
        packing = results.packing(number)
        found[place] = [packing.measures()["p"] / history.p0,
                        *(packing.network(yield_margin=margin)["redundancy_index"] for margin in MARGINS)]
    return found


class Results:
    def __init__(self, store, runs):
        done = [run for run in runs if run.kind != "prepare" and store.is_done(run)]
        self.cyclic = collections.defaultdict(dict)  # by packing, grains and setting, then by seed
        self.monotonic = collections.defaultdict(dict)  # by setting, then by seed
        self.networks = collections.defaultdict(dict)  # by packing and setting, then by seed
        for run in done:
            if run.kind == "network":
                self.networks[run.packing, run.setting][run.seed] = indices_by_margin(store.folder(run))
                continue
            history, cpu = History(store.folder(run)), store.cpu_seconds(run)
            if run.kind == "monotonic":
                self.monotonic[run.setting][run.seed] = history, cpu
            else:
                self.cyclic[run.packing, run.grains, run.setting][run.seed] = Cyclic(history, cpu, run.kind == "cyclic")

    def tables(self):
        return {"path": self.path_table(), "cycles": self.cycles_table(), "monotonic": self.monotonic_table(),
                "not_converged": self.not_converged(), "margins": self.margins_table()}

    def keys(self):
        """Kinds of specimens in the order of the plan, settings by cost."""
        def cost(key):
            return np.nanmean([test.path_steps for test in self.cyclic[key].values()])

        kinds = list(dict.fromkeys(key[:2] for key in self.cyclic))
        return sorted(self.cyclic, key=lambda key: (kinds.index(key[:2]), cost(key)))

    def pairs(self, key, setting):
        """Tests of a key and of another setting on the same specimens, by seed."""
        others = self.cyclic.get((*key[:2], setting), {})
        return {seed: (test, others[seed]) for seed, test in self.cyclic[key].items() if seed in others}

    def distances(self, key):
        """Largest distance of the path to reversal 10 from the finest one, % of p0', by seed."""
        return {seed: 100 * distance(test.path, finest.path) for seed, (test, finest) in
                self.pairs(key, plan.FINEST).items() if test.path and finest.path}

    def path_table(self):
        rows = []
        for key in self.keys():
            found = list(self.distances(key).values())
            tests = self.cyclic[key].values()
            if found and key[2] != plan.FINEST:
                rows.append([key[0], key[1], key[2].label, len(found), np.median(found),
                             *mean_and_error(found), np.max(found), np.nanmean([t.path_steps for t in tests]),
                             np.nanmean([t.path_steps * t.milliseconds / 1e3 for t in tests])])
        return ["specimens", "grains", "setting", "seeds", "median distance to the finest path (% of p0')", "mean",
                "standard error", "largest", "steps to reversal 10", "CPU time to there (s)"], rows

    def cycles_table(self):
        rows = []
        for key in self.keys():
            tests = [t for t in self.cyclic[key].values() if np.isfinite(t.cycles)]
            if not tests:
                continue
            difference = [a.cycles - b.cycles for a, b in self.pairs(key, plan.STATIC).values()]
            rows.append([key[0], key[1], key[2].label, len(tests), *mean_and_error([t.cycles for t in tests]),
                         *mean_and_interval(difference), np.mean([t.steps for t in tests]),
                         np.max([t.steps for t in tests]), np.mean([t.steps * t.milliseconds / 1e3 for t in tests]),
                         *mean_and_error([t.before[0] for t in tests]),
                         *mean_and_error([t.before[1] for t in tests]), np.mean([t.after[1] for t in tests])])
        return ["specimens", "grains", "setting", "seeds", "cycles to liquefaction", "standard error",
                "less those of the static default", "half 95 % interval", "steps to the onset", "most steps",
                "CPU time to there (s)", "p'/p0' before the onset", "standard error", "I_R before the onset",
                "standard error", "I_R at the onset"], rows

    def monotonic_table(self):
        rows = []
        finest = self.monotonic[plan.TIGHT]
        for setting, tests in self.monotonic.items():
            for strain in STRAINS:
                found = [100 * one_way_distance(history, finest[seed][0], strain)
                         for seed, (history, _) in tests.items() if seed in finest]
                rows.append([setting.label, f"{100 * strain:g}", len(found), np.median(found),
                             *mean_and_error(found),
                             *mean_and_error([np.interp(strain, h.eps_y, h.p) / h.p0 for h, _ in tests.values()]),
                             np.mean([h.step[-1] - h.step[0] for h, _ in tests.values()]),
                             np.mean([cpu for _, cpu in tests.values()])])
        return ["setting", "axial strain (%)", "seeds", "median distance to the tight static path (% of p0')", "mean",
                "standard error", "p'/p0' there", "standard error", "steps of the test, to 0.5 %", "CPU time (s)"], rows

    def margins_table(self):
        """I_R by margin, and less that of the static default on the same specimens."""
        rows = []
        for (packing, setting), tests in self.networks.items():
            static = self.networks.get((packing, plan.STATIC), {})
            for place in ("reversal 10", "last reversal"):
                p_ratio = mean_and_error([test[place][0] for test in tests.values()])
                for k, margin in enumerate(MARGINS, 1):
                    values = [test[place][k] for test in tests.values()]
                    less = [test[place][k] - static[seed][place][k] for seed, test in tests.items() if seed in static]
                    rows.append([packing, setting.label, place, len(tests), *p_ratio, margin, *mean_and_error(values),
                                 *mean_and_interval(less)])
        return ["specimens", "setting", "at", "seeds", "p'/p0'", "standard error", "margin", "I_R", "standard error",
                "less that of the static default", "half 95 % interval"], rows

    def not_converged(self):
        rows = [[key[0], key[1], key[2].label, seed, far] for key in self.keys() if key[2] in
                (plan.STATIC, plan.TIGHT) for seed, far in self.distances(key).items() if far > NOT_CONVERGED]
        return ["specimens", "grains", "setting", "seed", "distance to the finest path (% of p0')"], rows


warnings.filterwarnings("ignore", "Mean of empty slice")  # of tests that ended before reversal 10

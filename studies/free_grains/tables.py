# SPDX-License-Identifier: BSD-3-Clause
"""Gathers the runs that are done: one table for each question, written as CSV."""
import numpy as np

from studies.ensembles import ensemble, mean_and_interval
from studies.free_grains import plan
from studies.history import History

REVERSALS = (2, 4, 6, 8, 10, 12, 14, 16)
Q_GRID = np.arange(-58e3, 58.1e3, 1e3)  # Pa; the ends, where walls brake, are in the reversal itself
STRAIN_SPACING = 1e-5


def cyclic_path(history, n_reversals):
    """p'/p0' of the first half cycles at equal q and at the reversals, point by point; None if the test ended before.

    Half cycle k runs from reversal k to reversal k + 1. There q is made monotonic by its running maximum along the
    direction of loading; p' is interpolated linearly on Q_GRID (the first half cycle from 0) and at the reversal.
    """
    ends = history.reversal_rows
    if len(ends) < n_reversals:
        return None
    points = []
    begin, direction = 0, 1
    for k in range(n_reversals):
        rows = slice(begin, ends[k] + 1)
        q = np.maximum.accumulate(direction * history.q[rows])
        p = history.p[rows]
        grid = Q_GRID[Q_GRID >= 1e3] if k == 0 else Q_GRID
        points.append(np.interp(grid, q, p))
        points.append(p[-1:])
        begin, direction = ends[k], -direction
    return np.concatenate(points) / history.p0


def monotonic_path(history, strain):
    """p'/p0' and q/p0' at equal axial strain from 0 to `strain`, shape (2, points); None if the test ended before."""
    if history.eps_y[-1] < strain * (1 - 1e-3):
        return None
    grid = np.linspace(0, strain, round(strain / STRAIN_SPACING) + 1)
    order = np.maximum.accumulate(history.eps_y)
    return np.array([np.interp(grid, order, column) for column in (history.p, history.q)]) / history.p0


def deviation(path, reference):
    """Distance from the reference in the p'-q plane, over p0', point by point: its root mean square and its largest."""
    if path is None or reference is None:
        return None
    difference = path - reference
    distance = np.abs(difference) if difference.ndim == 1 else np.hypot(*difference)
    return float(np.sqrt(np.mean(distance**2))), float(distance.max())


class Cyclic:
    """What one cyclic test says."""

    def __init__(self, history):
        onset = history.onset
        rows = history.reversal_rows
        self.cycles = history.reversals[onset] / 2 if onset is not None else np.nan
        self.redundancy = history.IR[onset] if onset is not None else np.nan
        self.steps = history.step[onset if onset is not None else -1] - history.step[0]
        # not of the last two reversals before the onset: there p' falls by tens of kPa in a half cycle
        last = history.reversals[onset] - 2 if onset is not None else len(rows)
        self.p = np.array([history.p[rows[k - 1]] / 1e3 if k <= last else np.nan for k in REVERSALS])
        self.path = cyclic_path(history, 10)


class Results:
    def __init__(self, store, runs):
        self.store = store
        self.runs = [run for run in runs if run.kind != "prepare" and store.is_done(run)]
        self.cyclic = {}
        for run in self.runs:
            if run.kind == "cyclic":
                self.cyclic.setdefault((run.packing, run.grains, run.setting), {})[run.seed] = Cyclic(
                    History(store.folder(run)))

    def of(self, kind):
        return [run for run in self.runs if run.kind == kind]

    def tables(self):
        return {"cycles": self.cycles_table(), "path": self.path_table(),
                "monotonic": self.monotonic_table(), "hold": self.hold_table(),
                "liquefied": self.liquefied_table(), "early": self.early_table()}

    def differences(self, key, reference, value, seeds=None):
        """value(test) less that of the reference, seed by seed where both are there; of `seeds` alone if given."""
        tests, others = self.cyclic[key], self.cyclic.get(reference, {})
        return [value(tests[s]) - value(others[s]) for s in tests if s in others and (not seeds or s in seeds)]

    def path_distances(self, key, reference):
        """Largest distance of the cyclic path to reversal 10 from that of the reference, % of p0', seed by seed."""
        tests, others = self.cyclic[key], self.cyclic.get(reference, {})
        found = [deviation(tests[s].path, others[s].path) for s in tests if s in others]
        return [100 * d[1] for d in found if d]

    def cycles_table(self):
        header = ["domain", "grains", "setting", "seeds", "liquefied", "cycles", "standard error",
                  "cycles less those of the default", "half 95 % interval", "cycles less those at rate / 10",
                  "half 95 % interval of these", "steps to the onset", "I_R at onset"]
        header += [f"p' at reversal {k} less that of the default (kPa)" for k in REVERSALS]
        header += [f"half 95 % interval at {k}" for k in REVERSALS]
        rows = []
        for key, tests in self.cyclic.items():
            domain, grains, setting = key
            reference, slow = (domain, grains, plan.DEFAULT), (domain, grains, plan.SLOW)
            cycles = [t.cycles for t in tests.values() if np.isfinite(t.cycles)]
            stress = np.array([d for d in self.differences(key, reference, lambda t: t.p)])
            rows.append([domain, grains, setting.label, len(tests), len(cycles), np.mean(cycles),
                         ensemble(cycles)[2],
                         *mean_and_interval(self.differences(key, reference, lambda t: t.cycles)),
                         *mean_and_interval(self.differences(key, slow, lambda t: t.cycles)),
                         np.mean([t.steps for t in tests.values()]),
                         np.nanmean([t.redundancy for t in tests.values()]), *np.nanmean(stress, axis=0),
                         *[mean_and_interval(column)[1] for column in stress.T]])
        return header, rows

    def path_table(self):
        """Largest distance in the p'-q plane over p0', of the cyclic path to reversal 10."""
        rows = []
        for domain, grains, setting in self.cyclic:
            for reference in (plan.SLOW, plan.SLOWEST, *([plan.LARGE[1]] if grains == plan.MANY else [])):
                found = self.path_distances((domain, grains, setting), (domain, grains, reference))
                if found and setting is not reference:
                    rows.append(["cyclic to reversal 10", domain, grains, setting.label, reference.label, len(found),
                                 np.mean(found), ensemble(found)[2], np.median(found), np.max(found)])
        return ["path", "domain", "grains", "setting", "reference", "seeds", "largest distance (% of p0')",
                "standard error", "median", "largest of a specimen"], rows

    def early_table(self):
        """p' at the end of the first cycle, less that of the default, of specimens brought to rest before it."""
        p = {(run.domain, run.setting, run.seed): self.end_of_first_cycle(run) for run in self.of("early")}
        rows = []
        for domain, setting in dict.fromkeys((domain, setting) for domain, setting, _ in p):
            found = [p[domain, setting, s] - p[domain, plan.DEFAULT, s] for d, other, s in p
                     if (d, other) == (domain, setting) and (domain, plan.DEFAULT, s) in p]
            if setting is not plan.DEFAULT and found:
                rows.append([domain, setting.label, len(found), *mean_and_interval(found), np.median(found),
                             np.min(found), np.max(found)])
        return ["domain", "setting", "seeds", "p' at reversal 2 less that of the default (kPa)", "half 95 % interval",
                "median", "least", "largest"], rows

    def end_of_first_cycle(self, run):
        history = History(self.store.folder(run))
        return history.p[history.reversal_rows[1]] / 1e3

    def monotonic_table(self):
        """At each strain p' less that of the slow test, and the largest distance of the path up to it; over p0'."""
        histories = {(run.setting, run.seed): History(self.store.folder(run)) for run in self.of("monotonic")}
        *settings, reference = plan.ONE_WAY
        rows = []
        for setting in settings:
            for strain in (0.001, 0.002, 0.003, 0.004, 0.005):
                pairs = [[monotonic_path(histories[key], strain) for key in ((setting, s), (reference, s))]
                         for (some, s) in histories if some == setting and (reference, s) in histories]
                pairs = [pair for pair in pairs if all(path is not None for path in pair)]
                if pairs:
                    signed = mean_and_interval([100 * (test[0, -1] - slow[0, -1]) for test, slow in pairs])
                    distances = [100 * deviation(*pair)[1] for pair in pairs]
                    rows.append([setting.label, reference.label, len(pairs), f"{100 * strain:g}", *signed,
                                 np.mean(distances), ensemble(distances)[2]])
        return ["setting", "reference", "seeds", "axial strain (%)", "p' less that of the reference (% of p0')",
                "half 95 % interval", "largest distance of the path (% of p0')", "standard error"], rows

    def held(self, run):
        """Steps since loading stopped, p' lost (kPa), kinetic energy (J), unbalanced-force ratio; p' at first (kPa)."""
        h = History(self.store.folder(run))
        rows = np.flatnonzero(h.stage == h.stage[-1])
        return (h.step[rows] - h.step[rows[0]], (h.p[rows[0]] - h.p[rows]) / 1e3, h.E_kin[rows], h.unbalanced[rows],
                h.p[rows[0]] / 1e3)

    def hold_table(self):
        rows = []
        for run in self.of("hold") + self.of("hold-late"):
            steps, lost, energy, unbalanced, p = self.held(run)
            late = min(np.searchsorted(steps, 10_000), len(steps) - 1)  # a hold ends when all is at rest
            rows.append(["after liquefaction" if run.kind == "hold-late" else "after 5 cycles", run.domain,
                         run.setting.label, run.seed, p, lost[late], unbalanced[late], lost[-1], unbalanced[-1],
                         energy[-1]])
        return ["held", "domain", "setting", "seed", "p' when loading stopped (kPa)", "p' lost in 1e4 steps (kPa)",
                "unbalanced force after 1e4 steps", "p' lost in 1e5 steps (kPa)", "unbalanced force after 1e5 steps",
                "kinetic energy after 1e5 steps (J)"], rows

    def liquefied_table(self):
        """Means over specimens; what lies between the onset and the last reversal counts by the strain travelled."""
        header = ["setting", "seeds", "steps per 1 % of strain", "I_R, least of a half cycle", "I_R", "Z", "Z_m",
                  "share of sliding contacts", "share of rolling contacts", "strain travelled (%)"]
        rows = []
        for setting in (plan.DEFAULT, plan.SLOW):
            found = [liquefied(History(self.store.folder(run))) for run in self.of("liquefied")
                     if run.setting == setting]
            found = [f for f in found if f]
            if found:
                rows.append([setting.label, len(found), *np.mean(found, axis=0)])
        return header, rows


def liquefied(history):
    onset = history.onset
    if onset is None:
        return None
    after = slice(onset, None)
    travelled = np.abs(np.gradient(history.eps_y[after])) + 1e-15
    strain = np.abs(np.diff(history.eps_y[after])).sum()
    ends = [row for row in history.reversal_rows if row >= onset]
    least = [history.IR[a:b].min() for a, b in zip(ends, ends[1:])]

    def mean(column):
        return np.average(column[after], weights=travelled)

    return [(history.step[-1] - history.step[onset]) / strain / 100, np.mean(least), mean(history.IR), mean(history.Z),
            mean(history.Zm), mean(history.f_S), mean(history.f_R), 100 * strain]

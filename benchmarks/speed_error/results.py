# SPDX-License-Identifier: BSD-3-Clause
"""Gathers the runs that are done into one row per setting: errors, ensembles, cost."""
import collections
import dataclasses

import numpy as np

from speed_error import paths
from speed_error.plan import SLOW


@dataclasses.dataclass
class Row:
    """One setting over its realisations. Errors are over p0'; lists have one value per realisation."""

    setting: object
    early: list = dataclasses.field(default_factory=list)  # (rms, largest) of the cyclic path
    longer: list = dataclasses.field(default_factory=list)
    monotonic: list = dataclasses.field(default_factory=list)
    monotonic_longer: list = dataclasses.field(default_factory=list)
    last_stress: list = dataclasses.field(default_factory=list)  # p'/p0' at the end of the monotonic test
    cycles: dict = dataclasses.field(default_factory=dict)  # by seed; only those that liquefied
    redundancy: dict = dataclasses.field(default_factory=dict)
    n_tests: int = 0  # cyclic tests done
    short: dict = dataclasses.field(default_factory=lambda: {"early": 0, "longer": 0})  # ... that ended before
    figures: list = dataclasses.field(default_factory=list)  # paths.cyclic_figures
    cpu: list = dataclasses.field(default_factory=list)  # of the cyclic test, s
    wall: list = dataclasses.field(default_factory=list)
    monotonic_steps: list = dataclasses.field(default_factory=list)
    monotonic_cpu: list = dataclasses.field(default_factory=list)
    early_paths: dict = dataclasses.field(default_factory=dict)
    longer_paths: dict = dataclasses.field(default_factory=dict)

    @property
    def family(self):
        return self.setting.family

    def mean(self, name):
        """Mean over realisations of a figure of the cyclic test; not a number if none has it."""
        return paths.ensemble([f.get(name) for f in self.figures])[0]

    def error(self, window="early", which=1):
        """Ensemble of the error of a window: which = 0 root mean square, 1 largest; short tests count as infinite."""
        values = [e[which] for e in getattr(self, window)]
        if self.short.get(window):
            return float("inf"), float("nan"), float("nan"), len(values)
        return paths.ensemble(values)

    @property
    def all_liquefied(self):
        return self.n_tests > 0 and len(self.cycles) == self.n_tests

    @property
    def milliseconds_per_step(self):
        steps = sum(f["steps"] for f in self.figures)
        return 1e3 * sum(self.cpu) / steps if steps else float("nan")

    @property
    def steps_per_strain_after(self):
        """Steps per unit of strain travelled in the liquefied part, all realisations together."""
        strain = sum(f.get("strain_after", 0) for f in self.figures)
        steps = sum(f.get("steps_after", 0) for f in self.figures)
        return steps / strain if strain > 1e-3 else float("nan")

    @property
    def minutes(self):
        return paths.ensemble(self.cpu)[0] / 60 if self.cpu else float("nan")


class Results:
    def __init__(self, store, runs):
        self.rows = {}
        self.limits = runs[0].limits
        self.binaries, self.builds = set(), set()
        self.planned, self.done = len(runs), 0
        self.preparation = collections.defaultdict(list)  # CPU seconds by number of grains
        self.cpu = 0.0
        self.specimens = {}
        references = {}
        order = sorted(runs, key=lambda run: run.setting.family != "reference")  # references first
        for run in order:
            if not store.is_done(run):
                continue
            record = store.record(run)
            self.done += 1
            self.cpu += record["cpu"]
            self.binaries.add(record["binary"])
            if run.kind == "prepare":
                self.preparation[run.setting.grains].append(record["cpu"])
                continue
            row = self.rows.setdefault((run.setting.name, run.setting.grains), Row(run.setting))
            history = paths.History(store.folder(run))
            self.builds.add(paths.build(store.folder(run)))
            self.specimens[run.specimen] = history.summary["void_ratio"]
            self.add(run, row, history, record, references)
        settings = list(dict.fromkeys((run.setting.name, run.setting.grains) for run in runs))
        families = {row.family: row for row in self.rows.values()}
        self.base = families.get("default")
        names = [name for name in sorted(settings, key=lambda key: self.place(key, runs)) if name in self.rows]
        self.rows = {name: self.rows[name] for name in names}

    FAMILIES = ["default", "tolerance", "wide", "rate", "inertia", "step", "damping", "grains", "reference"]

    def place(self, key, runs):
        """Where a setting stands in tables: by family, the rest in the order of the plan."""
        setting = next(run.setting for run in runs if (run.setting.name, run.setting.grains) == key)
        return self.FAMILIES.index(setting.family)

    def add(self, run, row, history, record, references):
        is_reference = run.setting.family == "reference"
        where = (run.kind, run.setting.grains, run.seed)
        if run.kind == "monotonic":
            early = paths.monotonic_path(history, self.limits.early_strain)
            longer = paths.monotonic_path(history, self.limits.longer_strain)
            if is_reference:
                references[where] = early, longer
            else:
                first, second = references.get(where, (None, None))
                self.append(row.monotonic, paths.deviation(early, first))
                self.append(row.monotonic_longer, paths.deviation(longer, second))
                self.append(row.last_stress, history.p[-1] / history.p0)
            row.monotonic_steps.append(float(history.step[-1] - history.step[0]))
            row.monotonic_cpu.append(record["cpu"])
            return
        early = paths.cyclic_path(history, self.limits.early_reversals)
        longer = paths.cyclic_path(history, self.limits.longer_reversals)
        row.early_paths[run.seed], row.longer_paths[run.seed] = early, longer
        row.figures.append(paths.cyclic_figures(history))
        row.cpu.append(record["cpu"])
        row.wall.append(record["wall"])
        if is_reference:
            references[where] = early, longer
            return
        row.n_tests += 1
        row.short["early"] += early is None
        row.short["longer"] += longer is None
        first, second = references.get(where, (None, None))
        self.append(row.early, paths.deviation(early, first))
        self.append(row.longer, paths.deviation(longer, second))
        if row.figures[-1]["cycles"] is not None:
            row.cycles[run.seed] = row.figures[-1]["cycles"]
            row.redundancy[run.seed] = row.figures[-1]["redundancy"]

    @staticmethod
    def append(values, value):
        if value is not None:
            values.append(value)

    def of_families(self, *families):
        return [row for row in self.rows.values() if row.family in families]

    @property
    def slow(self):
        """The row of the slow limit; the smallest tolerance if it was not run."""
        for row in self.rows.values():
            if row.setting.name == SLOW and row.cycles:
                return row
        rows = [row for row in self.of_families("tolerance") if row.cycles]
        return rows[0] if rows else None

    def paired_difference(self, row):
        """Cycles of a setting less those of the slow limit, specimen by specimen."""
        slow = self.slow
        if slow is None:
            return paths.ensemble([])
        return paths.ensemble([c - slow.cycles[seed] for seed, c in row.cycles.items() if seed in slow.cycles])

    def within_scatter(self, row):
        """Mean cycles within one standard deviation of the slow limit, every test liquefied."""
        slow = self.slow
        if slow is None or not row.all_liquefied:
            return False
        mean, deviation, _, n = paths.ensemble(slow.cycles.values())
        return n > 1 and abs(paths.ensemble(row.cycles.values())[0] - mean) <= deviation

    def qualifies(self, row, target, window):
        return row.error(window)[0] <= target and self.within_scatter(row)

    def grains_rows(self):
        """Default settings by number of grains."""
        rows = [row for row in self.rows.values() if row.setting.name == "default"]
        return sorted(rows, key=lambda row: row.setting.grains)

    def deviation_of_means(self, row, largest, window="early_paths"):
        """Mean path of a number of grains against that of the largest: (rms, largest deviation, standard error).

        The standard error is that of the difference of the two means, root mean square over the points.
        """
        sets = [[p for p in getattr(r, window).values() if p is not None] for r in (row, largest)]
        if min(len(s) for s in sets) < 2 or row is largest:
            return None
        a, b = (np.array(s) for s in sets)
        rms, worst = paths.deviation(a.mean(0), b.mean(0))
        variance = a.var(0, ddof=1) / len(a) + b.var(0, ddof=1) / len(b)
        return rms, worst, float(np.sqrt(variance.mean()))

    def whole_test(self, row, strain):
        """Steps to the end of the cyclic test, the liquefied part brought to the same strain travelled."""
        return row.mean("steps_before") + strain * row.steps_per_strain_after

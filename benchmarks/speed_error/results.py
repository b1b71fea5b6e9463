# SPDX-License-Identifier: BSD-3-Clause
"""Gathers the runs that are done into one row per setting: errors, ensembles, cost."""
import collections
import dataclasses

import numpy as np

from speed_error import paths

FAMILIES = ["default", "inertia", "step", "damping", "old", "grains", "reference"]  # in the order of the tables


@dataclasses.dataclass
class Row:
    """One setting over its realisations. Errors are over p0'; lists have one value per realisation."""

    setting: object
    errors: dict = dataclasses.field(default_factory=lambda: collections.defaultdict(list))  # (rms, largest) by window
    tracks: dict = dataclasses.field(default_factory=lambda: collections.defaultdict(dict))  # by window and seed
    last_stress: list = dataclasses.field(default_factory=list)  # p'/p0' at the end of the whole monotonic test
    cycles: dict = dataclasses.field(default_factory=dict)  # by seed; only those that liquefied
    redundancy: dict = dataclasses.field(default_factory=dict)
    figures: list = dataclasses.field(default_factory=list)  # paths.cyclic_figures
    cpu: list = dataclasses.field(default_factory=list)  # of the cyclic test, s
    monotonic_steps: list = dataclasses.field(default_factory=list)  # to the early strain
    monotonic_cpu: list = dataclasses.field(default_factory=list)

    @property
    def family(self):
        return self.setting.family

    def mean(self, name):
        """Mean over realisations of a figure of the cyclic test; not a number if none has it."""
        return paths.ensemble([f.get(name) for f in self.figures])[0]

    def error(self, window="longer", which=1):
        """Ensemble of the error of a window: which = 0 root mean square, 1 largest."""
        return paths.ensemble([e[which] for e in self.errors[window]])

    @property
    def milliseconds_per_step(self):
        steps = sum(f["steps"] for f in self.figures)
        return 1e3 * sum(self.cpu) / steps if steps else float("nan")

    @property
    def seconds_to_onset(self):
        """CPU time; the liquefied part, which few settings have, does not count."""
        return self.mean("steps_before") * self.milliseconds_per_step / 1e3

    @property
    def steps_per_strain_after(self):
        """Steps per unit of strain travelled in the liquefied part, all realisations together."""
        strain = sum(f.get("strain_after", 0) for f in self.figures)
        steps = sum(f.get("steps_after", 0) for f in self.figures)
        return steps / strain if strain > 1e-3 and self.setting.reversals_after else float("nan")


class Results:
    def __init__(self, store, runs):
        self.limits = runs[0].limits
        self.binaries, self.builds = set(), set()
        self.planned, self.done, self.cpu = len(runs), 0, 0.0
        self.preparation = collections.defaultdict(list)  # CPU seconds by number of grains
        self.specimens = {}
        self.slowest = max((run.setting for run in runs if run.setting.family == "inertia"), key=lambda s: s.slowness)
        rows = {}
        for run in sorted(runs, key=lambda run: FAMILIES.index(run.setting.family)):
            if not store.is_done(run):
                continue
            record = store.record(run)
            self.done += 1
            self.cpu += record["cpu"]
            self.binaries.add(record["binary"])
            if run.kind == "prepare":
                self.preparation[run.setting.grains].append(record["cpu"])
                continue
            history = paths.History(store.folder(run))
            self.builds.add(paths.build(store.folder(run)))
            self.specimens[run.specimen] = history.summary["void_ratio"]
            self.add(run, rows.setdefault(run.setting, Row(run.setting)), history, record["cpu"])
        self.references = {row.setting.grains: row for row in rows.values() if row.family == "reference"}
        self.rows = [row for row in rows.values() if row.family != "reference"]
        self.base = next((row for row in self.rows if row.family == "default" and row.figures), None)
        for row in self.rows:
            self.compare(row)

    def add(self, run, row, history, cpu):
        limits, seed = self.limits, run.seed
        if run.kind == "monotonic":
            row.tracks["monotonic"][seed] = paths.monotonic_path(history, limits.early_strain)
            row.tracks["monotonic_longer"][seed] = paths.monotonic_path(history, limits.longer_strain)
            if run.strain == limits.strain:
                row.last_stress.append(history.p[-1] / history.p0)
            share = limits.early_strain / run.strain  # the rate is the same throughout
            row.monotonic_steps.append(share * (history.step[-1] - history.step[0]))
            row.monotonic_cpu.append(share * cpu)
            return
        row.tracks["early"][seed] = paths.cyclic_path(history, limits.early_reversals)
        row.tracks["longer"][seed] = paths.cyclic_path(history, limits.longer_reversals)
        row.figures.append(paths.cyclic_figures(history))
        row.cpu.append(cpu)
        if history.onset is not None:
            row.cycles[seed] = row.figures[-1]["cycles"]
            row.redundancy[seed] = row.figures[-1]["redundancy"]

    def compare(self, row):
        """Errors of a row: its paths against those of the reference of the same specimens."""
        reference = self.references.get(row.setting.grains)
        for window, found in row.tracks.items():
            errors = [paths.deviation(path, reference.tracks[window].get(seed) if reference else None)
                      for seed, path in found.items()]
            row.errors[window] = [error for error in errors if error is not None]

    @property
    def slow(self):
        """The row of the slow limit, the smallest inertial number of the plan; None if none of its tests is done."""
        return next((row for row in self.rows if row.setting == self.slowest and row.cycles), None)

    def paired_difference(self, row):
        """Cycles of a setting less those of the slow limit, specimen by specimen."""
        slow = self.slow.cycles if self.slow else {}
        return paths.ensemble([c - slow[seed] for seed, c in row.cycles.items() if seed in slow])

    def grains_rows(self):
        """Default settings by number of grains."""
        return sorted((row for row in self.rows if not row.setting.motion), key=lambda row: row.setting.grains)

    @staticmethod
    def deviation_of_means(row, largest, window):
        """Mean path of a number of grains against that of the largest: (rms, largest deviation, standard error).

        The standard error is that of the difference of the two means, root mean square over the points.
        """
        sets = [[p for p in r.tracks[window].values() if p is not None] for r in (row, largest)]
        if min(len(s) for s in sets) < 2 or row is largest:
            return None
        a, b = (np.array(s) for s in sets)
        rms, worst = paths.deviation(a.mean(0), b.mean(0))
        variance = a.var(0, ddof=1) / len(a) + b.var(0, ddof=1) / len(b)
        return rms, worst, float(np.sqrt(variance.mean()))

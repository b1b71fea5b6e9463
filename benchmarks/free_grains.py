#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What free grains do to an undrained test: a held packing, and cycles to liquefaction against the rate of loading.

    free_grains.py              runs what is missing, writes tables and figures to docs/results/free_grains
    free_grains.py --dry-run    the runs with their estimated time

Each specimen is tested with its free grains damped and left alone, at several rates, and one is held after five cycles.
Finished runs are kept in --work and not run again; an interrupted command goes on from checkpoints.
"""
import argparse
import csv
import dataclasses
import pathlib
import sys

import numpy as np
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

from speed_error import plan, runner  # noqa: E402
from speed_error.paths import History  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
GRAINS, HELD_STEPS, HELD_CYCLES = 2000, 200_000, 5
RATES = {  # name: keys of [motion], steps to the onset and without damping of free grains
    "20 1/s": (("strain_rate", '"20 1/s"'), 1e4),
    "10 1/s": (("strain_rate", '"10 1/s"'), 2e4),
    "5 1/s": (("strain_rate", '"5 1/s"'), 4e4),
    "tolerance 0.01": (None, 7e4),
    "I = 1e-5": (("inertial_number", "1e-5"), 7e5),
}
LOOK = {True: ("#0072b2", "o", "free grains damped, c = 0.1"), False: ("#d55e00", "s", "free grains left alone")}


@dataclasses.dataclass(frozen=True)
class Test:
    """One run, as runner.Campaign takes it."""

    kind: str  # prepare, cyclic, hold
    seed: int
    domain: str
    rate: str = "tolerance 0.01"
    damped: bool = False

    @property
    def name(self):
        grains = "damped" if self.damped else "plain"
        what = "specimen" if self.kind == "prepare" else f"{self.kind}_{self.rate}_{grains}"
        return f"{what}_{self.domain}_s{self.seed}".replace(" ", "").replace("/", "")

    @property
    def specimen(self):
        return self.domain, self.seed

    def scene(self):
        keys = [key for key in (RATES[self.rate][0],) if key]
        keys += [("free_grain_damping", "0.1")] if self.damped else []
        text = plan.SCENE.format(title=self.name, grains=GRAINS, seed=self.seed, edge=10 * (GRAINS / 10000) ** (1 / 3),
                                 motion="\n".join(f"{key} = {value}" for key, value in keys), stage=self.stage(),
                                 record_strain="1e-4")
        text = text.replace("rigid-box", self.domain)
        return text + "record_steps = 1000\n" if self.kind == "hold" else text

    def stage(self):
        if self.kind == "prepare":
            return ""
        until = f"cycles = {HELD_CYCLES}" if self.kind == "hold" else "cycles = 100, reversals_after_liquefaction = 0"
        text = f'[[stage]]\nkind = "undrained-cyclic"\ndeviator_amplitude = "60 kPa"\nuntil = {{ {until} }}\n'
        if self.kind == "hold":
            text += f'[[stage]]\nkind = "hold"\nmax_steps = {HELD_STEPS}\n'
        return text

    def estimated_seconds(self):
        if self.kind == "prepare":
            return 6
        return 1e-4 * (HELD_STEPS if self.kind == "hold" else RATES[self.rate][1])


def tests(seeds, domains):
    """Specimens first, then seed by seed, so that a campaign cut short has every rate."""
    runs = [Test("prepare", seed, domain) for domain in domains for seed in seeds]
    runs += [Test("hold", 1, domain, damped=damped) for domain in domains for damped in (True, False)]
    return runs + [Test("cyclic", seed, domain, rate, damped)
                   for seed in seeds for domain in domains for rate in RATES for damped in LOOK]


def mean_and_error(values):
    values = np.array(values, dtype=float)
    return values.mean(), values.std(ddof=1) / np.sqrt(len(values)) if len(values) > 1 else np.nan


def cycles_table(store, runs):
    """One row for each domain, rate and damping, over the specimens that liquefied in all of them; see HEADER."""
    rows = []
    for domain in dict.fromkeys(r.domain for r in runs):
        done = {(r.rate, r.damped, r.seed): History(store.folder(r)) for r in runs
                if r.kind == "cyclic" and r.domain == domain and store.is_done(r)}
        seeds = [s for s in {r.seed for r in runs}
                 if all((rate, on, s) in done and done[rate, on, s].onset is not None for rate in RATES for on in LOOK)]
        for rate in RATES:
            for damped in (True, False) if seeds else ():
                histories = [done[rate, damped, s] for s in seeds]
                cycles = [h.reversals[h.onset] / 2 for h in histories]
                slow = [done["I = 1e-5", True, s] for s in seeds]
                paired = [c - h.reversals[h.onset] / 2 for c, h in zip(cycles, slow)]
                at = {k: [h.p[h.reversal_rows[k - 1]] / 1e3 for h in histories if len(h.reversal_rows) >= k]
                      for k in (2, 10)}
                rows.append([domain, rate, "yes" if damped else "no", len(seeds), *mean_and_error(cycles),
                             *mean_and_error(paired), np.mean([h.step[h.onset] for h in histories]),
                             *(np.mean(p) for p in at.values())])
    return rows


HEADER = ["domain", "rate", "free grains damped", "seeds", "cycles", "standard error",
          "cycles minus damped at I = 1e-5", "standard error of the difference", "steps to the onset",
          "p' at reversal 2 (kPa)", "p' at reversal 10 (kPa)"]


def write_csv(path, header, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(header)
        out.writerows([[f"{v:.5g}" if isinstance(v, float) else v for v in row] for row in rows])


def draw_cycles(rows, path):
    domains = list(dict.fromkeys(row[0] for row in rows))
    size = (4.2 * len(domains), 3.4)
    figure, panels = plt.subplots(1, len(domains), figsize=size, squeeze=False, sharey=True)
    for panel, domain, letter in zip(panels[0], domains, "ab"):
        for damped, (colour, marker, label) in LOOK.items():
            some = [row for row in rows if row[0] == domain and (row[2] == "yes") == damped]
            steps, cycles, errors = ([row[k] for row in some] for k in (8, 4, 5))
            panel.errorbar(steps, cycles, yerr=errors, color=colour, marker=marker, capsize=3, label=label)
        panel.set(xscale="log", xlabel="time steps to liquefaction [-]", title=f"({letter}) {domain.replace('-', ' ')}")
        panel.set_ylim(bottom=0)
    panels[0][0].set_ylabel("cycles to liquefaction [-]")
    panels[0][0].legend()
    figure.savefig(path, bbox_inches="tight")
    plt.close(figure)


def hold_table(store, runs):
    """Rows of the held stage: domain, damped, steps held, p' lost (kPa), E_kin (J), unbalanced force ratio."""
    rows = []
    for run in runs:
        if run.kind != "hold" or not store.is_done(run):
            continue
        h = History(store.folder(run))
        held = np.flatnonzero(h.stage == h.stage[-1])
        for k in held:
            rows.append([run.domain, "yes" if run.damped else "no", h.step[k] - h.step[held[0]],
                         (h.p[held[0]] - h.p[k]) / 1e3, h.E_kin[k], h.unbalanced[k]])
    return rows


def draw_hold(rows, path):
    figure, panels = plt.subplots(1, 2, figsize=(8.4, 3.4))
    for panel, column, name, letter in zip(panels, (3, 4), ("p' lost [kPa]", "kinetic energy [J]"), "ab"):
        for domain, line in zip(dict.fromkeys(row[0] for row in rows), ("-", "--")):
            for damped, (colour, _, label) in LOOK.items():
                of_line = [row[2:] for row in rows if row[:2] == [domain, "yes" if damped else "no"]]
                some = np.array(of_line, dtype=float)
                if len(some):
                    panel.plot(some[:, 0], some[:, column - 2], line, color=colour,
                               label=f"{domain.replace('-', ' ')}, {label}")
        panel.set(xlabel="time steps since loading stopped [-]", ylabel=name, title=f"({letter})")
    panels[1].set_yscale("log")
    panels[1].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(path, bbox_inches="tight")
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", default=str(ROOT / "results/free_grains"), help="folder of runs and records")
    parser.add_argument("--build", default=str(ROOT / "build/release"), help="build tree with bin/element_test")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--jobs", type=int, default=2, help="runs side by side, each on a core of its own")
    parser.add_argument("--minutes", type=float, default=0, help="stop after so many minutes; 0: no limit")
    parser.add_argument("--dry-run", action="store_true")
    options = parser.parse_args()
    store, runs = runner.Store(options.work), tests(range(1, options.seeds + 1), ("rigid-box", "periodic-cell"))
    left = [run for run in runs if not store.is_done(run)]
    print(f"{len(runs)} runs, {len(left)} to do, some {sum(r.estimated_seconds() for r in left) / 60:.0f} CPU minutes")
    if options.dry_run:
        return 0
    campaign = runner.Campaign(store, pathlib.Path(options.build) / "bin/element_test", runs, options.jobs)
    complete = campaign.run_all(options.minutes)
    folder = ROOT / "docs/results/free_grains"
    folder.mkdir(parents=True, exist_ok=True)
    plt.rcParams.update({"savefig.dpi": 200, "font.size": 9, "axes.grid": True, "grid.color": "#e4e4e4",
                         "legend.frameon": False, "axes.spines.top": False, "axes.spines.right": False})
    cycles, hold = cycles_table(store, runs), hold_table(store, runs)
    write_csv(folder / "cycles.csv", HEADER, cycles)
    draw_cycles(cycles, folder / "cycles.png")
    write_csv(folder / "hold.csv", ["domain", "free grains damped", "steps held", "p' lost (kPa)", "E_kin (J)",
                                    "unbalanced force ratio"], hold)
    draw_hold(hold, folder / "hold.png")
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())

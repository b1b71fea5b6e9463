#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far stresses of undrained shear hang on the number of grains: scatter between realisations, drift of their mean.

    stress_against_n.py [--quick] [--jobs 1] [--grains 500 1000 2000 5000 10000] [--realisations 10] [--rate 0.5]
                        [--build build/release] [--folder results/stress_against_n] [--report docs/results]

For every N and seed: a specimen with grains of the same size (cloud_edge = 10 mm (N/10000)^(1/3)), prepared at 10 deg
and 200 kPa, and constant-volume compression to 0.5 % at a fixed rate, by element_test. Each run is one folder; finished
ones are skipped, interrupted ones go on, runs of other settings are made again, so the command can be repeated until it
is through. At the end: all figures in FOLDER/runs.csv, a report and its figure in REPORT (FOLDER if not given).

Scatter: standard deviation s over realisations, fitted as s ~ N^-x; the n - 1 freedoms of each s are its weight,
var(ln s) = 1/(2(n-1)). Drift: mean m, fitted as m = m_inf + c N^(-1/3), the share of grains beside a wall, each m with
weight n/s^2; misfit is the largest distance of a mean from that curve in standard errors of the mean, and where it is
well above 1, m_inf is no more than a hint. Both need three N; x, m_inf and c come with their standard errors.

`--quick`: N = 200, 400, 800, three realisations, in a minute, in FOLDER_quick; it shows that all works.
"""
import argparse
import collections
import concurrent.futures
import csv
import json
import math
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

from speed_error.plan import CONTACT  # noqa: E402

STRAINS = (0.0002, 0.0005, 0.001, 0.002, 0.005)  # axial, of the table
COLLAPSED = 0.05  # p'/p0' below which a run counts as one that has lost its strength
SCENE = """title = "Stress against N: {grains} grains, realisation {seed}"
[grading]
curve = "karlsruhe-fine-sand"
grains = {grains}
cloud_edge = "{edge:.12g} mm"
seed = {seed}
""" + CONTACT + """[specimen]
pressure = "200 kPa"
preparation_friction = "10 deg"
[motion]
damping = 0.2
strain_rate = "{rate:g} 1/s"
[[stage]]
kind = "undrained-monotonic"
direction = "compression"
strain = {strain:g}
[output]
record_stress = "2 kPa"
record_strain = 5e-5
snapshots = "none"
paraview = false
checkpoint = "2 min"
"""
Quantity = collections.namedtuple("Quantity", "key title unit scale digits")
QUANTITIES = [Quantity("e", "void ratio e", "-", 1, 4), Quantity("Z", "coordination Z", "-", 1, 3)]
for _strain in STRAINS:
    QUANTITIES += [Quantity(f"p_{_strain:g}", f"p' at {100 * _strain:g} %", "kPa", 1e-3, 2),
                   Quantity(f"q_{_strain:g}", f"q at {100 * _strain:g} %", "kPa", 1e-3, 2)]


# --- runs ------------------------------------------------------------------------------------------------------------


class Campaign:
    """Runs of element_test in one folder, each with the scene it was made from beside it."""

    def __init__(self, options):
        self.program = pathlib.Path(options.build).resolve() / "bin" / "element_test"
        self.folder = pathlib.Path(options.folder)
        self.rate, self.total, self.done = options.rate, 0, 0
        self.lock, self.running, self.stopped = threading.Lock(), set(), False
        if not self.program.exists():
            sys.exit(f"{self.program} is missing: cmake --build --preset release --target element_test")
        self.folder.mkdir(parents=True, exist_ok=True)

    def path(self, grains, seed):
        return self.folder / f"n{grains:06d}_seed{seed:02d}"

    def scene(self, grains, seed):
        edge = 10 * (grains / 10000) ** (1 / 3)
        return SCENE.format(grains=grains, seed=seed, edge=edge, rate=self.rate, strain=STRAINS[-1])

    def run(self, grains, seed):
        """One run, unless it is there; returns an error text or None."""
        path = self.path(grains, seed)
        scene_file, text = path.with_suffix(".toml"), self.scene(grains, seed)
        same = scene_file.exists() and scene_file.read_text() == text
        begin, how = time.monotonic(), "is there"
        if not (same and (path / "summary.json").exists()):
            resumable = same and (path / "checkpoint" / "last.h5").exists()
            if not same:
                (path / "summary.json").unlink(missing_ok=True)  # of other settings: must not pass for this run
            scene_file.write_text(text)
            error = self.execute([scene_file, "--output", path, "--resume" if resumable else "--overwrite"])
            if error:
                return f"{path.name}: {error}"
            how = f"{time.monotonic() - begin:.0f} s"
        with self.lock:
            self.done += 1
            print(f"[{self.done}/{self.total}] {path.name}: {how}", flush=True)
        return None

    def execute(self, arguments):
        with self.lock:
            if self.stopped:
                return "stopped"
            process = subprocess.Popen([self.program, *arguments, "--quiet", "--no-figures"], text=True,
                                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            self.running.add(process)
        error = process.communicate()[1]
        with self.lock:
            self.running.discard(process)
        return (error.strip() or f"exit code {process.returncode}") if process.returncode else None

    def stop(self, *_):
        """Runs write a checkpoint and end; the same command goes on from there."""
        self.stopped = True
        for process in list(self.running):
            process.terminate()

    def run_all(self, cases, jobs):
        self.total = len(cases)
        signal.signal(signal.SIGTERM, self.stop)
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            futures = [pool.submit(self.run, *case) for case in cases]
            try:
                errors = [future.result() for future in futures]
            except KeyboardInterrupt:
                self.stop()
                errors = [future.result() for future in futures]
        if self.stopped:
            sys.exit(130)
        errors = [error for error in errors if error]
        for error in errors:
            print(error, file=sys.stderr)
        return not errors


def read_run(path):
    """Figures of one run: void ratio and coordination before shear, p' and q at the strains, quality of the run."""
    with open(path / "history.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    names = [re.sub(r"\s*\(.*\)", "", cell) for cell in rows[0]]
    column = dict(zip(names, np.array(rows[1:], dtype=float).T))
    summary = json.loads((path / "summary.json").read_text(encoding="utf-8"))
    if column["eps_y"][-1] < STRAINS[-1] * (1 - 1e-9):
        raise ValueError(f"{path}: ends at a strain of {column['eps_y'][-1]:g}")
    figures = {"e": column["e"][0], "Z": column["Z"][0], "steps": summary["steps"], "seconds": summary["seconds"],
               "indicator": np.mean(column["indicator"][column["eps_y"] > 0])}
    figures["collapsed"] = float(np.min(column["p"]) < COLLAPSED * column["p"][0])
    for strain in STRAINS:
        for stress in "pq":
            figures[f"{stress}_{strain:g}"] = np.interp(strain, column["eps_y"], column[stress])
    return figures


# --- statistics ------------------------------------------------------------------------------------------------------


def line_fit(x, y, variance):
    """Weighted least squares y = a + b x: (a, its standard error), (b, its standard error); None below three points."""
    if len(x) < 3:
        return None
    design = np.column_stack([np.ones(len(x)), x])
    weight = 1 / np.asarray(variance)
    covariance = np.linalg.inv(design.T @ (weight[:, None] * design))
    a, b = covariance @ (design.T @ (weight * np.asarray(y)))
    errors = np.sqrt(np.diag(covariance))
    return (a, errors[0]), (b, errors[1])


class Sample:
    """One quantity: realisations, mean and standard deviation at every N, and what both do with N."""

    def __init__(self, quantity, by_grains):
        self.quantity = quantity
        self.grains = np.array(sorted(by_grains))
        self.values = [quantity.scale * np.array([run[quantity.key] for run in by_grains[n]]) for n in self.grains]
        self.count = np.array([len(v) for v in self.values])
        self.mean = np.array([v.mean() for v in self.values])
        self.deviation = np.array([v.std(ddof=1) if len(v) > 1 else math.nan for v in self.values])
        self.error = self.deviation / np.sqrt(self.count)  # of the mean
        self.scatter = self.drift = None
        if (self.count > 1).all() and (self.deviation > 0).all():
            self.scatter = line_fit(np.log(self.grains), np.log(self.deviation), 1 / (2 * (self.count - 1)))
            self.drift = line_fit(self.grains ** (-1 / 3), self.mean, self.error ** 2)
        if self.drift:
            self.misfit = np.max(np.abs(self.mean - self.drifted(self.grains)) / self.error)

    def drifted(self, grains):
        return self.drift[0][0] + self.drift[1][0] * grains ** (-1 / 3)


# --- report ----------------------------------------------------------------------------------------------------------


def with_error(value, error):
    digits = max(0, 1 - math.floor(math.log10(error))) if error > 0 else 3
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def table(samples, by_grains):
    grains, count = samples[0].grains, samples[0].count
    collapsed = [f"{sum(run['collapsed'] for run in by_grains[n]):.0f}" for n in grains]
    head = ["quantity"] + [f"N = {n:,}" for n in grains]
    lines = ["| " + " | ".join(head) + " |", "|---" * len(head) + "|",
             "| realisations | " + " | ".join(str(c) for c in count) + " |"]
    for s in samples:
        unit = "" if s.quantity.unit == "-" else f" ({s.quantity.unit})"
        cells = [f"{m:.{s.quantity.digits}f} ± {d:.{s.quantity.digits}f}" for m, d in zip(s.mean, s.deviation)]
        lines.append("| " + " | ".join([s.quantity.title + unit] + cells) + " |")
    lines.append(f"| runs with p' below {COLLAPSED:g} p0' | " + " | ".join(collapsed) + " |")
    return "\n".join(lines)


def fit_table(samples):
    first, last = samples[0].grains[[0, -1]]
    lines = [f"| quantity | x in scatter ~ N^-x | mean at N = {last:,} minus mean at {first:,} | m_inf | c | misfit |",
             "|---|---|---|---|---|---|"]
    for s in samples:
        unit = "" if s.quantity.unit == "-" else f" ({s.quantity.unit})"
        if not (s.scatter and s.drift):
            continue
        change = with_error(s.mean[-1] - s.mean[0], math.hypot(s.error[0], s.error[-1]))
        lines.append(f"| {s.quantity.title}{unit} | {with_error(-s.scatter[1][0], s.scatter[1][1])} | {change} | "
                     f"{with_error(*s.drift[0])} | {with_error(*s.drift[1])} | {s.misfit:.1f} |")
    return "\n".join(lines)


def costs(by_grains):
    parts = []
    for n in sorted(by_grains):
        runs = by_grains[n]
        mean = lambda key: np.mean([run[key] for run in runs])  # noqa: E731
        parts.append(f"| {n:,} | {mean('steps'):,.0f} | {mean('seconds'):.0f} | {mean('indicator'):.4f} | "
                     f"{max(run['indicator'] for run in runs):.4f} |")
    return "\n".join(["| N | steps of shear | s of shear | indicator, mean | indicator of the worst run |",
                      "|---|---|---|---|---|"] + parts)


def report(samples, by_grains, options):
    grains = " ".join(str(n) for n in sorted(by_grains))
    return f"""# Stress against the number of grains

Written by `benchmarks/stress_against_n.py`; how to read it is in [benchmarks/README.md](../../benchmarks/README.md).

```sh
python3 benchmarks/stress_against_n.py --grains {grains} \\
    --realisations {options.realisations} --rate {options.rate:g} --report docs/results
```

Undrained monotonic compression to {100 * STRAINS[-1]:g} % at {options.rate:g} 1/s. Specimens of Karlsruhe fine sand,
prepared at 10 deg and 200 kPa, grains of the same size at every N. Mean ± standard deviation over realisations (seeds
of the cloud); e and Z before shear; e is that of the whole box, its loose layer at the walls included.

{table(samples, by_grains)}

![stress against N](stress_against_n/fig_stress_against_n.png)

## Scatter and drift

Scatter: standard deviation ~ N^-x. Drift: mean = m_inf + c N^(-1/3), in the unit of the quantity; misfit: largest
distance of a mean from this curve, in standard errors of that mean. ± is one standard error, from the number of
realisations alone: rows share specimens and are not independent of each other.

{fit_table(samples)}

x = 0.5 is that of independent parts. It is not to be expected where some realisations have lost their strength and
others have not: their stresses have two values, and a standard deviation that says how many took which way.

## The runs

The indicator is the error that inertia may have added to stresses (docs/theory.md, section 8), a mean over the rows of
a run.

{costs(by_grains)}
"""


def draw(samples, path):
    by_key = {s.quantity.key: s for s in samples}
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
                         "grid.color": "#e4e4e4", "axes.axisbelow": True, "legend.frameon": False})
    colours = dict(zip(STRAINS, ("#7f7f7f", "#1a1a1a", "#0072b2", "#009e73", "#d55e00")))
    figure, axes = plt.subplots(2, 2, figsize=(8.2, 6.4), layout="constrained")
    for axis, stress, label in ((axes[0, 0], "p", "p' (kPa)"), (axes[0, 1], "q", "q (kPa)")):
        for number, strain in enumerate(STRAINS):  # beside each other, so that none hides another
            shift = 1.05 ** (number - 2)
            draw_mean(axis, by_key[f"{stress}_{strain:g}"], colours[strain], f"{100 * strain:g} %", shift)
        axis.set(ylabel=label)
    axes[0, 0].legend(title="axial strain", ncol=2)
    for strain in STRAINS:
        for stress, marker in (("p", "o"), ("q", "s")):
            s = by_key[f"{stress}_{strain:g}"]
            axes[1, 0].plot(s.grains, s.deviation, marker=marker, color=colours[strain], lw=0.8, ms=4)
    axes[1, 0].plot([], [], "o", color="grey", label="p'")
    axes[1, 0].plot([], [], "s", color="grey", label="q")
    least = by_key[f"p_{STRAINS[0]:g}"].deviation[0]
    half = 0.7 * least * (s.grains / s.grains[0]) ** -0.5
    axes[1, 0].plot(s.grains, half, "--", color="grey", label=r"$N^{-1/2}$")
    axes[1, 0].set(yscale="log", ylabel="standard deviation (kPa)")
    axes[1, 0].legend(ncol=3)
    draw_mean(axes[1, 1], by_key["e"], "#1a1a1a", "")
    axes[1, 1].set(ylabel="void ratio e of the box")
    for axis, letter in zip(axes.flat, "abcd"):
        axis.set_title(f"({letter})", loc="left", fontsize=9)
        axis.set(xscale="log", xlabel="N")
        axis.set_xticks(s.grains, [f"{n:,}" for n in s.grains])
        axis.minorticks_off()
    figure.savefig(path, dpi=160)


def draw_mean(axis, s, colour, label, shift=1.0):
    """Realisations as dots, mean with its standard error, the fit of the drift as a line."""
    for n, values in zip(s.grains, s.values):
        axis.plot(np.full(len(values), n * shift), values, ".", color=colour, alpha=0.3, ms=5, mew=0)
    axis.errorbar(s.grains * shift, s.mean, s.error, fmt="o", color=colour, capsize=2, ms=3.5, lw=1, label=label)
    if s.drift:
        n = np.geomspace(s.grains[0], s.grains[-1], 50)
        axis.plot(n * shift, s.drifted(n), color=colour, lw=0.7)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release")
    parser.add_argument("--folder")
    parser.add_argument("--report")
    parser.add_argument("--grains", type=int, nargs="+")
    parser.add_argument("--realisations", type=int)
    parser.add_argument("--rate", type=float, default=0.5)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--quick", action="store_true")
    options = parser.parse_args()
    options.folder = options.folder or "results/stress_against_n" + ("_quick" if options.quick else "")
    options.grains = options.grains or ([200, 400, 800] if options.quick else [500, 1000, 2000, 5000, 10000])
    options.realisations = options.realisations or (3 if options.quick else 10)
    if options.quick:
        options.rate = 2
    campaign = Campaign(options)
    cases = [(n, seed) for seed in range(1, options.realisations + 1) for n in sorted(set(options.grains))]
    complete = campaign.run_all(cases, options.jobs)

    by_grains = collections.defaultdict(list)
    with open(campaign.folder / "runs.csv", "w", newline="", encoding="utf-8") as file:
        table_of_runs = None
        for grains, seed in cases:
            if not (campaign.path(grains, seed) / "summary.json").exists():
                continue
            run = read_run(campaign.path(grains, seed))
            by_grains[grains].append(run)
            if table_of_runs is None:
                table_of_runs = csv.DictWriter(file, ["grains", "seed", *run])
                table_of_runs.writeheader()
            table_of_runs.writerow({"grains": grains, "seed": seed, **run})
    if not by_grains:
        return 1
    target = pathlib.Path(options.report or campaign.folder)
    (target / "stress_against_n").mkdir(parents=True, exist_ok=True)
    samples = [Sample(quantity, by_grains) for quantity in QUANTITIES]
    draw(samples, target / "stress_against_n" / "fig_stress_against_n.png")
    (target / "stress_against_n.md").write_text(report(samples, by_grains, options), encoding="utf-8")
    print(f"\n{table(samples, by_grains)}\n\n{fit_table(samples)}\n\n{target / 'stress_against_n.md'}")
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())

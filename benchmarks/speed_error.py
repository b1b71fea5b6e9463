#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Error against time: what rate, time step, damping and number of grains cost, and what they are worth.

    speed_error.py                    plans, runs what is missing, writes docs/results/speed_error.md and its figures
    speed_error.py --dry-run          the plan with its estimated hours
    speed_error.py --quick            a smoke run of two minutes; its report stays in the work folder

Runs undrained cyclic and monotonic tests with element_test, one factor at a time around the default, every setting on
the same specimens. Finished runs are kept in --work and not run again; after an interrupt (Ctrl-C, SIGTERM) the same
command goes on from checkpoints. The settings and their reasons are in speed_error/plan.py.
"""
import argparse
import pathlib
import shlex
import sys

from speed_error import figures, plan, report, runner
from speed_error.results import Results

ROOT = pathlib.Path(__file__).resolve().parent.parent


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", help="folder of runs, specimens and records (default: results/speed_error)")
    parser.add_argument("--build", default=str(ROOT / "build" / "release"), help="build tree with bin/element_test")
    parser.add_argument("--report", help="Markdown to write (default: docs/results/speed_error.md)")
    parser.add_argument("--jobs", type=int, default=2, help="runs side by side, each on a core of its own")
    parser.add_argument("--realisations", type=int, default=8,
                        help="seeds 1 to this number; at most 2 for 5,000 grains and more")
    parser.add_argument("--minutes", type=float, default=0, help="stop after so many minutes; 0: no limit")
    parser.add_argument("--only", default="", help="regular expression: runs whose name it is found in")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--dry-run", action="store_true")
    parser.add_argument("--report-only", action="store_true", help="run nothing, write the report from what is there")
    return parser.parse_args()


def plan_of(options):
    if options.quick:
        limits = plan.Limits(strain=0.001, early_strain=0.0005, longer_strain=0.001, cycles=30,
                             early_reversals=2, longer_reversals=4, max_steps=120_000)
        return plan.runs(plan.quick_settings(), (1, 2), limits, options.only)
    return plan.runs(plan.full_settings(), range(1, options.realisations + 1), plan.Limits(), options.only)


def print_plan(store, runs, jobs):
    """One line per setting, and the estimate of what is left."""
    scale = runner.speed(store, runs)
    lines = {}
    for run in runs:
        what = "specimen" if run.kind == "prepare" else run.setting.label
        key = (run.setting.grains, what, run.kind)
        number, seconds, left = lines.get(key, (0, 0, 0))
        lines[key] = number + 1, seconds + scale * run.estimated_seconds(), left + (not store.is_done(run))
    print(f"{'grains':>7}  {'setting':<32}{'test':<11}{'runs':>5}{'to do':>7}{'CPU min':>9}")
    for (grains, what, kind), (number, seconds, left) in sorted(lines.items(), key=lambda item: item[0][0]):
        print(f"{grains:>7}  {what:<32}{kind:<11}{number:>5}{left:>7}{seconds / 60:>9.1f}")
    left = [run for run in runs if not store.is_done(run)]
    hours = scale * sum(run.estimated_seconds() for run in left) / 3600
    print(f"{len(runs)} runs, {len(left)} to do, about {hours:.2f} CPU hours, {hours / jobs:.2f} hours with {jobs} "
          f"jobs (estimate x {scale:.2f} from {len(runs) - len(left)} runs done)", flush=True)


def write_report(store, runs, path, command):
    results = Results(store, runs)
    if results.base is None or results.base.setting.grains not in results.references:
        sys.exit("the default and the reference are not done on any specimen yet: nothing to report")
    pictures = path.parent / "speed_error"
    pictures.mkdir(parents=True, exist_ok=True)
    figures.pareto(results, pictures / "pareto.png")
    figures.ensembles(results, pictures / "ensembles.png")
    path.write_text(report.write(results, command))
    print(report.user_sentence(results))
    print(f"written: {path}, {pictures}/pareto.png, ensembles.png")


def main():
    options = parse()
    name = "speed_error_quick" if options.quick else "speed_error"
    work = pathlib.Path(options.work or ROOT / "results" / name)
    path = pathlib.Path(options.report or (work / "speed_error.md" if options.quick
                                           else ROOT / "docs" / "results" / "speed_error.md"))
    # paths of this machine are nobody's business in a report
    kept = [f"--realisations {options.realisations}"] * (options.realisations != 8) + ["--quick"] * options.quick
    command = " ".join(["python3 benchmarks/speed_error.py", *kept, f"--jobs {options.jobs}"])
    store, runs = runner.Store(work), plan_of(options)
    if not runs:
        sys.exit(f"no run matches {shlex.quote(options.only)}")
    print_plan(store, runs, options.jobs)
    if options.dry_run:
        return 0
    complete = True
    if not options.report_only:
        binary = pathlib.Path(options.build) / "bin" / "element_test"
        if not binary.exists():
            sys.exit(f"{binary} is not there; build it: cmake --build --preset release --target element_test")
        campaign = runner.Campaign(store, binary, runs, options.jobs)
        complete = campaign.run_all(options.minutes)
        if not complete:
            print(f"{len(campaign.failures)} runs failed; the rest is kept: the same command goes on")
        if campaign.stopping and not options.minutes:
            return 130
    if not options.only:
        write_report(store, runs, path, command)
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())

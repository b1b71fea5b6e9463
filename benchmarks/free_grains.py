#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The quasi-static limit of undrained tests: what free grains, walls that push, rate, time step and damping change.

    free_grains.py              runs what is missing, writes tables and figures to docs/results/free_grains
    free_grains.py --dry-run    the number of runs and their estimated time
    free_grains.py --seeds 4    fewer specimens

Every setting is run on the same specimens of 2,000 grains; differences are taken specimen by specimen. Finished runs
are kept in --work and not run again; an interrupted command goes on from checkpoints.
"""
import argparse
import pathlib
import sys

from free_grains import figures, plan, tables
from speed_error import runner

ROOT = pathlib.Path(__file__).resolve().parent.parent


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", default=str(ROOT / "results/free_grains"), help="folder of runs and records")
    parser.add_argument("--build", default=str(ROOT / "build/release"), help="build tree with bin/element_test")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=2, help="runs side by side, each on a core of its own")
    parser.add_argument("--minutes", type=float, default=0, help="stop after so many minutes; 0: no limit")
    parser.add_argument("--dry-run", action="store_true")
    options = parser.parse_args()
    store, runs = runner.Store(options.work), plan.runs(options.seeds)
    left = [run for run in runs if not store.is_done(run)]
    print(f"{len(runs)} runs, {len(left)} to do, some {sum(r.estimated_seconds() for r in left) / 60:.0f} CPU minutes")
    if options.dry_run:
        return 0
    campaign = runner.Campaign(store, pathlib.Path(options.build) / "bin/element_test", runs, options.jobs)
    complete = campaign.run_all(options.minutes)
    folder = ROOT / "docs/results/free_grains" if complete else pathlib.Path(options.work) / "incomplete"
    folder.mkdir(parents=True, exist_ok=True)
    results = tables.Results(store, runs)
    for name, (header, rows) in results.tables().items():
        tables.write_csv(folder / f"{name}.csv", header, rows)
    figures.draw(results, folder)
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())

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
    runner.add_arguments(parser, ROOT, "free_grains")
    parser.add_argument("--seeds", type=int, default=20)
    options = parser.parse_args()
    runs = plan.runs(options.seeds)
    store, complete = runner.run_campaign(options, runs)
    if complete is None:
        return 0
    folder = ROOT / "docs/results/free_grains" if complete else pathlib.Path(options.work) / "incomplete"
    folder.mkdir(parents=True, exist_ok=True)
    results = tables.Results(store, runs)
    for name, (header, rows) in results.tables().items():
        tables.write_csv(folder / f"{name}.csv", header, rows)
    figures.draw(results, folder)
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())

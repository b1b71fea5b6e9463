#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Speed against error: how far tests are from balance and convergence, static and dynamic, and what they cost.

    speed_error.py                    runs what is missing, writes tables and figures to docs/results/speed_error
    speed_error.py --dry-run          the number of runs and their estimated time
    speed_error.py --seeds 2          fewer specimens

Every setting is run on the same specimens; differences are taken specimen by specimen. Finished runs are kept in --work
and not run again; an interrupted command goes on from checkpoints.
"""
import argparse
import pathlib
import sys

from speed_error import figures, plan, runner, tables

ROOT = pathlib.Path(__file__).resolve().parent.parent


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    runner.add_arguments(parser, ROOT, "speed_error")
    parser.add_argument("--seeds", type=int, default=20)
    options = parser.parse_args()
    runs = plan.runs(options.seeds)
    store, complete = runner.run_campaign(options, runs)
    if complete is None:
        return 0
    folder = ROOT / "docs/results/speed_error" if complete else pathlib.Path(options.work) / "incomplete"
    results = tables.Results(store, runs)
    tables.write(folder, results.tables())
    figures.draw(results, folder)
    return 0 if complete else 1


if __name__ == "__main__":
    sys.exit(main())

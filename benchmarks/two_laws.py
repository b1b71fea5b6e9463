#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's undrained tests and the liquefaction resistance under four pressures, with both contact laws.

    two_laws.py              runs what is missing, writes tables and figures to docs/results/two_laws
    two_laws.py --dry-run    the number of runs and their estimated time
    two_laws.py --report     tables and figures of what is there

Finished runs are kept in --work and not run again; an interrupted command goes on from checkpoints.
"""
import argparse
import pathlib
import sys

from speed_error import runner
from two_laws import plan, report

ROOT = pathlib.Path(__file__).resolve().parent.parent


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    runner.add_arguments(parser, ROOT, "two_laws")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--report", action="store_true", help="run nothing")
    options = parser.parse_args()
    runs = plan.runs(options.seeds)
    if options.report:
        store, complete = runner.Store(options.work), True
    else:
        store, complete = runner.run_campaign(options, runs)
    if complete is not None:
        report.write(store, runs, ROOT / "docs/results/two_laws")
    return 0 if complete in (True, None) else 1


if __name__ == "__main__":
    sys.exit(main())

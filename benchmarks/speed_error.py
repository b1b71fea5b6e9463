#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Speed against error: how far tests are from balance and convergence, static and dynamic, and what they cost.

    speed_error.py                    runs what is missing, writes tables and figures to docs/results/speed_error
    speed_error.py --dry-run          the number of runs and their estimated time
    speed_error.py --seeds 2          fewer specimens

Every setting is run on the same specimens; differences are taken specimen by specimen. Finished runs are kept in --work
and not run again; an interrupted command goes on from checkpoints.
"""
import sys

from speed_error import figures, plan, runner, tables

if __name__ == "__main__":
    sys.exit(runner.run_study("speed_error", __doc__, plan.runs, tables.Results, figures.draw))

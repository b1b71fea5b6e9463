#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The quasi-static limit of undrained tests: what free grains, walls that push, rate, time step and damping change.

    free_grains.py              runs what is missing, writes tables and figures to docs/results/free_grains
    free_grains.py --dry-run    the number of runs and their estimated time
    free_grains.py --seeds 4    fewer specimens

Every setting is run on the same specimens of 2,000 grains; differences are taken specimen by specimen. Finished runs
are kept in --work and not run again; an interrupted command goes on from checkpoints.
"""
import sys

from free_grains import figures, plan, tables
from speed_error import runner

if __name__ == "__main__":
    sys.exit(runner.run_study("free_grains", __doc__, plan.runs, tables.Results, figures.draw))

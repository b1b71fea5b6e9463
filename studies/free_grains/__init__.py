# SPDX-License-Identifier: BSD-3-Clause
"""The quasi-static limit of undrained tests: what rattlers, walls that push, rate, time step and damping change.

Every setting is run on the same specimens.
"""
from studies.free_grains import figures, plan, tables
from studies.tables import report_of

DEFAULTS, QUICK = {"seeds": 20}, {"seeds": 1}
report = report_of(tables.Results, figures.draw)


def runs(options):
    return plan.runs(options.seeds)

# SPDX-License-Identifier: BSD-3-Clause
"""Speed against error: how far tests are from balance and convergence, static and dynamic, and what they cost.

Every setting is run on the same specimens; differences are taken specimen by specimen.
"""
from studies.speed_error import figures, plan, tables
from studies.tables import report_of

DEFAULTS, QUICK = {"seeds": 20}, {"seeds": 1}
report = report_of(tables.Results, figures.draw)


def runs(options):
    return plan.runs(options.seeds)

# SPDX-License-Identifier: BSD-3-Clause
"""The paper's undrained tests and the liquefaction resistance under four pressures, with both contact laws."""
from studies.two_laws import plan
from studies.two_laws.report import write as report

DEFAULTS, QUICK = {"seeds": 3}, {"seeds": 1}


def runs(options):
    return plan.runs(options.seeds)


__all__ = ["DEFAULTS", "QUICK", "report", "runs"]

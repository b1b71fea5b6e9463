# SPDX-License-Identifier: BSD-3-Clause
"""Stress against the number of grains: scatter of p' and q between specimens, and drift of their mean.

    isostat study stress_against_n --grains 500 1000 2000 --rate 0.8
"""
from studies.stress_against_n import plan
from studies.stress_against_n.report import write as report

DEFAULTS = {"seeds": 10, "grains": [500, 1000, 2000, 5000, 10000], "rate": 0.5}
QUICK = {"seeds": 3, "grains": [200, 400, 800], "rate": 2}


def add_options(line):
    line.add_argument("--grains", type=int, nargs="+", help="of the specimens (default: 500 to 10,000)")
    line.add_argument("--rate", type=float, help="of axial strain, 1/s (default 0.5)")


def runs(options):
    return [plan.Run(grains, seed, options.rate) for seed in range(1, options.seeds + 1)
            for grains in sorted(set(options.grains))]


__all__ = ["DEFAULTS", "QUICK", "add_options", "report", "runs"]

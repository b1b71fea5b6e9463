# SPDX-License-Identifier: BSD-3-Clause
"""Stiffness against pressure, wave speed against depth, modulus reduction and damping, with both contact laws."""
from studies.small_strain import plan
from studies.small_strain.report import write as report

DEFAULTS = {"seeds": 3, "grains": 1000, "parts": list(plan.PARTS), "amplitudes": plan.AMPLITUDES}
QUICK = {"seeds": 1, "grains": 200, "amplitudes": [1e-4]}


def add_options(line):
    line.add_argument("--grains", type=int, help="of a packing (default 1000)")
    line.add_argument("--amplitudes", type=float, nargs="+", help="of shear strain (default: 1e-6 to 1e-2)")
    line.add_argument("--parts", nargs="+", choices=plan.PARTS, help="default: all")


def runs(options):
    given = options.seeds, options.grains, options.amplitudes
    return [run for part in options.parts for run in plan.PARTS[part](*given)]


__all__ = ["DEFAULTS", "QUICK", "add_options", "report", "runs"]

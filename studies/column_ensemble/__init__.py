# SPDX-License-Identifier: BSD-3-Clause
"""What a column of grains that liquefies depends on: mesh, packings of a point, the same at all depths or not, seeds.

The scene is apps/scenes/column/quick_ensemble.toml; a seed is a member of the ensemble.
"""
from studies import columns
from studies.column_ensemble import plan
from studies.column_ensemble.report import write as report

DEFAULTS, QUICK, PAGE = {"seeds": 8}, {"seeds": 1}, "ensemble"


def prepare(options, executor):
    """Specimens at 20 kPa."""
    for grains, n in ((plan.GRAINS, plan.SEEDS), (plan.LARGE, plan.LARGE_SEEDS))[:1 if options.quick else 2]:
        columns.library(plan.library_of(options.output, grains), executor, n, ["20 kPa"], {
            "contact.young": "1 GPa", "grading.grains": grains,
            "grading.cloud_edge": f"{3.107 * (grains / 300) ** (1 / 3):.3f} mm"})


def runs(options):
    return plan.runs(options.output, options.seeds)


__all__ = ["DEFAULTS", "PAGE", "QUICK", "prepare", "report", "runs"]

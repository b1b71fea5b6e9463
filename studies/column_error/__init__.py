# SPDX-License-Identifier: BSD-3-Clause
"""What speed costs in a column of grains: size of the packings, rates inside them, FE step, mesh, realisation.

The scene is apps/scenes/column/quick_grains_10m.toml with K0 = 0.6 under 20 kPa, shaken weakly, moderately and
strongly. One setting is varied at a time. Runs of the same seed, number of grains and mesh start from the same
packings: those that the default settings brought to the stress in situ.
"""
from isostat import RunFailure
from isostat.campaign.runs import complete
from isostat.campaign.study import Store
from studies.column_error import plan
from studies.column_error.report import write as report

DEFAULTS, QUICK = {"seeds": 10, "levels": list(plan.LEVELS)}, {"seeds": 1, "levels": ["weak"]}


def add_options(line):
    line.add_argument("--levels", nargs="+", choices=plan.LEVELS, help="of shaking (default: all)")


def runs(options):
    return [run for level in options.levels for run in plan.runs(options.output, level, options.seeds)
            if run.grains == 250 or not options.quick]


def prepare(options, executor):
    """Libraries; and packings in situ of the default settings, where runs with others share them."""
    planned = runs(options)
    for grains in sorted({run.grains for run in planned}):
        plan.write_library(options.output, executor, grains, min(plan.SEEDS[grains], options.seeds + 2))
    sharing = [run for run in planned if run.shares_packings]
    makers = {(run.grains, run.seed): plan.Run(options.output, "weak", "default", "default", grains=run.grains,
                                               seed=run.seed) for run in sharing}.values()
    store = Store(options.output, makers)
    print(f"packings in situ: {len(makers)} runs", flush=True)
    complete(executor, [store.run(run) for run in makers if not store.is_done(run)])
    for run in makers:
        if not store.is_done(run):
            raise RunFailure(f"{run.name}: {store.run(run).last_line}")
    for run in sharing:
        plan.share_packings(plan.in_situ(options.output, run.grains), run.cache, run.motion)


__all__ = ["DEFAULTS", "QUICK", "add_options", "prepare", "report", "runs"]

# SPDX-License-Identifier: BSD-3-Clause
"""isostat calibrate: finds parameters of a scene from laboratory curves, with element tests of small packings.

     laboratory (CSV)          plan: curves, parameters with bounds, specimens, budget
        |                        |
        |    misfit <-- curves <-- element_test, the same seeds in every trial <-- values <--.
        '------^  |                                                                          |
                  '--> start, Sobol design, then NLopt from the best of them ----------------'

Its folder:

     plan.toml  scene.toml  laboratory/NAME.csv   what makes its results: distinguishes this calibration from others
     runs/TRIAL/CURVE_seedN/                      results of a run; next to it .toml (scene), .log, .failed (why)
     specimens/                                   prepared for them
     trials.csv  curves.csv  calibrate.json  summary.txt  best_scene.toml  best_sand.toml  best/CURVE.toml  figures/

tested: tests/apps/calibrate_test.py
"""
import argparse
import concurrent.futures
import math
import pathlib
import re
from collections.abc import Callable
from typing import Any

import numpy as np

from isostat import _core
from isostat.campaign import command
from isostat.campaign.calibrate.keys import default_plan, plan_text
from isostat.campaign.calibrate.plan import read_plan, read_text
from isostat.campaign.calibrate.report import Report, remarks
from isostat.campaign.calibrate.scenes import SceneMaker
from isostat.campaign.calibrate.trials import Trials
from isostat.campaign.engines import library
from isostat.campaign.folder import CampaignFolder

BUDGET = re.compile(r"^\[budget\]\n[^\[]*", re.MULTILINE)
ALGORITHMS = {"bobyqa": "LN_BOBYQA", "sbplx": "LN_SBPLX", "crs2": "GN_CRS2_LM"}
SEED = 1  # of CRS2


class Folder(CampaignFolder):
    """That of a calibration: the budget, which does not make its results, may be another one."""

    def check(self, kept, owner, overwrite):
        plan = self.path / "plan.toml"
        if not overwrite and (self.path / "summary.txt").exists() and not plan.exists():
            raise _core.InputError(f"{self.path}: holds results of another program, since there is no plan.toml in it. "
                                   "Choose another --output.")
        budget = BUDGET.search(plan.read_text(encoding="utf-8", errors="replace")) if plan.is_file() else None
        text = BUDGET.sub(lambda _: budget[0], kept["plan.toml"]) if budget else kept["plan.toml"]
        super().check({**kept, "plan.toml": text}, owner, overwrite)


class BudgetUsed(Exception):
    """Raised by an objective whose budget is used up: why."""


def nlopt() -> Any:
    """The library.   Raises InputError (it is not installed)"""
    return library("nlopt", "python3-nlopt", "calibrate")


def sobol_design(dimensions: int, n: int) -> list[list[float]]:
    """n points of a design: a Sobol sequence in the unit cube (Sobol 1967), without the origin."""
    sequence = library("scipy.stats", "python3-scipy", "calibrate").qmc.Sobol(dimensions, scramble=False)
    sequence.fast_forward(1)
    return sequence.random(n).tolist()


def search(settings: Any, start: list[float], objective: Callable[[list[float]], float]) -> str:
    """Looks for a smaller value from `start` on, in the unit cube, by NLopt: BOBYQA (Powell 2009), Sbplx (Rowan 1990)
    or CRS2 with local mutation (Kaelo and Ali 2006). It always asks for the same points in the same order, so that it
    can be repeated from known values. The best point is not returned: the objective knows what it has been asked.

    Returns why it ended.   Raises what the objective raises, except for BudgetUsed
    """
    optimiser = nlopt()
    optimiser.srand(SEED)
    n = len(start)
    algorithm = optimiser.opt(getattr(optimiser, ALGORITHMS[settings.method]), n)
    algorithm.set_lower_bounds(np.zeros(n))
    algorithm.set_upper_bounds(np.ones(n))
    algorithm.set_initial_step(np.full(n, settings.first_step))
    algorithm.set_xtol_abs(settings.tolerance)
    raised: list[BaseException] = []  # NLopt does not pass on all that is raised

    def guarded(shares, _):
        try:
            return objective(shares.tolist()) if not raised else 0.0
        except BaseException as error:
            raised.append(error)
            algorithm.force_stop()
            return 0.0

    algorithm.set_min_objective(guarded)
    ending = f"steps became smaller than {settings.tolerance:g} of the bounds"
    try:
        algorithm.optimize(start)
    except optimiser.ForcedStop:
        pass
    except optimiser.RoundoffLimited:
        ending = "no step of the method makes the misfit smaller"
    if raised and not isinstance(raised[0], BudgetUsed):
        raise raised[0]
    return str(raised[0]) if raised else ending


def first_points(plan: Any, scenes: SceneMaker) -> list[list[float]]:
    """The start, and the design; no more than the budget."""
    shares = sobol_design(len(scenes.parameters), min(plan.optimiser.design, plan.budget.trials - 1))
    return [values_at(scenes, point) for point in [[p.start for p in scenes.parameters], *shares]]


def values_at(scenes: SceneMaker, shares: list[float]) -> list[float]:
    return [parameter.value(share) for parameter, share in zip(scenes.parameters, shares)]


def check_first(trials: Trials) -> None:
    """A curve that no trial can run says nothing, and never will."""
    for k, curve in enumerate(trials.plan.curve):
        failures = [outcome.failure if (outcome := trial.curves[k]) else "" for trial in trials.all]
        if all(failures):
            density = next((f" ({name} = {vars(curve)[name]:g})" for name in ("relative_density", "void_ratio")
                            if vars(curve)[name] is not None), "")
            raise _core.InputError(
                f"{curve.where}: curve \"{curve.name}\"{density}: none of the first {len(failures)} trials could be "
                f"run. The first, {failures[0]}\n  Correct the curve's density or pressure, the bounds, or the number "
                "of grains; all runs are in the folder of trials.csv.")


def find_best(plan: Any, scenes: SceneMaker, trials: Trials) -> str:
    """Start, design and search.   Returns why it ended"""
    trials.evaluate(first_points(plan, scenes))
    check_first(trials)
    limit = 60 * float(plan.budget.time.split()[0]) if plan.budget.time else math.inf  # as scenes write it, in min

    def objective(shares):
        values = values_at(scenes, shares)
        if not trials.is_known(values) and len(trials.all) >= plan.budget.trials:
            raise BudgetUsed(f"budget.trials = {plan.budget.trials} are used up")
        if not trials.is_known(values) and trials.seconds > limit:
            raise BudgetUsed("budget.time is used up; the same command continues")
        return trials.evaluate([values])[0].misfit ** 2  # near the best a parabola, which the misfit itself is not

    start = trials.best().values
    return search(plan.optimiser, [p.share(value) for p, value in zip(scenes.parameters, start)], objective)


def dry_run(plan: Any, scenes: SceneMaker) -> str:
    """What would be run; checks the scenes of the first trial.   Raises InputError"""
    for curve in plan.curve:
        scenes.trial(values_at(scenes, [p.start for p in scenes.parameters]), curve, plan.specimens.first_seed)
    sizes, fitted = plan.specimens, sum(not curve.blind for curve in plan.curve)
    runs, blind = fitted * sizes.seeds, 2 * (len(plan.curve) - fitted) * sizes.seeds
    lines = [plan.title, f"runs per trial           {runs} ({fitted} curves, {sizes.seeds} seeds), each of "
             f"{sizes.grains} grains",
             f"runs in all              at most {runs * plan.budget.trials}, and {blind} for the blind curves of start "
             "and best", "time                     unknown before the first trial; the progress lines report it"]
    width = max(len(p.label) for p in scenes.parameters)
    lines += [f"{p.label:<{width}} from {p.text(p.low)} to {p.text(p.high)}, start {p.text(p.value(p.start))}"
              for p in scenes.parameters]
    return "\n  ".join(lines) + "\n" + remarks(scenes.parameters)


def calibrate(options: argparse.Namespace, executor: concurrent.futures.Executor) -> None:
    if not options.plan:
        raise _core.InputError("no plan given. Try isostat calibrate quick_karlsruhe.toml, or --help.")
    folder = options.output or pathlib.Path("results") / pathlib.Path(options.plan).stem
    nlopt()  # before hours of runs
    plan = read_plan(options.plan)
    scenes = SceneMaker(plan)
    trials = Trials(plan, scenes, folder, executor, options.quiet)
    kept = {"scene.toml": scenes.text, "plan.toml": plan_text(plan),
            **{f"laboratory/{curve.name}.csv": read_text(curve.path, "a table") for curve in plan.curve}}
    if options.dry_run:
        text = dry_run(plan, scenes)
        Folder(folder, kept, owner="calibration", overwrite=options.overwrite, only_check=True)
        print(text, end="")
        return
    Folder(folder, kept, owner="calibration", overwrite=options.overwrite)
    try:
        ending = find_best(plan, scenes, trials)
        start, best = trials.all[0], trials.best()
        trials.execute([start] if best is start else [start, best], True)
    except KeyboardInterrupt:
        if trials.best() is not None:
            Report(trials, "it was interrupted; the same command continues").leave(folder, False)
        raise
    Report(trials, ending).leave(folder, not options.no_figures)


def main(words: list[str]) -> int:
    line = command.line_of("calibrate", "Calibration: finds parameters of a scene from laboratory curves with small "
                           "element tests")
    line.add_argument("plan", metavar="PLAN", nargs="?", type=lambda name: command.shipped("scenes/calibrate", name),
                      help="plan file (TOML); see docs/campaigns/calibrate.md")
    line.add_argument("--dry-run", action="store_true", help="check the plan, print how many runs it needs, and stop")
    line.add_argument("--print-defaults", action="store_true",
                      help="print a commented plan with all keys, units and ranges")
    command.add_campaign(line, "results/<plan name>")
    options = line.parse_args(words)
    if options.print_defaults:
        return command.run(lambda: print(default_plan(), end=""))
    return command.run_campaign(options, lambda executor: calibrate(options, executor))

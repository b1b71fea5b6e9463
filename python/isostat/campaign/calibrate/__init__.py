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
     trials.csv  curves.csv  calibrate.json  summary.txt  best_scene.toml  best/CURVE.toml  figures/

tested: tests/apps/calibrate_test.py
"""
import argparse
import concurrent.futures
import math
import pathlib
import re
from typing import Any

from isostat import _core
from isostat.campaign import command
from isostat.campaign.calibrate.keys import default_plan, plan_text
from isostat.campaign.calibrate.plan import read_plan, read_text
from isostat.campaign.calibrate.report import Report, remarks
from isostat.campaign.calibrate.scenes import SceneMaker
from isostat.campaign.calibrate.search import BudgetUsed, nlopt, search, sobol_design
from isostat.campaign.calibrate.trials import Trials
from isostat.campaign.folder import CampaignFolder

BUDGET = re.compile(r"^\[budget\]\n[^\[]*", re.MULTILINE)


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
        if trials.find(values) is None:
            if len(trials.all) >= plan.budget.trials:
                raise BudgetUsed(f"budget.trials = {plan.budget.trials} are used up")
            if trials.seconds > limit:
                raise BudgetUsed("budget.time is used up; the same command continues")
        trials.evaluate([values])
        return trials.all[trials.find(values)].misfit ** 2  # near the best a parabola, which the misfit itself is not

    start = trials.all[trials.best()].values
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
        trials.execute(sorted({0, trials.best()}), True)
    except KeyboardInterrupt:
        if trials.best() is not None:
            Report(trials, "it was interrupted; the same command continues").leave(folder, False)
        raise
    Report(trials, ending).leave(folder, not options.no_figures)


def main(words: list[str]) -> int:
    line = argparse.ArgumentParser(prog="isostat calibrate", description="Calibration: finds parameters of a scene "
                                   "from laboratory curves with small element tests")
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

# SPDX-License-Identifier: BSD-3-Clause
"""isostat resistance: the resistance curve of a sand, cyclic stress ratio against cycles to initial liquefaction.

     CSR |  o o                CSR = tau_amp / sigma'_v0 in simple shear, q_amp / (2 p0') in triaxial tests
         |    o o o            every o is a run of element_test; specimens (seeds 1..n) are shared between ratios
         |        o  oo        finished runs are kept, the same command continues
         |            o  o->   fit CSR = a N^-b; runs that do not liquefy are arrows and not in the fit
         +--------------- log N

tested: tests/apps/resistance_test.py
"""
import argparse
import concurrent.futures
import pathlib

import numpy as np

from isostat import _core
from isostat.campaign import command
from isostat.campaign.folder import CampaignFolder
from isostat.campaign.resistance.outcome import Outcome
from isostat.campaign.resistance.report import report
from isostat.campaign.resistance.scenes import Campaign, parse_ratios
from isostat.campaign.runs import Run, complete
from isostat.scene import Scene

OUTCOMES = {"liquefied": "liquefied after {0.to_liquefaction:g} cycles", "failed": "FAILED, {0.note}",
            "censored": "not liquefied in {0.cycles:g} cycles", "missing": "interrupted",
            "strain": "not liquefied, strain limit after {0.cycles:g} cycles"}


def do_runs(campaign: Campaign, runs: list[tuple[Run, Outcome]], folder: pathlib.Path,
            executor: concurrent.futures.Executor, options: argparse.Namespace) -> None:
    """Specimens first. What fails is noted and does not stop the rest."""
    outcomes = {run: outcome for run, outcome in runs}
    progress = command.Progress(lambda: state(list(outcomes.values()), options.jobs), options.quiet)
    for run, outcome in runs:
        if run.is_finished:
            campaign.take(run, outcome)
    specimens = dict(campaign.preparations(folder, runs))

    def specimen_ended(run, code, seconds):
        for outcome in outcomes.values() if code not in (0, 130) else ():
            if outcome.seed == specimens[run] and outcome.status == "missing":
                outcome.status, outcome.note = "failed", f"exit code {code}: {run.reason}"
        progress.say(f"  {run.name}: {'ready' if code == 0 else 'FAILED'}, {seconds:.0f} s")

    def run_ended(run, code, seconds):
        campaign.take(run, outcomes[run], code)
        progress.say(f"  {run.name}: {OUTCOMES[outcomes[run].status].format(outcomes[run])}, {seconds:.0f} s")

    complete(executor, specimens, specimen_ended, progress.waiting)
    complete(executor, [run for run, outcome in runs if outcome.status == "missing"], run_ended, progress.waiting)


def state(outcomes: list[Outcome], jobs: int) -> str:
    """" 27 %  4 of 15 runs, ETA 6 min": by the mean time of the runs of a ratio, or of all."""
    def seconds(ratio):
        known = [outcome.seconds for outcome in outcomes if outcome.seconds is not None]
        return np.mean([r.seconds for r in outcomes if r.seconds is not None and r.ratio == ratio] or known)
    missing = [outcome.ratio for outcome in outcomes if outcome.status == "missing"]
    done = len(outcomes) - len(missing)
    text = f"{100 * done / len(outcomes):3.0f} %  {done} of {len(outcomes)} runs"
    if missing and any(outcome.seconds is not None for outcome in outcomes):
        text += f", ETA {command.duration_text(sum(map(seconds, missing)) / max(1, jobs))}"
    return text


def find_resistance(options: argparse.Namespace, executor: concurrent.futures.Executor) -> None:
    ratios = parse_ratios(options.ratios)
    scene = Scene(options.scene, set=command.overrides(options.set))
    folder = options.output or pathlib.Path(f"{scene.folder}_resistance")
    campaign = Campaign(scene, ratios, options)
    runs = campaign.runs(folder)
    CampaignFolder(folder, {"scene.toml": Scene(campaign.shared).text}, overwrite=options.overwrite)
    try:
        do_runs(campaign, runs, folder, executor, options)
    finally:
        report(campaign, [outcome for _, outcome in runs], folder, not options.no_figures)
    if any(outcome.status == "failed" for _, outcome in runs):
        raise _core.RunFailure("some runs failed (see above); the others are kept, the same command tries again")


def main(words: list[str]) -> int:
    line = command.line_of("resistance", "Liquefaction resistance: cyclic stress ratio against cycles to initial "
                           "liquefaction")
    command.add_scene(line, "scene file (TOML) with one cyclic stage, the last and only one that shears")
    line.add_argument("--ratios", required=True, help="cyclic stress ratios, e.g. 0.10,0.15,0.20: tau_amp / sigma'_v0 in "
                      "simple shear, q_amp / (2 p0') in triaxial tests")
    line.add_argument("-n", "--realisations", type=command.count(1, 1000), default=3,
                      help="specimens per ratio: seeds 1 to this (default 3)")
    line.add_argument("--cycles", type=command.count(1, 100000), default=100, help="a run ends after this many (default 100)")
    line.add_argument("--reversals-after", type=command.count(0, 1000), default=1,
                      help="a run ends after this many reversals since liquefaction (default 1; 0: at once)")
    command.add_campaign(line, "results/<scene name>_resistance")
    options = line.parse_args(words)
    return command.run_campaign(options, lambda executor: find_resistance(options, executor))

# SPDX-License-Identifier: BSD-3-Clause
"""Karlsruhe fine sand by Hertz-Mindlin contacts, from packings that are opened after compaction.

A design of trials of isostat calibrate, with the three fitted tests of the installed plan karlsruhe_drained.toml, makes
the curves linear in the parameters (posterior.py). The best set and an earlier one of compacted packings then run on
other packings: drained, undrained and cyclic tests. Draws of the posterior and dense packings made otherwise follow.
"""
import argparse
import os
import tomllib

import isostat
from isostat.campaign.calibrate import calibrate
from isostat.scene import toml_text
from studies.sand_calibration import results
from studies.sand_calibration.posterior import PARAMETERS
from studies.sand_calibration.predictions import (CONTACT, DRAWS, FIRST_SEED, LIKE_PAPER, PLAN, curves, cyclic_tests,
                                                  drained, small_strain, undrained, variants)
from studies.scenes import scene_of

DEFAULTS, QUICK, PAGE = {"seeds": 2, "trials": 23}, {"seeds": 1, "trials": 12}, "calibration"
GRAINS, DESIGN_SEEDS, PACE = 800, 1, 2e-3  # of trials; PACE: inertial number


def add_options(line):
    line.add_argument("--trials", type=int, help="of the design")


def plan_of(trials, folder):
    """The plan of the design and its scene, as dictionaries, of the fitted curves alone.
    folder: that of the plan, from which its files count"""
    plan = tomllib.loads(PLAN.read_text(encoding="utf-8"))
    plan["curve"] = [curve | {"file": os.path.relpath(PLAN.parent / curve["file"], folder)}
                     for curve in curves().values() if not curve.get("blind")]
    plan |= {"title": "Karlsruhe fine sand, opened", "scene": "opened_scene.toml", "parameter": PARAMETERS,
             "specimens": {"grains": GRAINS, "first_seed": 1, "seeds": DESIGN_SEEDS, "inertial_number": PACE},
             "budget": {"trials": trials}, "optimiser": {"design": trials - 1}}
    scene = scene_of(plan["title"], 10000, 1, {"domain": "periodic-cell", "pressure": "200 kPa",
                                               "preparation_friction": "10 deg"},
                     [{"kind": "drained", "strain": 0.1}], contact=CONTACT)
    return plan, scene


def prepare(options, executor):
    """The design of trials."""
    inputs = options.output / "plans"
    inputs.mkdir(parents=True, exist_ok=True)
    plan, scene = plan_of(options.trials, inputs)
    (inputs / plan["scene"]).write_text(isostat.Scene(scene).text, encoding="utf-8")
    (inputs / "design.toml").write_text(toml_text(plan), encoding="utf-8")
    calibrate(argparse.Namespace(plan=str(inputs / "design.toml"), output=options.output / "design", dry_run=False,
                                 overwrite=options.overwrite, quiet=options.quiet, no_figures=True), executor)


def runs(options):
    """The quick form has no draws. Draws and compacted packings have the cyclic tests that are known."""
    seeds = range(FIRST_SEED, FIRST_SEED + options.seeds)

    def found(contact, *kinds, draws=range(1)):
        return [run for of in kinds for draw in draws for seed in (seeds if draw == 0 else seeds[:1])
                for run in of(options.output, contact, seed, draw)]
    draws = range(1, 1 if options.quick else 1 + DRAWS)
    known = "TCUI1", "TCUI4", *LIKE_PAPER
    return [*found("opened", drained, undrained, cyclic_tests), *found("compacted", drained, undrained),
            *variants(options.output, seeds), *found("opened", undrained, draws=draws),
            *(run for run in found("opened", cyclic_tests, draws=draws) + found("compacted", cyclic_tests)
              if run.test in known), *found("opened", small_strain), *found("compacted", small_strain)]


def report(store, planned, folder):
    results.report(store, planned, folder)

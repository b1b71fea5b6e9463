# SPDX-License-Identifier: BSD-3-Clause
"""Karlsruhe fine sand by Hertz-Mindlin contacts, from packings that are opened after compaction.

A design of trials of isostat calibrate, with the three fitted tests of the installed plan karlsruhe_drained.toml, makes
the curves linear in the parameters (posterior.py). The best set then runs on other packings; undrained and cyclic tests
are predicted by it and by draws of the posterior, and with other expansions.
"""
import argparse
import os
import tomllib

import isostat
from isostat.campaign.calibrate import calibrate
from isostat.scene import toml_text
from studies.sand_calibration import posterior, results
from studies.sand_calibration.posterior import PARAMETERS
from studies.sand_calibration.predictions import (FIRST_SEED, PLAN, curves, cyclic_tests, drained, expansions,
                                                  small_strain, undrained)
from studies.scenes import scene_of

DEFAULTS, QUICK, PAGE = {"seeds": 2, "trials": 23}, {"seeds": 1, "trials": 8}, "calibration"
GRAINS, DESIGN_SEEDS, BEST_SEEDS, PACE = 800, 1, 2, 2e-3  # of trials; PACE: inertial number
CONTACT = {"law": "hertz-mindlin", "young": "65 GPa", "friction": "25 deg", "rolling": {"stiffness": 0.3, "limit": 0.1},
           "twisting": {"stiffness": 0.3}}  # quartz; the two others are fitted


def add_options(line):
    line.add_argument("--trials", type=int, help="of the design")


def plan_of(parameters, trials, seeds, folder):
    """A plan and its scene, as dictionaries, of the fitted curves alone.
    seeds: (first, how many)   folder: that of the plan, from which its files count"""
    plan = tomllib.loads(PLAN.read_text(encoding="utf-8"))
    plan["curve"] = [curve | {"file": os.path.relpath(PLAN.parent / curve["file"], folder)}
                     for curve in curves().values() if not curve.get("blind")]
    plan |= {"title": "Karlsruhe fine sand, opened", "scene": "opened_scene.toml", "parameter": parameters,
             "specimens": {"grains": GRAINS, "first_seed": seeds[0], "seeds": seeds[1], "inertial_number": PACE},
             "budget": {"trials": trials}, "optimiser": {"design": trials - 1}}
    scene = scene_of(plan["title"], 10000, 1, {"domain": "periodic-cell", "pressure": "200 kPa",
                                               "preparation_friction": "10 deg"},
                     [{"kind": "drained", "strain": 0.1}], contact=CONTACT)
    return plan, scene


def prepare(options, executor):
    """The design, and the best set on other packings."""
    inputs = options.output / "plans"
    inputs.mkdir(parents=True, exist_ok=True)

    def run(name, parameters, trials, seeds):
        plan, scene = plan_of(parameters, trials, seeds, inputs)
        (inputs / plan["scene"]).write_text(isostat.Scene(scene).text, encoding="utf-8")
        (inputs / f"{name}.toml").write_text(toml_text(plan), encoding="utf-8")
        calibrate(argparse.Namespace(plan=str(inputs / f"{name}.toml"), output=options.output / name,
                                     dry_run=False, overwrite=options.overwrite, quiet=options.quiet,
                                     no_figures=True), executor)

    run("design", PARAMETERS, options.trials, (1, DESIGN_SEEDS))
    best = posterior.fit(options.output).best
    run("opened", posterior.starting(PARAMETERS, best), 1, (FIRST_SEED, 1 if options.quick else BEST_SEEDS))


def runs(options):
    seeds = range(FIRST_SEED, FIRST_SEED + options.seeds)
    return [test for tests, of in ((small_strain, seeds), (undrained, seeds), (drained, seeds), (cyclic_tests, seeds),
                                   (expansions, seeds[:1])) for test in tests(options.output, "opened", of)]


def report(store, planned, folder):
    results.report(store, planned, folder, ["opened"])

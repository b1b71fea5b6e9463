# SPDX-License-Identifier: BSD-3-Clause
"""Karlsruhe fine sand by Hertz-Mindlin contacts: packings that are compacted, and opened after that.

A design of trials of isostat calibrate, with the three fitted tests of the installed plan karlsruhe_drained.toml, makes
the curves linear in the parameters (posterior.py). The best set then runs on more and other packings, and so does the
best one of compaction alone, which was found before. Undrained and cyclic tests are predicted by draws of the
posterior.
"""
import argparse
import os
import tomllib

import isostat
from isostat.campaign.calibrate import calibrate
from isostat.scene import toml_text
from studies.sand_calibration import posterior, predictions, results
from studies.sand_calibration.posterior import PARAMETERS
from studies.sand_calibration.predictions import (FIRST_SEED, PLAN, curves, cyclic_tests, drained, small_strain,
                                                  undrained)
from studies.scenes import scene_of

DEFAULTS, QUICK, PAGE = {"seeds": 3, "trials": 32}, {"seeds": 1, "trials": 8}, "calibration"
GRAINS, DESIGN_SEEDS, BEST_SEEDS, PACE = 800, 1, 4, 2e-3  # of trials; PACE: inertial number
MOMENTS = {"law": "hertz-mindlin", "friction": "25 deg", "rolling": {"stiffness": 0.3, "limit": 0.1},
           "twisting": {"stiffness": 0.3}}
CONTACTS = {"compacted": MOMENTS | {"young": "38 GPa"},  # chosen for the modulus at 100 kPa
            "opened": MOMENTS | {"young": "65 GPa"}}  # quartz
COMPACTED = (25, 0.1, 26, 17, 6.9)  # PARAMETERS but the expansion, as fitted to the same tests before


def add_options(line):
    line.add_argument("--trials", type=int, help="of the design")


def plan_of(contact, parameters, trials, seeds, folder):
    """A plan of a contact, and its scene, as dictionaries. A design is of the fitted curves alone.
    seeds: (first, how many)   folder: that of the plan, from which its files count"""
    plan = tomllib.loads(PLAN.read_text(encoding="utf-8"))
    plan["curve"] = [curve | {"file": os.path.relpath(PLAN.parent / curve["file"], folder)}
                     for curve in curves().values() if trials == 1 or not curve.get("blind")]
    plan |= {"title": f"Karlsruhe fine sand, {contact}", "scene": f"{contact}_scene.toml", "parameter": parameters,
             "specimens": {"grains": GRAINS, "first_seed": seeds[0], "seeds": seeds[1], "inertial_number": PACE},
             "budget": {"trials": trials}, "optimiser": {"design": trials - 1}}
    scene = scene_of(plan["title"], 10000, 1, {"domain": "periodic-cell", "pressure": "200 kPa",
                                               "preparation_friction": "10 deg"},
                     [{"kind": "drained", "strain": 0.1}], contact=CONTACTS[contact])
    return plan, scene


def prepare(options, executor):
    """The design, and from it the best set of opened packings; both best sets on other packings."""
    inputs = options.output / "plans"
    inputs.mkdir(parents=True, exist_ok=True)

    def run(name, contact, parameters, trials, seeds):
        plan, scene = plan_of(contact, parameters, trials, seeds, inputs)
        (inputs / plan["scene"]).write_text(isostat.Scene(scene).text, encoding="utf-8")
        (inputs / f"{name}.toml").write_text(toml_text(plan), encoding="utf-8")
        calibrate(argparse.Namespace(plan=str(inputs / f"{name}.toml"), output=options.output / name,
                                     dry_run=False, overwrite=options.overwrite, quiet=options.quiet,
                                     no_figures=True), executor)

    run("design", "opened", PARAMETERS, options.trials, (1, DESIGN_SEEDS))
    best = posterior.fit(options.output).best
    others = (FIRST_SEED, 1 if options.quick else BEST_SEEDS)
    run("opened", "opened", posterior.starting(PARAMETERS, best), 1, others)
    without = [one for one in PARAMETERS if one["key"] != "specimen.expansion"]
    run("compacted", "compacted", posterior.starting(without, COMPACTED), 1, others)


def runs(options):
    seeds = range(FIRST_SEED, FIRST_SEED + options.seeds)
    cases = [(small_strain, contact) for contact in CONTACTS]
    return [test for of, contact in [*cases, *((of, "opened") for of in (undrained, drained, cyclic_tests))]
            for test in of(options.output, contact, seeds)]


def report(store, planned, folder):
    results.report(store, planned, folder, list(CONTACTS))

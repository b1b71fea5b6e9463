# SPDX-License-Identifier: BSD-3-Clause
"""Karlsruhe fine sand by four contacts: each is fitted to three drained tests, then other tests are predicted.

`isostat calibrate` fits each contact by the installed plan karlsruhe_drained.toml, without young, which was chosen
beforehand so that packings have the shear modulus of sand at 100 kPa. Contacts without moments start from the largest
friction. Undrained and cyclic tests are those of the contact with the least misfit of drained tests that were
not fitted.
"""
import argparse
import os
import tomllib

import isostat
from isostat.campaign.calibrate import calibrate
from isostat.scene import toml_text
from studies.sand_calibration import predictions, results
from studies.sand_calibration.predictions import (FIRST_SEED, PLAN, curves, cyclic_tests, drained, fit_of,
                                                  small_strain, undrained)
from studies.scenes import scene_of

DEFAULTS, QUICK, PAGE = {"seeds": 2, "trials": 14}, {"seeds": 1, "trials": 2}, "calibration"
GRAINS, FITTED_SEEDS, PACE = 800, 3, 2e-3  # of trials; PACE: inertial number
LINEAR = {"law": "linear-rolling", "young": "1.45 GPa", "stiffness_ratio": 0.3, "friction": "25 deg"}
QUARTZ = {"law": "hertz-mindlin", "young": "38 GPa", "friction": "25 deg"}
MOMENTS = {"rolling": {"stiffness": 0.3, "limit": 0.1}, "twisting": {"stiffness": 0.3}}
CONTACTS = {"linear_rolling": LINEAR | MOMENTS, "hertz_rolling": QUARTZ | MOMENTS, "linear": LINEAR, "hertz": QUARTZ}


def add_options(line):
    line.add_argument("--trials", type=int, help="of each contact at most, a third of it without moments")


def plan_of(contact, trials, folder):
    """Of a contact, and its scene, as dictionaries.   folder: that of the plan, from which its files count"""
    plan = tomllib.loads(PLAN.read_text(encoding="utf-8"))
    free = "rolling" not in CONTACTS[contact]
    keys = ["contact.friction", "specimen.preparation_friction", "contact.rolling.limit"][:3 - free]
    plan["parameter"] = [one | ({"start": one["bounds"][1]} if free and one["key"] == keys[0] else {})
                         for one in plan["parameter"] if one["key"] in keys]
    plan["curve"] = [curve | {"file": os.path.relpath(PLAN.parent / curve["file"], folder)}
                     for curve in curves().values()]
    plan |= {"title": f"Karlsruhe fine sand, {contact}", "scene": f"{contact}_scene.toml",
             "specimens": {"grains": GRAINS, "seeds": FITTED_SEEDS, "inertial_number": PACE},
             "budget": {"trials": trials // 3 if free else trials},
             "optimiser": {"design": 0, "first_step": 0.1, "tolerance": 0.01}}
    scene = scene_of(plan["title"], 10000, 1, {"domain": "periodic-cell", "pressure": "200 kPa",
                                               "preparation_friction": "10 deg"},
                     [{"kind": "drained", "strain": 0.1}], contact=CONTACTS[contact])
    return plan, scene


def prepare(options, executor):
    """Fits every contact."""
    inputs = options.output / "plans"
    inputs.mkdir(parents=True, exist_ok=True)
    for contact in CONTACTS:
        plan, scene = plan_of(contact, options.trials, inputs)
        (inputs / plan["scene"]).write_text(isostat.Scene(scene).text, encoding="utf-8")
        (inputs / f"{contact}.toml").write_text(toml_text(plan), encoding="utf-8")
        calibrate(argparse.Namespace(plan=str(inputs / f"{contact}.toml"), output=options.output / contact,
                                     dry_run=False, overwrite=options.overwrite, quiet=options.quiet,
                                     no_figures=options.quick), executor)


def runs(options):
    seeds = range(FIRST_SEED, FIRST_SEED + options.seeds)
    fits = {contact: fit_of(options.output / contact) for contact in CONTACTS}
    best = min(CONTACTS, key=lambda contact: fits[contact].blind if all(fits.values()) else 0)
    cases = [(of, contact) for contact in CONTACTS if "rolling" in CONTACTS[contact] for of in (small_strain, drained)]
    return [test for of, contact in [*cases, (undrained, best), (cyclic_tests, best)]
            for test in of(options.output, contact, seeds)]


def report(store, planned, folder):
    results.report(store, planned, folder, list(CONTACTS))

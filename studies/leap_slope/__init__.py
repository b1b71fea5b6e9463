# SPDX-License-Identifier: BSD-3-Clause
"""LEAP-UCD-2017: Ottawa F65 fitted to drained tests, then a cyclic test and the submerged slope predicted.

The contact is fitted to peak friction over a grid (drained.py); its numbers are those of the installed sand ottawa-f65.
Tests of other packings of this sand, the cyclic test (cyclic.py) and slopes of 4 m follow: infinite ones of packings,
each with others at its points, and the box of the centrifuges of Iwan sand of the same relative density.
"""
from isostat.campaign.library import make_library, parse
from studies.columns import SCENES, Run
from studies.leap_slope import cyclic, drained, results

DEFAULTS, QUICK, PAGE = {"seeds": 5}, {"seeds": 1}, "leap"
GRID_SEEDS, CYCLIC_SEEDS, CHECK_SEEDS = 2, 3, 1
PACKINGS = 20  # of which each point of a slope draws one
IWAN = {"material": "iwan", "relative_density": 0.65, "reference_pressure": "100 kPa", "k0": 0.5,
        "shear_velocity": "228 m/s"}  # G of Hardin and Richart (1963), as the packings'


def library_of(options):
    return options.output / "library_300.h5"


def prepare(options, executor):
    path = library_of(options)
    if not path.exists():
        make_library(parse([str(SCENES / "rve_library_ottawa.toml"), "-n", str(PACKINGS), "-o", str(path)]), executor)


def slopes(options):
    file, scene = library_of(options), SCENES / "column/slope_leap.toml"
    short = {"analysis.duration": "0.2 s"} if options.quick else {}
    keys = {"grains.library": file, "grains.cache": options.output / "in_situ.h5"} | short
    return [Run(("slope", lot), scene, tuple((keys | {"layer.0.lot": lot}).items()), 15 if short else 150, (file,))
            for lot in range(options.seeds)]


def boxes():
    layer = {f"layer.0.{key}": value for key, value in IWAN.items()}
    soil = {"layer.0.density": "2028 kg/m3", "layer.0.porosity": 0.377, "layer.0.permeability": "1.16e-4 m/s"}
    return [Run(("box", "iwan"), SCENES / "column/box_slope_iwan.toml", tuple((layer | soil).items()), 30)]


def runs(options):
    grid_seeds, cyclic_seeds, check_seeds = (1, 1, 1) if options.quick else (GRID_SEEDS, CYCLIC_SEEDS, CHECK_SEEDS)
    return [*drained.grid(grid_seeds), *slopes(options), *boxes(), *cyclic.runs(cyclic_seeds),
            *drained.checks(check_seeds)]


def report(store, planned, folder):
    results.report(store, planned, folder)

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
GRID_SEEDS, CYCLIC_SEEDS, CHECK_SEEDS = 2, 3, 2
PACKINGS = 20  # of which each point of a slope draws one
OPENED_SEEDS, EXPANSION = 3, 0.006  # of slopes run after the comparison; what undrained dense Karlsruhe sand asks for
OPENED = {"specimen.expansion": EXPANSION, "specimen.preparation_friction": "3 deg"}
IWAN = {"material": "iwan", "relative_density": 0.65, "reference_pressure": "100 kPa", "k0": 0.5,
        "shear_velocity": "228 m/s"}  # G of Hardin and Richart (1963), as the packings'


def library_of(options, name):
    return options.output / f"library_{name}.h5"


def prepare(options, executor):
    for name, keys in (("slope", {}), ("opened", OPENED)):
        path = library_of(options, name)
        keys = {"grading.grains": 300} | keys
        changes = [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]
        if not path.exists():
            make_library(parse([str(SCENES / "rve_library_ottawa.toml"), "-n", str(PACKINGS), "-o", str(path),
                                *changes]), executor)


def slopes(options, name, seeds, keys):
    """Opened packings stiffen by more as p' comes back: smaller steps."""
    file, scene = library_of(options, name), SCENES / "column/slope_leap.toml"
    short = {"analysis.duration": "0.2 s"} if options.quick else {}
    keys = {"grains.library": file, "grains.cache": options.output / f"in_situ_{name}.h5"} | keys | short
    return [Run((name, lot), scene, tuple((keys | {"layer.0.lot": lot}).items()), 15 if short else 150, (file,))
            for lot in range(seeds)]


def boxes():
    layer = {f"layer.0.{key}": value for key, value in IWAN.items()}
    soil = {"layer.0.density": "2028 kg/m3", "layer.0.porosity": 0.377, "layer.0.permeability": "1.16e-4 m/s"}
    return [Run(("box", "iwan"), SCENES / "column/box_slope_iwan.toml", tuple((layer | soil).items()), 30)]


def runs(options):
    grid_seeds, cyclic_seeds, check_seeds = (1, 1, 1) if options.quick else (GRID_SEEDS, CYCLIC_SEEDS, CHECK_SEEDS)
    return [*drained.grid(grid_seeds), *cyclic.runs(cyclic_seeds, EXPANSION), *drained.moduli(check_seeds, EXPANSION),
            *(run for x in (0, EXPANSION) for run in drained.checks(check_seeds, x)), *boxes(),
            *slopes(options, "slope", options.seeds, {}),
            *slopes(options, "opened", min(options.seeds, OPENED_SEEDS), {"analysis.safety": 0.4})]


def report(store, planned, folder):
    results.report(store, planned, folder)

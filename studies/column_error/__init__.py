# SPDX-License-Identifier: BSD-3-Clause
"""What speed costs in a column of grains: size of the packings, rates inside them, FE step, mesh, realisation.

The scene is apps/scenes/column/quick_grains_10m.toml with K0 = 0.6 under 20 kPa, shaken weakly, moderately and
strongly. One setting is varied at a time. Runs of the same seed, number of grains and mesh start from the same
packings: those that the default settings brought to the stress in situ.
"""
import dataclasses
import pathlib
import re

import h5py

from isostat import InputError, RunFailure
from isostat.campaign.runs import complete
from isostat.campaign.study import Store
from isostat.column import ColumnScene
from studies import columns
from studies.column_error.report import write as report

SEEDS = {250: 10, 500: 3, 1000: 3, 2000: 3, 4000: 2}  # asked for; the fourth of 250 does not reach its density
DENSITY_TOLERANCE = {1000: 0.02}  # nor does one of 1,000 within 0.01
LEVELS = {  # name: amplitude, duration, ramp
    "weak": ("0.03 g", "2 s", "0.5 s"),
    "moderate": ("0.06 g", "4 s", "0.5 s"),
    "strong": ("0.15 g", "2 s", "0.5 s"),
}
DEFAULTS, QUICK = {"seeds": 10, "levels": list(LEVELS)}, {"seeds": 1, "levels": ["weak"]}
SECONDS = {"weak": 4, "moderate": 10, "strong": 16}  # of CPU, with the default settings
MOTION = {"contact_damping": 0.05, "damping": 0.2, "free_grain_damping": 0.1,
          "inertial_number": 1e-4}  # the defaults of the schema
PLACES = {"contact_damping": -9, "damping": -8, "free_grain_damping": -7,
          "inertial_number": -5}  # in the words of a recipe
SLOW = {"inertial_number": 4e-5, "min_steps": 60}
NUMERICS = [  # family, label, what differs from the defaults; time step in ms
    ("default", "default", {}),
    ("reference", "reference", SLOW),
    ("rate", "I 5e-4", {"inertial_number": 5e-4}),
    ("rate", "I 1e-3", {"inertial_number": 1e-3}),
    ("min_steps", "min_steps 10", {"min_steps": 10}),
    ("min_steps", "min_steps 40", {"min_steps": 40}),
    ("damping", "damping 0.2, no dashpots", {"damping": 0.2, "contact_damping": 0.0}),
    ("damping", "damping 0.01", {"damping": 0.01}),
    ("free", "rattlers left alone", {"free_grain_damping": 0.0}),
    ("same", "motion 1 ppm larger", {"factor": 1.000001}),
    ("same", "reference, 1 ppm larger", {**SLOW, "factor": 1.000001}),
    ("reference", "next slow", {"inertial_number": 1e-4, "min_steps": 40}),
    ("reference", "slower", {"inertial_number": 1e-5, "min_steps": 200}),
    ("step", "FE step 2 ms", {"time_step": 2}),
    ("step", "FE step 1 ms", {"time_step": 1}),
    ("step", "reference, FE step 1 ms", {**SLOW, "time_step": 1}),
    ("rate", "I 4e-5", {"inertial_number": 4e-5}),
    ("min_steps", "min_steps 1", {"min_steps": 1}),
    ("min_steps", "min_steps 5", {"min_steps": 5}),
    ("min_steps", "min_steps 100", {"min_steps": 100}),
    ("min_steps", "min_steps 200", {"min_steps": 200}),
    ("fast", "fast", {"inertial_number": 1e-3, "min_steps": 10}),
    ("same", "I 5e-4, own packings", {"inertial_number": 5e-4, "own": True}),
]
PAIR = ("default", "reference")  # of every seed


@dataclasses.dataclass(frozen=True)
class Run:
    folder: pathlib.Path  # of the study
    level: str  # one of LEVELS
    family: str
    label: str
    settings: tuple = ()  # items of what differs from the defaults
    grains: int = 250
    cells: int = 10
    seed: int = 0
    realisations: int = 1
    kind, specimen, program = "column", None, "soil_column"

    @property
    def name(self):
        text = f"{self.level}_{self.grains}g_{self.cells}l_{self.label}_r{self.seed}"
        return re.sub(r"[^A-Za-z0-9.]+", "_", text)

    @property
    def motion(self):
        """Of the grains."""
        return MOTION | {key: value for key, value in self.settings if key in MOTION}

    @property
    def shares_packings(self):
        """Whether its packings in situ are those that the default settings made, though its grains move otherwise."""
        return self.motion != MOTION and "own" not in dict(self.settings)

    @property
    def cache(self):
        """Of its packings in situ."""
        if self.motion == MOTION:
            return in_situ(self.folder, self.grains)
        own = "own_" if "own" in dict(self.settings) else ""
        return self.folder / f"{own}in_situ_{self.grains}_{'_'.join(f'{value:g}' for value in self.motion.values())}.h5"

    def scene(self):
        library = library_of(self.folder, self.grains)
        if not library.is_file():
            return None
        settings = dict(self.settings)
        amplitude, duration, ramp = LEVELS[self.level]
        value, unit = amplitude.split()
        chosen = {"grains.library": library, "grains.cache": self.cache, "layer.0.k0": 0.6, "load.surcharge": "20 kPa",
                  "layer.0.cells": self.cells, "layer.0.realisation": self.seed,
                  "grains.realisations": self.realisations,
                  **{f"grains.{key}": value for key, value in self.motion.items()},
                  "motion.0.amplitude": f"{float(value) * settings.get('factor', 1):.9g} {unit}", "motion.0.ramp": ramp,
                  "motion.0.duration": duration, "analysis.duration": duration, "output.history_interval": "4 ms",
                  "output.profile_interval": "20 ms", "output.paraview_interval": "10 s"}
        if "min_steps" in settings:
            chosen["grains.min_steps"] = settings["min_steps"]
        if "time_step" in settings:
            chosen["analysis.time_step"] = f"{settings['time_step']} ms"
        return ColumnScene(columns.SCENES / "column/quick_grains_10m.toml", set=chosen)

    def estimated_seconds(self):
        settings = dict(self.settings)
        slower = max(settings.get("min_steps", 20) / 20, 1e-4 / self.motion["inertial_number"],
                     4 / settings.get("time_step", 4))
        return SECONDS[self.level] * slower * self.grains / 250 * self.cells / 10 * self.realisations


def library_of(folder, grains):
    return folder / f"library_{grains}.h5"


def in_situ(folder, grains):
    """The cache of packings that the default settings brought to the stress in situ."""
    return folder / f"in_situ_{grains}.h5"


def write_library(folder, executor, grains, n_seeds):
    """Specimens of this many grains of one size at 20 and 100 kPa."""
    edge = 4.641588833612779 * (grains / 1000) ** (1 / 3)
    columns.library(library_of(folder, grains), executor, n_seeds, ["20 kPa", "100 kPa"], {
        "contact.young": "1 GPa", "grading.grains": grains, "grading.cloud_edge": f"{edge:.9f} mm",
        "specimen.density_tolerance": DENSITY_TOLERANCE.get(grains, 0.01)})


def runs_of(folder, level, n_seeds):
    """All runs of a level, the most telling first."""
    def case(*what, **more):
        return Run(folder, level, *what, **more)

    numerics = [[case(f, label, tuple(s.items()), seed=seed) for f, label, s in NUMERICS] for seed in range(6)]
    cases = [run for of_seed in numerics for run in of_seed if run.label in PAIR]
    cases += numerics[0] + numerics[1]
    for grains in (500, 1000, 2000, 4000) if level == "weak" else (500, 1000):
        cases += [case("default", "default", grains=grains, seed=seed) for seed in range(SEEDS[grains])]
    for cells in (5, 20, 40) if level == "weak" else (5, 20):
        cases += [case("default", "default", cells=cells, seed=seed) for seed in range(2)]
    cases += [case("mean", "mean of 3", grains=250, seed=3 * k, realisations=3) for k in range(3)]
    # does the error of the rates fall with the size of a packing?
    cases += [case(f, label, tuple(s.items()), grains=1000, seed=seed) for seed in range(2)
              for f, label, s in NUMERICS if label in ("reference", "min_steps 10", "min_steps 40")]
    return [run for run in dict.fromkeys(cases + numerics[2]) if run.seed < n_seeds]


def cache_name(recipe):
    """The name that the program gives an entry (FNV-1a of its recipe)."""
    value = 14695981039346656037
    for byte in recipe.encode():
        value = (value ^ byte) * 1099511628211 % 2**64
    return f"i{value:016x}"


def share_packings(source, target, motion):
    """Copies packings in situ as though they had been brought there with other settings of their motion."""
    with h5py.File(source) as old, h5py.File(target, "a") as new:
        new.attrs.update(old.attrs)
        for entry in old.values():
            recipe = entry["provenance"].attrs["recipe"]
            recipe = recipe.decode() if isinstance(recipe, bytes) else recipe
            words = recipe.split(" ")
            for key, place in PLACES.items():
                if float(words[place]) != MOTION[key]:
                    raise InputError(f"{source}: no {key} of {MOTION[key]} in the recipe \"{recipe}\"")
                words[place] = f"{motion[key]:.17g}"
            recipe = " ".join(words)
            if cache_name(recipe) not in new:
                old.copy(entry, new, cache_name(recipe))
                new[cache_name(recipe)]["provenance"].attrs["recipe"] = recipe


def add_options(line):
    line.add_argument("--levels", nargs="+", choices=LEVELS, help="of shaking (default: all)")


def runs(options):
    return [run for level in options.levels for run in runs_of(options.output, level, options.seeds)
            if run.grains == 250 or not options.quick]


def prepare(options, executor):
    """Libraries; and packings in situ of the default settings, where runs with others share them."""
    planned = runs(options)
    for grains in sorted({run.grains for run in planned}):
        write_library(options.output, executor, grains, min(SEEDS[grains], options.seeds + 2))
    sharing = [run for run in planned if run.shares_packings]
    makers = {(run.grains, run.seed): Run(options.output, "weak", "default", "default", grains=run.grains,
                                          seed=run.seed) for run in sharing}.values()
    store = Store(options.output)
    print(f"packings in situ: {len(makers)} runs", flush=True)
    complete(executor, [store.run(run) for run in makers if not store.is_done(run)])
    for run in makers:
        if not store.is_done(run):
            raise RunFailure(f"{run.name}: {store.run(run).last_line}")
    for run in sharing:
        share_packings(in_situ(options.output, run.grains), run.cache, run.motion)


__all__ = ["DEFAULTS", "QUICK", "add_options", "prepare", "report", "runs"]

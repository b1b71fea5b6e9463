#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What speed costs in a column of grains: size of the packings, rates inside them, FE step, mesh, realisation.

    column_error.py BIN FOLDER [--only weak|moderate|strong] [--minutes 60] [--dry-run] [--report-only] [--docs docs]

BIN        folder of soil_column and isostat
FOLDER     specimens, runs and runs.csv; what is there already is not made again
--dry-run  prints the command of every run and starts none
--docs     where figures/column_error.png goes (default: FOLDER); the tables go to standard output as Markdown

The scene is apps/scenes/column/quick_grains_10m.toml with K0 = 0.6 under 20 kPa, shaken weakly, moderately and
strongly. One setting is varied at a time. Runs of the same seed, number of grains and mesh start from the same
packings: those that the default settings brought to the stress in situ.
"""
import argparse
import dataclasses
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import time

import h5py

import column_error_report as report

HERE = pathlib.Path(__file__).resolve().parent
SCENES = HERE.parent / "apps/scenes"
SEEDS = {250: 10, 500: 3, 1000: 3, 2000: 3, 4000: 2}  # asked for; the fourth of 250 does not reach its density
DENSITY_TOLERANCE = {1000: 0.02}  # nor does one of 1,000 within 0.01
LEVELS = {  # name: amplitude, duration, ramp
    "weak": ("0.03 g", "2 s", "0.5 s"),
    "moderate": ("0.06 g", "4 s", "0.5 s"),
    "strong": ("0.15 g", "2 s", "0.5 s"),
}
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
    ("free", "free grains left alone", {"free_grain_damping": 0.0}),
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
class Case:
    level: str  # one of LEVELS
    family: str
    label: str
    settings: tuple = ()  # items of what differs from the defaults
    grains: int = 250
    cells: int = 10
    seed: int = 0
    realisations: int = 1

    @property
    def name(self):
        text = f"{self.level}_{self.grains}g_{self.cells}l_{self.label}_r{self.seed}"
        return re.sub(r"[^A-Za-z0-9.]+", "_", text)


def plan(level):
    """All cases of a level, the most telling first."""
    numerics = [[Case(level, f, label, tuple(s.items()), seed=seed) for f, label, s in NUMERICS] for seed in range(6)]
    cases = [case for of_seed in numerics for case in of_seed if case.label in PAIR]
    cases += numerics[0] + numerics[1]
    for grains in (500, 1000, 2000, 4000) if level == "weak" else (500, 1000):
        cases += [Case(level, "default", "default", grains=grains, seed=seed) for seed in range(SEEDS[grains])]
    for cells in (5, 20, 40) if level == "weak" else (5, 20):
        cases += [Case(level, "default", "default", cells=cells, seed=seed) for seed in range(2)]
    cases += [Case(level, "mean", "mean of 3", grains=250, seed=3 * k, realisations=3) for k in range(3)]
    # does the error of the rates fall with the size of a packing?
    cases += [Case(level, f, label, tuple(s.items()), grains=1000, seed=seed) for seed in range(2)
              for f, label, s in NUMERICS if label in ("reference", "min_steps 10", "min_steps 40")]
    return list(dict.fromkeys(cases + numerics[2]))


def execute(command, minutes=15):
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run(["nice", "-n", "5", *map(str, command)], capture_output=True, text=True, check=False,
                          stdin=subprocess.DEVNULL, timeout=60 * minutes, env=environment)


def library(arguments, grains):
    """Specimens of so many grains of one size at 20 and 100 kPa."""
    path = arguments.folder / f"library_{grains}.h5"
    if not path.exists() and not arguments.dry_run:
        edge = 4.641588833612779 * (grains / 1000) ** (1 / 3)
        done = execute([arguments.bin / "isostat", "library", SCENES / "rve_library.toml", "-o", path, "-j", 1, "-q",
                        "--pressures", "20 kPa,100 kPa", "-n", SEEDS[grains], "--set", "contact.young=1 GPa",
                        "--set", f"grading.grains={grains}", "--set", f"grading.cloud_edge={edge:.9f} mm",
                        "--set", f"specimen.density_tolerance={DENSITY_TOLERANCE.get(grains, 0.01)}"])
        if not path.exists():
            raise SystemExit(f"specimens of {grains} grains: {done.stderr}")
    return path


def cache_name(recipe):
    """The name that the program gives an entry (FNV-1a of its recipe)."""
    value = 14695981039346656037
    for byte in recipe.encode():
        value = (value ^ byte) * 1099511628211 % 2**64
    return f"i{value:016x}"


def share_packings(source, target, motion):
    """Copies packings in situ as though they had been brought there with other settings of their motion."""
    if not source.exists():
        return
    with h5py.File(source) as old, h5py.File(target, "a") as new:
        new.attrs.update(old.attrs)
        for entry in old.values():
            recipe = entry["provenance"].attrs["recipe"]
            recipe = recipe.decode() if isinstance(recipe, bytes) else recipe
            words = recipe.split(" ")
            for key, place in PLACES.items():
                if float(words[place]) != MOTION[key]:
                    raise SystemExit(f"{source}: no {key} of {MOTION[key]} in the recipe \"{recipe}\"")
                words[place] = f"{motion[key]:.17g}"
            recipe = " ".join(words)
            if cache_name(recipe) not in new:
                old.copy(entry, new, cache_name(recipe))
                new[cache_name(recipe)]["provenance"].attrs["recipe"] = recipe


def packings_in_situ(arguments, case, motion):
    """The cache of a case: that of the defaults, unless its packings move otherwise."""
    shared = arguments.folder / f"in_situ_{case.grains}.h5"
    if motion == MOTION:
        return shared
    cache = shared.with_name(f"in_situ_{case.grains}_{'_'.join(f'{value:g}' for value in motion.values())}.h5")
    if dict(case.settings).get("own"):  # brought to the stress in situ with the settings of the run
        return cache.with_name("own_" + cache.name)
    if not arguments.dry_run:
        share_packings(shared, cache, motion)
    return cache


def scene_keys(arguments, case):
    """What differs from the scene file."""
    settings = dict(case.settings)
    motion = {key: settings.get(key, value) for key, value in MOTION.items()}
    amplitude, duration, ramp = LEVELS[case.level]
    value, unit = amplitude.split()
    chosen = {"grains.library": library(arguments, case.grains),
              "grains.cache": packings_in_situ(arguments, case, motion), "layer.0.k0": 0.6,
              "load.surcharge": "20 kPa", "layer.0.cells": case.cells, "layer.0.realisation": case.seed,
              "grains.realisations": case.realisations, **{f"grains.{key}": value for key, value in motion.items()},
              "motion.0.amplitude": f"{float(value) * settings.get('factor', 1):.9g} {unit}", "motion.0.ramp": ramp,
              "motion.0.duration": duration, "analysis.duration": duration,
              "output.history_interval": "4 ms", "output.profile_interval": "20 ms", "output.paraview_interval": "10 s"}
    if "min_steps" in settings:
        chosen["grains.min_steps"] = settings["min_steps"]
    if "time_step" in settings:
        chosen["analysis.time_step"] = f"{settings['time_step']} ms"
    return chosen


def run(arguments, case):
    """Runs a case unless it is there with these settings."""
    folder = arguments.folder / "runs" / case.name
    chosen = scene_keys(arguments, case)
    command = [arguments.bin / "soil_column", SCENES / "column/quick_grains_10m.toml", "-o", folder, "--overwrite",
               "--no-figures", "-q"]
    for key, item in chosen.items():
        command += ["--set", f"{key}={item}"]
    if arguments.dry_run:
        print(shlex.join(map(str, command)))
        return
    made_with = "\n".join(f"{key}={item}" for key, item in chosen.items() if not isinstance(item, pathlib.Path))
    mark = folder / "made_with.txt"
    if mark.exists() and mark.read_text(encoding="utf-8") == made_with:
        return
    done = execute(command)
    folder.mkdir(parents=True, exist_ok=True)
    if done.returncode:
        print(f"<!-- {case.name}: {done.stderr.strip()} -->", flush=True)
    for bulky in ("checkpoint", "grains", "paraview"):
        shutil.rmtree(folder / bulky, ignore_errors=True)
    mark.write_text(made_with, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--only", choices=LEVELS, help="one level of shaking")
    parser.add_argument("--minutes", type=float, default=1e9, help="start no run after this time")
    parser.add_argument("--dry-run", action="store_true", help="print the commands and stop")
    parser.add_argument("--report-only", action="store_true", help="of what is there")
    parser.add_argument("--docs", type=pathlib.Path, help="folder whose figures/ gets the figure")
    arguments = parser.parse_args()
    arguments.folder = arguments.folder.resolve()
    if not arguments.dry_run:
        (arguments.folder / "runs").mkdir(parents=True, exist_ok=True)
    begin = time.monotonic()
    for level in [arguments.only] if arguments.only else LEVELS:
        for case in plan(level):
            if not arguments.report_only and time.monotonic() - begin < 60 * arguments.minutes:
                run(arguments, case)
    if arguments.dry_run:
        return
    cases = [case for level in LEVELS for case in plan(level)]
    there = [(case, arguments.folder / "runs" / case.name) for case in cases
             if (arguments.folder / "runs" / case.name / "times.json").exists()]
    figures = arguments.docs / "figures" if arguments.docs else arguments.folder
    report.write(there, arguments.folder / "runs.csv", figures / "column_error.png")


if __name__ == "__main__":
    main()

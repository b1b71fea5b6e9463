#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Explicit and implicit steps of a column of soft soil in which a thin stiff layer decides the stable step: time and
error of both, in alternating rounds.

    implicit_steps.py [BUILD] [--rounds 5]

20 m of soil above rock, 0.2 m of concrete at a depth of 5 m, a record of 30 s; elastic and Iwan soil. Errors are those
of the response spectrum of the surface (5 % of damping, 0.1 to 5 s) and of the largest shear strain over the depth,
against explicit steps of half the size. Prints a table."""
import argparse
import csv
import json
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SCENE = """[water]
drainage = "dry"
{layers}[base]
kind = "compliant"
density = "2300 kg/m3"
shear_velocity = "800 m/s"
[[motion]]
axis = "x"
kind = "record"
file = "{motion}"
peak = "0.15 g"
[analysis]
duration = "30 s"
viscosity = "0 ms"
"""
SOIL = """[[layer]]
thickness = "{} m"
cell_size = "0.5 m"
density = "1900 kg/m3"
shear_velocity = "150 m/s"
"""
CONCRETE = """[[layer]]
thickness = "0.2 m"
cells = 1
density = "2400 kg/m3"
material = "elastic"
shear_velocity = "2000 m/s"
poisson_ratio = 0.2
"""
MATERIALS = {"elastic": 'material = "elastic"\ndamping = 0.02\n',
             "Iwan": 'material = "iwan"\ncontraction = 0\ndilation = 0\nreference_pressure = "100 kPa"\n'}
STEPS = {"explicit": []}
STEPS |= {f"implicit, {ms:g} ms": ['scheme="implicit"', f'time_step="{ms:g} ms"'] for ms in (1, 2, 5, 10)}


def table(path):
    with open(path) as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    return {name.split(" ")[0]: [float(row[k]) for row in rows[1:] if row[k]] for k, name in enumerate(rows[0])}


def run(program, scene, folder, settings):
    more = [word for setting in settings for word in ("--set", f"analysis.{setting}")]
    subprocess.run([program, scene, "-o", folder, "--overwrite", "--quiet", "--no-figures", *more], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    times, spectra = json.loads((folder / "times.json").read_text()), table(folder / "spectra.csv")
    shown = [sa for period, sa in zip(spectra["period"], spectra["surface_x_SA"]) if 0.1 <= period <= 5]
    return times, shown, table(folder / "profile.csv")["gamma_max"]


def error(found, exact):
    return 100 * max(abs(a - b) for a, b in zip(found, exact)) / max(map(abs, exact))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", type=pathlib.Path, default=ROOT / "build/release")
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    print("| soil | steps | number | us a step | s | spectrum, % | strain, % |\n|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        for soil, material in MATERIALS.items():
            layers = SOIL.format(5) + material + CONCRETE + SOIL.format(15) + material
            motion = ROOT / "apps/scenes/motions/simulated_m6.5_20km_x.at2"
            (folder / "scene.toml").write_text(SCENE.format(layers=layers, motion=motion))
            exact = run(arguments.build / "bin/soil_column", folder / "scene.toml", folder / "run", ["safety=0.4"])
            done = {name: [] for name in STEPS}
            for _ in range(arguments.rounds):
                for name, settings in STEPS.items():
                    done[name].append(run(arguments.build / "bin/soil_column", folder / "scene.toml",
                                          folder / "run", settings))
            for name, runs in done.items():
                seconds = statistics.median(times["solver"] + times["material"] for times, _, _ in runs)
                steps = runs[0][0]["steps"]
                print(f"| {soil} | {name} | {steps:,} | {1e6 * seconds / steps:.1f} | {seconds:.2f} | "
                      f"{error(runs[0][1], exact[1]):.2g} | {error(runs[0][2], exact[2]):.2g} |", flush=True)


if __name__ == "__main__":
    main()

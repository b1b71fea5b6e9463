#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What speed costs in a column of grains: one setting varied at a time against a slow reference of the same packings.

    column_error.py BIN LIBRARY FOLDER [--amplitude 0.08]

BIN        folder of soil_column
LIBRARY    of specimen_library, with at least two seeds at each stress
FOLDER     where runs are left; those that are there already are not repeated

The scene is apps/scenes/column/quick_grains_10m.toml for 2 s. Prints a Markdown table: time in the packings, their steps,
error of the surface displacement (rms of the difference over rms of the reference) and of the pore pressure ratio (largest
rms over time of any depth).
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess

import h5py
import numpy as np

SCENE = pathlib.Path(__file__).resolve().parent.parent / "apps/scenes/column/quick_grains_10m.toml"
SLOW = {"grains.quasi_static_tolerance": "0.002", "grains.rate_floor": "0.02 1/s", "analysis.time_step": "1 ms"}
DEFAULT = {"analysis.time_step": "4 ms"}
CASES = [
    ("reference: tolerance 0.002, floor 0.02 1/s, step 1 ms", SLOW),
    ("default: tolerance 0.01, rates 0.2 to 2 1/s, step 4 ms", DEFAULT),
    ("tolerance 0.03", {**DEFAULT, "grains.quasi_static_tolerance": "0.03"}),
    ("tolerance 0.003", {**DEFAULT, "grains.quasi_static_tolerance": "0.003"}),
    ("rates 0.05 to 2 1/s", {**DEFAULT, "grains.rate_floor": "0.05 1/s"}),
    ("rates 0.2 to 10 1/s", {**DEFAULT, "grains.rate_ceiling": "10 1/s"}),
    ("rates 2 to 20 1/s", {**DEFAULT, "grains.rate_floor": "2 1/s", "grains.rate_ceiling": "20 1/s"}),
    ("step 1 ms", {"analysis.time_step": "1 ms"}),
    ("step 2 ms", {"analysis.time_step": "2 ms"}),
    ("20 levels, step 2 ms", {"analysis.time_step": "2 ms", "layer.0.cells": "20"}),
    ("another realisation", {**DEFAULT, "layer.0.realisation": "1"}),
]


def run(arguments, name, settings):
    """Runs a case unless it is there. @return its folder"""
    folder = arguments.folder / re.sub(r"[^A-Za-z0-9.]+", "_", name)
    if not (folder / "times.txt").exists():
        chosen = {"grains.library": str(arguments.library.resolve()), "grains.cache": str(arguments.folder / "in_situ.h5"),
                  "motion.0.amplitude": f"{arguments.amplitude} g", "motion.0.duration": "2 s", "motion.0.ramp": "0.5 s",
                  "analysis.duration": "2 s", "output.history_interval": "4 ms", "output.profile_interval": "20 ms", **settings}
        command = [str(arguments.bin / "soil_column"), str(SCENE), "-o", str(folder), "--overwrite", "--no-figures", "-q"]
        for key, value in chosen.items():
            command += ["--set", f"{key}={value}"]
        done = subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
        if done.returncode:
            raise SystemExit(f"{name}: {done.stderr}")
        (folder / "times.txt").write_text(done.stdout, encoding="utf-8")
    return folder


def surface(folder):
    with open(folder / "history.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return np.array([float(r["time (s)"]) for r in rows]), np.array([float(r["surface_ux (m)"]) for r in rows])


def ratios(folder):
    """r_u over time and depth: (time, depth from above, values)."""
    with h5py.File(folder / "profiles.h5", "r") as file:
        return np.array(file["time"]), np.array(file["depth"]), np.array(file["ru"])


def errors(folder, reference):
    t, u = surface(reference)
    other = np.interp(t, *surface(folder))
    motion = np.sqrt(np.mean((other - u) ** 2) / np.mean(u**2))
    t, z, ru = ratios(reference)
    time, depth, values = ratios(folder)
    at_time = np.array([np.interp(t, time, column) for column in values.T]).T
    order = np.argsort(depth)
    same = np.array([np.interp(z, depth[order], row[order]) for row in at_time])
    return motion, np.sqrt(np.mean((same - ru) ** 2, axis=0)).max()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--amplitude", type=float, default=0.08)
    arguments = parser.parse_args()
    arguments.folder = arguments.folder.resolve()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    reference = run(arguments, *CASES[0])
    print("| setting | time in packings, s | steps per call | surface displacement | r_u | largest r_u |")
    print("|---|---|---|---|---|---|")
    for name, settings in CASES:
        folder = run(arguments, name, settings)
        text = (folder / "times.txt").read_text(encoding="utf-8")
        seconds = re.search(r"([\d.]+) s on the busiest", text).group(1)
        steps = re.search(r"([\d.]+) time steps each", text).group(1)
        motion, ru = errors(folder, reference)
        peak = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["max_ru"]
        print(f"| {name} | {seconds} | {steps} | {100 * motion:.2f} % | {ru:.3f} | {peak:.3f} |", flush=True)


if __name__ == "__main__":
    main()

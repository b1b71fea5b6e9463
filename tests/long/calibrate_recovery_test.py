#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""calibrate finds known parameters again: drained tests at a known angle of friction, rolling limit and modulus, on
specimens of other seeds than those it is given. Not part of the usual tests: ctest --preset long, some ten minutes on
two cores."""
import concurrent.futures
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARIES = pathlib.Path(sys.argv.pop(1)).resolve()
SCENE = ROOT / "apps/scenes/calibrate/sand.toml"
TRUTH = {"contact.friction": 22.0, "contact.rolling.limit": 0.35, "contact.young": 0.2}  # deg, -, GPa
START = {"contact.friction": 15.0, "contact.rolling.limit": 0.7, "contact.young": 0.8}
CURVES = {"dense": 4, "loose": 20}  # preparation friction, deg
GRAINS, STRAIN, RATE = 1000, 0.06, 4e-3
LABORATORY_SEEDS, TRIAL_SEEDS = range(101, 113), 6  # those of the trials are 1 to 6
CORES = len(os.sched_getaffinity(0))

PLAN = """title = "Known parameters, found again"
scene = "{scene}"
[specimens]
grains = {grains}
seeds = {seeds}
inertial_number = {rate}
[budget]
trials = 40
[optimiser]
design = 8
tolerance = 0.01
[misfit]
spacing = "quadratic"
[[parameter]]
key = "contact.friction"
bounds = ["10 deg", "35 deg"]
start = "{phi} deg"
[[parameter]]
key = "contact.rolling.limit"
bounds = [0.1, 1.0]
start = {eta}
scale = "log"
[[parameter]]
key = "contact.young"
bounds = ["50 MPa", "1.5 GPa"]
start = "{young} GPa"
scale = "log"
"""
CURVE = """[[curve]]
name = "{name}"
file = "{name}.csv"
test = "drained"
preparation_friction = "{preparation} deg"
strain_end = {strain}
strains = "logarithmic"
columns = {{ strain = "eps_1 (-)", volume = "eps_v (-)", axial = "sigma_1 (Pa)", radial = "sigma_3 (Pa)" }}
"""


def run_one(folder, name, preparation, seed):
    settings = {"grading.grains": GRAINS, "grading.cloud_edge": f"{10 * (GRAINS / 10000) ** (1 / 3)} mm",
                "grading.seed": seed, "contact.friction": f"{TRUTH['contact.friction']} deg",
                "contact.rolling.limit": TRUTH["contact.rolling.limit"],
                "contact.young": f"{TRUTH['contact.young']} GPa",
                "specimen.preparation_friction": f"{preparation} deg", "stage.0.strain": STRAIN,
                "motion.inertial_number": RATE}
    out = folder / "truth" / f"{name}_{seed}"
    subprocess.run([BINARIES / "element_test", SCENE, "-o", out, "--threads", "1", "--no-figures", "--quiet",
                    *(word for key, value in settings.items() for word in ("--set", f"{key}={value}"))],
                   check=True, stdout=subprocess.DEVNULL)
    with open(out / "history.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    eps_x, strain, eps_z, p, q = (np.array([float(row[column]) for row in rows]) for column in
                                  ("eps_x (-)", "eps_y (-)", "eps_z (-)", "p (Pa)", "q (Pa)"))
    grid = STRAIN * np.linspace(0, 1, 61) ** 2
    return [np.interp(grid, strain, y) for y in (strain, eps_x + strain + eps_z, p + 2 * q / 3, p - q / 3)]


def write_laboratory(folder):
    """The mean over many specimens, as the laboratory would tell it."""
    with concurrent.futures.ThreadPoolExecutor(CORES) as pool:
        for name, preparation in CURVES.items():
            curves = pool.map(lambda seed: run_one(folder, name, preparation, seed), LABORATORY_SEEDS)
            mean = np.mean(list(curves), axis=0)
            np.savetxt(folder / f"{name}.csv", mean.T, delimiter=",", fmt="%.9g", comments="",
                       header="eps_1 (-),eps_v (-),sigma_1 (Pa),sigma_3 (Pa)")


class Recovery(unittest.TestCase):
    def setUp(self):
        kept = os.environ.get("ISOSTAT_KEEP")  # a folder: results stay, and the next call goes on from them
        self.folder = pathlib.Path(kept or tempfile.mkdtemp())
        self.folder.mkdir(exist_ok=True)
        if not kept:
            self.addCleanup(lambda: subprocess.run(["rm", "-r", self.folder], check=True))
        if not all((self.folder / f"{name}.csv").exists() for name in CURVES):
            write_laboratory(self.folder)
        curves = "".join(CURVE.format(name=name, preparation=preparation, strain=STRAIN)
                         for name, preparation in CURVES.items())
        plan = PLAN.format(scene=SCENE, grains=GRAINS, seeds=TRIAL_SEEDS, rate=RATE, phi=START["contact.friction"],
                           eta=START["contact.rolling.limit"], young=START["contact.young"])
        (self.folder / "plan.toml").write_text(plan + curves, encoding="utf-8")

    def test_known_parameters_are_found_again(self):
        subprocess.run([BINARIES / "calibrate", self.folder / "plan.toml", "-j", str(CORES), "-o", self.folder / "out"],
                       check=True)
        result = json.loads((self.folder / "out/calibrate.json").read_text(encoding="utf-8"))
        found = {p["key"]: float(p["best"].split()[0]) for p in result["parameters"]}
        print({key: (found[key], TRUTH[key]) for key in TRUTH}, "misfit", result["misfit_start"], result["misfit_best"])
        self.assertLess(result["misfit_best"], result["misfit_start"])
        for key, limit in (("contact.friction", 0.5), ("contact.rolling.limit", 0.1 * TRUTH["contact.rolling.limit"]),
                           ("contact.young", 0.2 * TRUTH["contact.young"])):
            with self.subTest(key):
                self.assertLessEqual(abs(found[key] - TRUTH[key]), limit)


if __name__ == "__main__":
    unittest.main()

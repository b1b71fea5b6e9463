# SPDX-License-Identifier: BSD-3-Clause
"""The wheel, installed into an empty folder: a drained test is run and drawn there, without the source tree."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from support import BIN, DISK, ROOT

PARTS = ("CMakeLists.txt", "LICENSE", "README.md", "apps/figures", "apps/report", "pyproject.toml", "python",
         "setup.py")
OFFLINE = ("--no-index", "--no-deps", "--disable-pip-version-check", "--quiet")

PROGRAM = """
import isostat, pathlib
import isostat.campaign.resistance  # every folder of the package is in the wheel
assert pathlib.Path(isostat.__file__).is_relative_to(pathlib.Path.cwd() / "site"), isostat.__file__
scene = isostat.Scene(title="drained", grading={"grains": 500, "cloud_edge": "3.7 mm"},
                      contact={"friction": "18 deg", "rolling": {"stiffness": 0.3, "limit": 0.5}},
                      specimen={"domain": "periodic-cell", "pressure": "100 kPa", "preparation_friction": "8 deg"},
                      motion={"inertial_number": 1e-3}, stage=[{"kind": "drained", "strain": 0.02}])
results = isostat.run(scene, "results/drained")
results.draw("fig_stress_path")[0].figure.savefig("drained.png")
sigma_1, sigma_3 = results.history["sigma_y"], results.history["sigma_x"]
print("peak", (sigma_1 / sigma_3).max(), "pressure", sigma_3[-1])
"""


class WheelTest(unittest.TestCase):
    def test_runs_and_draws_outside_of_the_tree(self):
        with tempfile.TemporaryDirectory(dir=DISK) as name:
            work = pathlib.Path(name)
            pip = [sys.executable, "-m", "pip"]
            for part in PARTS:  # built from a copy: nothing is left in the tree
                copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
                (work / "source" / part).parent.mkdir(parents=True, exist_ok=True)
                copy(ROOT / part, work / "source" / part)
            subprocess.run([*pip, "wheel", *OFFLINE, "--no-build-isolation", "-w", work / "wheels", work / "source"],
                           env={**os.environ, "ISOSTAT_BUILD": str(BIN.parent)}, check=True)
            (wheel,) = (work / "wheels").glob("isostat-*.whl")
            subprocess.run([*pip, "install", *OFFLINE, "--target", work / "site", wheel], check=True)
            done = subprocess.run([sys.executable, "-c", PROGRAM], cwd=work, capture_output=True, text=True,
                                  env={**os.environ, "PYTHONPATH": str(work / "site"), "MPLBACKEND": "Agg"})
            self.assertEqual(done.returncode, 0, done.stderr)
            _, ratio, _, pressure = done.stdout.split()
            self.assertGreater(float(ratio), 2)
            self.assertGreater((work / "drained.png").stat().st_size, 10_000)
            done = subprocess.run([sys.executable, work / "site/bin/isostat", "library", "--help"], cwd=work, text=True,
                                  capture_output=True, env={**os.environ, "PYTHONPATH": str(work / "site")})
            self.assertIn("--relative-densities", done.stdout, done.stderr)

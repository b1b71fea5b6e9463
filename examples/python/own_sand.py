#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Your own sand, and its friction from a laboratory curve.

The grading is given as a table. Drained triaxial tests at several angles of friction between grains are compared with a
drained test of the laboratory (Karlsruhe fine sand, medium dense, 200 kPa); the angle with the least misfit is taken.
`isostat calibrate` does this for several parameters and curves at once.

    python3 own_sand.py [--small] [--output FOLDER] [--laboratory CSV]
"""
import argparse
import pathlib
from concurrent.futures import ThreadPoolExecutor

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
import numpy as np  # noqa: E402

import isostat  # noqa: E402

TEST = pathlib.Path(__file__).resolve().parents[2] / "apps/laboratory/drained/TMD8.csv"
parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--small", action="store_true", help="few grains, two angles, seconds")
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("results/examples"))
parser.add_argument("--laboratory", type=pathlib.Path, default=TEST,
                    help="eps_a[%%],eps_v[%%],sigma_r[kPa],sigma_v[kPa]")
options = parser.parse_args()
options.output.mkdir(parents=True, exist_ok=True)
grains, end = (300, 0.01) if options.small else (600, 0.06)
angles, seeds = ((12, 24), (1,)) if options.small else ((18, 20, 22, 24, 26, 28, 30), (1, 2))

SIEVES = [["0.09 mm", 0], ["0.11 mm", 20], ["0.14 mm", 50], ["0.18 mm", 85], ["0.25 mm", 100]]  # diameter, % finer


def drained(case):
    """q (kPa) and volumetric strain over axial strain, at the angle of friction and with the seed of this case."""
    angle, seed = case
    scene = isostat.Scene(
        grading={"table": SIEVES, "grains": grains, "cloud_edge": f"{10 * (grains / 10000) ** (1 / 3):.3f} mm",
                 "seed": seed},
        contact={"young": "300 MPa", "friction": f"{angle} deg", "rolling": {"stiffness": 0.3, "limit": 0.5}},
        specimen={"domain": "periodic-cell", "pressure": "200 kPa", "preparation_friction": "14 deg"},
        motion={"inertial_number": 2e-3},
        stage=[{"kind": "drained", "strain": end}], output={"record_strain": end / 60})
    h = isostat.run(scene, cache=options.output / "specimens", threads=1).history
    return np.stack([np.interp(axial, h["eps_y"], h["q"] / 1e3),
                     np.interp(axial, h["eps_y"], h["eps_x"] + h["eps_y"] + h["eps_z"])])


# The laboratory counts strain over the first height; the model's is logarithmic.
percent, volume, lateral, vertical = np.loadtxt(options.laboratory, delimiter=",", skiprows=1).T
axial = np.linspace(0, end, 41)
logarithmic = -np.log(1 - percent / 100)
laboratory = np.stack([np.interp(axial, logarithmic, vertical - lateral), np.interp(axial, logarithmic, volume / 100)])

# The interpreter is free while steps are computed: threads of Python run tests side by side.
cases = [(angle, seed) for angle in angles for seed in seeds]
with ThreadPoolExecutor(max_workers=2) as pool:
    curves = dict(zip(cases, pool.map(drained, cases)))
means = {angle: np.mean([curves[angle, seed] for seed in seeds], axis=0) for angle in angles}
scale = np.abs(laboratory).max(axis=1, keepdims=True)
misfit = {angle: np.sqrt(np.mean(((mean - laboratory) / scale) ** 2)) for angle, mean in means.items()}
best = min(misfit, key=misfit.get)
print("misfit: " + ", ".join(f"{angle} deg {value:.3f}" for angle, value in misfit.items()) + f"; best {best} deg")

figure, (stress, dilation, search) = plt.subplots(1, 3, figsize=(10, 3.3), layout="constrained")
for angle, (q, eps_v) in means.items():
    style = {"color": "tab:blue", "lw": 2} if angle == best else {"color": "lightgrey", "lw": 1}
    stress.plot(100 * axial, q, **style, label=f"{angle}° (least misfit)" if angle == best else None)
    dilation.plot(100 * axial, 100 * eps_v, **style)
stress.plot(100 * axial, laboratory[0], "k--", label="laboratory")
stress.set(xlabel="axial strain (%)", ylabel="q (kPa)", title="drained triaxial tests")
stress.legend(frameon=False)
dilation.plot(100 * axial, 100 * laboratory[1], "k--")
dilation.set(xlabel="axial strain (%)", ylabel="volumetric strain (%)", title="compression positive")
search.plot(list(misfit), list(misfit.values()), "o-")
search.set(xlabel="angle of friction between grains (°)", ylabel="misfit", title="search", ylim=(0, None))
figure.savefig(options.output / "own_sand.png", dpi=110)

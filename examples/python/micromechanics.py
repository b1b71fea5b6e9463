#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Micromechanics: where the strength of sand comes from.

A dense and a loose specimen are sheared at constant mean stress. What carries the load is measured on the way: the
anisotropies of contact directions, normal and shear forces, which add up to q/p' = 2/5 (a_c + a_n + 3/2 a_t).

    python3 micromechanics.py [--small] [--output FOLDER]
"""
import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
import numpy as np  # noqa: E402

import isostat  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--small", action="store_true", help="few grains, little strain, seconds")
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("results/examples"))
options = parser.parse_args()
options.output.mkdir(parents=True, exist_ok=True)
grains, strain = (300, 0.004) if options.small else (2000, 0.10)


def shear(preparation_friction):
    """A drained test at constant p'. The friction while the specimen is made decides how dense it becomes."""
    scene = isostat.Scene(
        grading={"grains": grains, "cloud_edge": f"{10 * (grains / 10000) ** (1 / 3):.3f} mm"},
        contact={"young": "1 GPa", "friction": "18 deg", "rolling": {"stiffness": 0.3, "limit": 0.5}},
        specimen={"domain": "periodic-cell", "pressure": "200 kPa", "preparation_friction": preparation_friction},
        motion={"inertial_number": 1e-3},
        stage=[{"kind": "constant-p", "strain": strain}], output={"record_strain": strain / 100})
    return isostat.run(scene, cache=options.output / "specimens")


tests = {"dense": shear("2 deg"), "loose": shear("25 deg")}
figure, ((sums, volume), (rose, forces)) = plt.subplots(2, 2, figsize=(9, 7), layout="constrained")
for (name, test), colour in zip(tests.items(), ("tab:blue", "tab:orange")):
    h = test.history
    axial = 100 * h["eps_y"]
    sums.plot(axial, h["q"] / h["p"], color=colour, label=f"{name}: measured")
    sums.plot(axial, 0.4 * (h["a_c"] + h["a_n"] + 1.5 * h["a_t"]), "k:", lw=1.2)
    volume.plot(axial, h["e"], color=colour, label=name)

    # Contacts that point everywhere have cosines against the vertical that are spread evenly.
    force = test.snapshot.normal_forces
    share, edges = np.histogram(np.abs(test.snapshot.normals[:, 1]), bins=10, range=(0, 1))
    rose.stairs(share / share.mean(), edges, color=colour, label=name)
    share, edges = np.histogram(force / force.mean(), bins=40, range=(0, 6), density=True)
    forces.semilogy((edges[1:] + edges[:-1]) / 2, np.maximum(share, 1e-4), ".-", lw=0.7, color=colour, label=name)
    print(f"{name}: e = {h['e'][0]:.3f}, largest q/p' = {(h['q'] / h['p']).max():.2f}, "
          f"I_R from {h['IR'][0]:.2f} to {h['IR'][-1]:.2f}")

sums.plot([], [], "k:", label="2/5 (a_c + a_n + 3/2 a_t)")
sums.set(xlabel="axial strain (%)", ylabel="q/p'", title="strength, and the sum of anisotropies")
volume.set(xlabel="axial strain (%)", ylabel="void ratio e", title="volume")
rose.set(xlabel="|cos| of contact normal and vertical", ylabel="share over mean", title="contacts at the end")
forces.set(xlabel="normal force over its mean", ylabel="probability density", title="forces at the end", ylim=(1e-3, 2))
for axes in (sums, volume, rose, forces):
    axes.legend(frameon=False, loc="best" if axes is not rose else "upper left")
figure.savefig(options.output / "micromechanics.png", dpi=100)

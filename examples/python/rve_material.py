#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A packing as a material: strain in, stress out.

The representative volume element is sheared at constant volume in cycles of growing strain, each from the same state,
as in a cyclic simple shear device. The figure shows loops, the decay of the secant modulus and the damping ratio.

    python3 rve_material.py [--small] [--output FOLDER]
"""
import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
import numpy as np  # noqa: E402

import isostat  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--small", action="store_true", help="few grains, few increments, seconds")
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("results/examples"))
options = parser.parse_args()
options.output.mkdir(parents=True, exist_ok=True)
grains, steps, amplitudes = (300, 4, (1e-5, 1e-3)) if options.small else (1000, 12, np.logspace(-5, np.log10(5e-3), 8))

scene = isostat.Scene(
    grading={"grains": grains, "cloud_edge": f"{10 * (grains / 10000) ** (1 / 3):.3f} mm"},
    contact={"young": "1 GPa", "friction": "18 deg", "rolling": {"stiffness": 0.3, "limit": 0.5}},
    specimen={"domain": "periodic-cell", "pressure": "100 kPa", "preparation_friction": "8 deg"})
packing = isostat.prepare(scene, cache=options.output / "specimens").snapshot

# An increment takes at least min_steps time steps: with too few, grains have no time to find their places.
rve = isostat.Rve(packing, min_steps=300 if options.small else 1000)
elastic = rve.stiffness()[5, 5]  # d tau_xy / d gamma_xy of contacts that do not slide
start = rve.save()


def cycle(amplitude):
    """Shear strain and stress of one cycle from the first state: up, down and up again, in equal increments."""
    rve.restore(start)
    gamma, tau = [0.0], [rve.stress[0, 1]]
    increment = np.zeros((3, 3))
    for sign in [1] * steps + [-1] * 2 * steps + [1] * 2 * steps:
        increment[0, 1] = sign * amplitude / steps
        if not (response := rve.undrained(increment)):
            raise SystemExit(f"rejected: {response.reason}")
        gamma.append(gamma[-1] + increment[0, 1])
        tau.append(rve.stress[0, 1])
    return np.array(gamma), np.array(tau)


figure, (loops, decay, damping) = plt.subplots(1, 3, figsize=(10, 3.3), layout="constrained")
secant, ratio = [], []
for amplitude in amplitudes:
    gamma, tau = cycle(amplitude)
    loop = slice(steps, None)  # from the first peak to the second
    secant.append((tau[loop].max() - tau[loop].min()) / (2 * amplitude))
    lost = np.sum((tau[loop][1:] + tau[loop][:-1]) / 2 * np.diff(gamma[loop]))
    ratio.append(lost / (2 * np.pi * secant[-1] * amplitude**2))
    if amplitude > 3e-4:
        loops.plot(1e3 * gamma, tau / 1e3, lw=0.9, label=f"{1e3 * amplitude:.2g}")
    print(f"amplitude {amplitude:.1e}: G = {secant[-1] / 1e6:6.1f} MPa, damping {100 * ratio[-1]:5.1f} %")

loops.set(xlabel=r"$\gamma$ (10$^{-3}$)", ylabel=r"$\tau$ (kPa)", title="cycles, each from the same state")
loops.legend(frameon=False, title=r"amplitude (10$^{-3}$)", fontsize=7, title_fontsize=7)
decay.semilogx(amplitudes, np.array(secant) / 1e6, "o-", label="secant")
decay.axhline(elastic / 1e6, color="black", ls="--", lw=0.9, label="rve.stiffness()")
decay.set(xlabel="amplitude of shear strain", ylabel="shear modulus (MPa)", title="stiffness", ylim=(0, None))
decay.legend(frameon=False)
damping.semilogx(amplitudes, 100 * np.array(ratio), "o-", color="tab:red")
damping.set(xlabel="amplitude of shear strain", ylabel="damping ratio (%)", title="loss", ylim=(0, None))
figure.savefig(options.output / "rve_material.png", dpi=110)

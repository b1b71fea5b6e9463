#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A first test: sand that liquefies.

A specimen is compressed to 200 kPa and sheared to and fro at constant volume, which is what an undrained test does to
the grains. The figure shows the stress path, the stress-strain curve and how many constraints are left.

    python3 first_test.py [--small] [--output FOLDER]
"""
import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

import isostat  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--small", action="store_true", help="few grains, seconds")
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("results/examples"))
options = parser.parse_args()
options.output.mkdir(parents=True, exist_ok=True)

# Sizes follow the grading of Karlsruhe fine sand; cloud_edge ~ grains^(1/3) keeps the grains as large as they are.
grains = 300 if options.small else 2000
scene = isostat.Scene(
    title="First test",
    grading={"grains": grains, "cloud_edge": f"{10 * (grains / 10000) ** (1 / 3):.3f} mm", "seed": 1},
    contact={"friction": "18 deg", "rolling": {"stiffness": 0.3, "limit": 0.5}, "twisting": {"stiffness": 0.3}},
    specimen={"domain": "periodic-cell", "pressure": "200 kPa", "preparation_friction": "10 deg"},
    stage=[{"kind": "undrained-cyclic", "deviator_amplitude": "60 kPa",
            "until": {"cycles": 4 if options.small else 200, "reversals_after_liquefaction": 4}}])

# Without a folder the history stays in memory; only the prepared specimen is kept, for the next start.
result = isostat.run(scene, cache=options.output / "specimens")
history = result.history
p, q, strain, liquefied = (history[name] for name in ("p", "q", "eps_y", "liquefied"))
if liquefied.any():
    print(f"liquefied after {history['reversals'][liquefied.argmax()] / 2:.1f} cycles")
else:
    print(f"p' fell to {p[-1] / p[0]:.2f} of its value at the start")

figure, (path, curve, constraints) = plt.subplots(1, 3, figsize=(10, 3.2), layout="constrained")
path.plot(p / 1e3, q / 1e3, lw=0.7)
path.set(xlabel="p' (kPa)", ylabel="q (kPa)", title="stress path")
curve.plot(100 * strain, q / 1e3, lw=0.7)
curve.set(xlabel="axial strain (%)", ylabel="q (kPa)", title="stress and strain")
constraints.plot(history["reversals"] / 2, history["IR"], ".", ms=2)
constraints.axhline(1, color="black", lw=0.8)
constraints.set(xlabel="cycles", ylabel="redundancy index $I_R$", title="isostatic at $I_R$ = 1")
figure.savefig(options.output / "first_test.png", dpi=110)

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""An ensemble of seeds: what one test of few grains is worth.

The same undrained cyclic test on specimens that differ in nothing but the seed of their random cloud. The number of
cycles to liquefaction scatters; its mean has a standard error, which is what should be quoted.

    python3 ensemble.py [--small] [--output FOLDER] [--jobs 1]
"""
import argparse
import pathlib
from concurrent.futures import ThreadPoolExecutor

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
import numpy as np  # noqa: E402

import isostat  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--small", action="store_true", help="two specimens of few grains, seconds")
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("results/examples"))
parser.add_argument("--jobs", type=int, default=1, help="tests side by side")
options = parser.parse_args()
options.output.mkdir(parents=True, exist_ok=True)
grains, seeds = (300, range(1, 3)) if options.small else (1000, range(1, 17))


def test(seed):
    """Undrained cyclic simple shear until liquefaction, CSR 0.15."""
    scene = isostat.Scene(
        grading={"grains": grains, "cloud_edge": f"{10 * (grains / 10000) ** (1 / 3):.3f} mm", "seed": seed},
        contact={"friction": "18 deg", "rolling": {"stiffness": 0.3, "limit": 0.5}, "twisting": {"stiffness": 0.3}},
        specimen={"domain": "periodic-cell", "pressure": "200 kPa", "preparation_friction": "10 deg"},
        stage=[{"kind": "undrained-cyclic-simple-shear", "stress_ratio": 0.15,
                "until": {"cycles": 3 if options.small else 200, "reversals_after_liquefaction": 0}}])
    return isostat.run(scene, cache=options.output / "specimens", threads=1).history


# The interpreter is free while steps are computed, so threads of Python share the cores.
with ThreadPoolExecutor(max_workers=options.jobs) as pool:
    histories = list(pool.map(test, seeds))

cycles = np.array([h["reversals"][h["liquefied"].argmax()] / 2 if h["liquefied"].any() else np.nan for h in histories])
known = cycles[np.isfinite(cycles)]
figure, (path, counts) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
for h in histories:
    path.plot(h["reversals"] / 2, h["p"] / h["p"][0], lw=0.7, alpha=0.7)
path.set(xlabel="cycles", ylabel="p'/p0'", title=f"{len(histories)} specimens of {grains} grains", ylim=(0, 1.05))
counts.plot(cycles, [h["e"][0] for h in histories], "o", alpha=0.8)
if len(known) > 1:
    mean, error = known.mean(), known.std(ddof=1) / np.sqrt(len(known))
    print(f"{len(known)} of {len(cycles)} liquefied: {mean:.1f} ± {error:.1f} cycles (standard error), "
          f"single tests {known.min():.1f} to {known.max():.1f}")
    counts.axvspan(mean - error, mean + error, color="lightgrey", label=f"mean {mean:.1f} ± {error:.1f}")
    counts.legend(frameon=False)
counts.set(xlabel="cycles to liquefaction", ylabel="void ratio at the start", title="scatter over seeds")
figure.savefig(options.output / "ensemble.png", dpi=110)

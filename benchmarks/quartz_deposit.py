#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A deposit of quartz beside its twin with the linear law: wave speed, pore pressure and strain over the depth.

    quartz_deposit.py QUARTZ LINEAR FIGURE.png

QUARTZ is a results folder of apps/scenes/column/grains_20m_quartz.toml, LINEAR one of the same scene with
`--set grains.library=...`, specimens of the linear law. Compared is what both have seen: up to the end of the shorter.
"""
import pathlib
import sys

import h5py
import matplotlib.pyplot as plt
import numpy as np

from paper.drawing import BLUE, ORANGE, STYLE, legend_below, panels
from small_strain import published

DENSITY, K0, VOID_RATIO = 1970, 0.5, 0.705  # of the scene and its packings


def profile(folder, end):
    """Over the depth: wave speed at the start, largest r_u and strain until a time."""
    with h5py.File(folder / "profiles.h5") as file:
        depth, velocity, vertical, time = (file[name][()] for name in ("depth", "shear_velocity", "sigma_v0", "time"))
        rows = time <= end
        return (depth, velocity, vertical, file["ru"][()][rows].max(axis=0),
                100 * np.abs(file["gamma_xz"][()][rows]).max(axis=0))


def last_time(folder):
    with h5py.File(folder / "profiles.h5") as file:
        return file["time"][-1]


def main():
    folders, figure_path = [pathlib.Path(name) for name in sys.argv[1:3]], sys.argv[3]
    end = min(last_time(folder) for folder in folders)
    plt.rcParams.update(STYLE)
    figure, axes = panels(1, 3, height=3.6, sharey=True)
    for folder, colour, label in zip(folders, (BLUE, ORANGE), ("Hertz-Mindlin, 38 GPa", "linear, 1 GPa")):
        depth, velocity, vertical, ru, gamma = profile(folder, end)
        expected = np.sqrt(published.small_strain_modulus(VOID_RATIO, vertical * (1 + 2 * K0) / 3) / DENSITY)
        for panel, values in zip(axes.flat, (velocity, ru, gamma)):
            panel.plot(values, depth, color=colour, marker=".", markersize=4, linewidth=1, label=label)
        print(label, "until", f"{end:.3g} s;", "V_s over the correlation:",
              *(f"{z:g} m: {v / w:.2f}" for z, v, w in zip(depth, velocity, expected)))
        print(label, "r_u above 0.95 at", *(f"{z:g}" for z in depth[ru > 0.95]), "m")
    axes[0, 0].plot(expected, depth, color="black", linestyle="--", linewidth=1, label="correlation for sand")
    axes[0, 0].fill_betweenx(depth, 0.85 * expected, 1.15 * expected, color="black", alpha=0.08, linewidth=0)
    axes[0, 0].set(xlabel="$V_s$ at the start (m/s)", ylabel="Depth (m)", xlim=(0, None), ylim=(20, 0))
    axes[0, 1].set(xlabel=f"Largest $r_u$ until {end:.3g} s")
    axes[0, 2].set(xlabel=rf"Largest $|\gamma|$ until {end:.3g} s (%)", xscale="log")
    legend_below(figure, axes[0, 0], 3, 0.08)
    figure.savefig(figure_path)


if __name__ == "__main__":
    main()

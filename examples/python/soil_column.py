#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A soil column: how a loose layer changes what arrives at the surface.

Fifteen metres of saturated sand on elastic rock are shaken by a sine of growing amplitude, once with a loose layer that
liquefies and once with dense sand instead. Needs a build with deal.II, as the default is.

    python3 soil_column.py [--small] [--output FOLDER]
"""
import argparse
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)

from isostat import column  # noqa: E402

parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("--small", action="store_true", help="two seconds of shaking")
parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("results/examples"))
options = parser.parse_args()
options.output.mkdir(parents=True, exist_ok=True)
duration = 2 if options.small else 7

CRUST = {"name": "crust", "thickness": "2 m", "cells": 4, "density": "1800 kg/m3", "material": "elastic",
         "shear_velocity": "120 m/s"}
LOOSE = {"name": "loose sand", "thickness": "5 m", "cells": 10, "density": "1900 kg/m3", "porosity": 0.44,
         "material": "iwan", "k0": 0.5, "reference_pressure": "100 kPa", "shear_velocity": "160 m/s"}
DENSE = {"name": "dense sand", "thickness": "8 m", "cells": 16, "density": "2050 kg/m3", "porosity": 0.38,
         "material": "iwan", "k0": 0.5, "reference_pressure": "100 kPa", "shear_velocity": "200 m/s",
         "strength_ratio": 0.65,         "phase_transformation_ratio": 0.35, "contraction": 0.2, "dilation": 0.6}


def shake(name, middle):
    """The deposit with this layer below the crust, shaken; layers read from the surface down."""
    scene = column.ColumnScene(
        {"title": name, "water": {"drainage": "undrained"}, "layer": [CRUST, middle, DENSE],
         "base": {"kind": "compliant", "density": "2300 kg/m3", "shear_velocity": "800 m/s"},
         "motion": [{"axis": "x", "kind": "harmonic", "amplitude": "0.05 g", "frequency": "1.5 Hz",
                     "duration": f"{duration} s", "ramp": f"{duration / 3:.2f} s"}],
         "analysis": {"duration": f"{duration} s"},
         "output": {"history_interval": "0.01 s", "depths": ["4.5 m"], "profile_interval": "0.1 s"}})
    return column.run(scene, options.output / f"soil_column_{name}", overwrite=True)


DENSER = {**DENSE, "name": "denser", "thickness": "5 m", "cells": 10}
cases = {"loose": shake("loose", LOOSE), "dense": shake("dense", DENSER)}
figure, (surface, pressure, loop) = plt.subplots(3, 1, figsize=(7, 8), layout="constrained")
for (name, case), colour in zip(cases.items(), ("tab:red", "tab:blue")):
    h = case.history
    surface.plot(h["time"], h["surface_ax"] / 9.81, lw=0.8, color=colour, label=f"{name} layer")
    pressure.plot(h["time"], h["d0_ru"], lw=1, color=colour)
    loop.plot(100 * h["d0_gamma_xz"], h["d0_tau_xz"] / 1e3, lw=0.8, color=colour)
    print(f"{name}: peak at the surface {abs(h['surface_ax']).max() / 9.81:.2f} g, "
          f"largest r_u at 4.5 m {h['d0_ru'].max():.2f}")
surface.set(xlabel="time (s)", ylabel="acceleration (g)", title="surface")
surface.legend(frameon=False, ncols=2)
pressure.set(xlabel="time (s)", ylabel="$r_u$", title="pore pressure ratio at 4.5 m")
loop.set(xlabel="shear strain (%)", ylabel="shear stress (kPa)", title="soil at 4.5 m")
figure.savefig(options.output / "soil_column.png", dpi=100)

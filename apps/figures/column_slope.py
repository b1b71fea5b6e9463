# SPDX-License-Identifier: BSD-3-Clause
"""Figure of a slope: how far its surface has moved, and where the soil has sheared."""
import numpy as np

from .column_soil import depth_axis
from .common import BLACK, BLUE, GREY, RED, letters, plt
from .drawing import draws

LEFT = {"end_displacement", "end_gamma_xz", "tau_0", "node_depth"}


def is_slope(column):
    """Whether it is one that has moved."""
    return LEFT <= column.profiles.keys() and np.abs(column.profiles["end_displacement"]).max() > 1e-6


@draws("fig_spreading")
def spreading(column):
    """Displacement of the surface in time; at the end displacement and shear strain over the depth, next to static
    shear stress and normal effective stress of the start; dotted: boundaries between layers."""
    if not is_slope(column):
        return None
    figure, panels = plt.subplot_mosaic([["time", "time", "time"], ["moved", "strain", "stress"]],
                                        figsize=(7.2, 6.2), height_ratios=(1, 1.9), layout="constrained")
    panels["strain"].sharey(panels["moved"])
    panels["stress"].sharey(panels["moved"])
    if column.has("surface_ux"):
        panels["time"].plot(column.time, column["surface_ux"], color=BLACK)
    panels["time"].axhline(0, color=GREY, linewidth=0.7)
    panels["time"].set(xlim=(column.time[0], column.time[-1]), xlabel="Time (s)")
    of_rock = column.scene.get("base", {}).get("kind") == "compliant"
    panels["time"].set_ylabel("Surface, downslope" + (",\nwith the rock's motion (m)" if of_rock else " (m)"))
    depth = column.profiles["depth"]
    panels["moved"].plot(column.profiles["end_displacement"], column.profiles["node_depth"], color=BLUE)
    panels["moved"].set(xlabel="Against the base,\nat the end (m)", ylabel="Depth (m)")
    z, gamma = column.broken(depth, 100 * column.profiles["end_gamma_xz"])
    panels["strain"].plot(gamma, z, color=BLACK)
    panels["strain"].set_xlabel(r"$\gamma_{xz}$ at the end (%)")
    panels["stress"].plot(column.profiles["tau_0"] / 1e3, depth, color=RED, label=r"$\tau_0$")
    panels["stress"].plot(column.profiles["sigma_v0"] / 1e3, depth, color=GREY, label=r"$\sigma_{n0}^\prime$")
    panels["stress"].set_xlabel("Stress at the start (kPa)")
    panels["stress"].legend()
    letters(list(panels.values()))
    for name, axes in panels.items():
        if name != "time":
            depth_axis(column, axes, depth)
            axes.set_xlim(left=min(0.0, float(np.nanmin(axes.get_xlim()))))
    return figure

# SPDX-License-Identifier: BSD-3-Clause
"""A column of packings in one picture: motions, I_R over depth and time, packings with their force chains."""
import re

import h5py
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection

from .column_grains import shade_index
from .column_results import quantity
from .column_soil import depth_axis
from .common import BLACK, BLUE, GREY, letters, plt
from .drawing import draws

ROWS = 3  # of packings
WIDTH = 0.8  # of a line that stands for the mean contact force at the start, points


def snapshots(folder, k):
    """Times and files of the packing at a snapshot depth."""
    path = folder / f"grains/d{k}.pvd"
    found = re.findall(r'timestep="([^"]+)".*?file="([^"]+)\.vtp"', path.read_text()) if path.exists() else []
    return [(float(time), folder / f"grains/{name}.h5") for time, name in found]


def forces(file):
    with h5py.File(file) as results:
        return results["snapshot/contacts/normal_force"][:]


def draw_packing(axes, file, mean_force, up=2):
    """Grains from the side, x to the right, y (1) or z (2) up; a line along each contact, as wide as its force."""
    with h5py.File(file) as results:
        grains = results["snapshot/grains/position"][:]
        contact = {name: results[f"snapshot/contacts/{name}"][:]
                   for name in ("first", "second", "normal", "normal_force", "overlap")}
    place, radius = grains[:, (0, up)], grains[:, 3]
    axes.add_collection(EllipseCollection(2 * radius, 2 * radius, np.zeros_like(radius), units="xy", offsets=place,
                                          transOffset=axes.transData, facecolor=GREY, edgecolor="none", alpha=0.13))
    normal, lines = contact["normal"][:, (0, up)], []
    for grain, sign in ((contact["first"], 1), (contact["second"], -1)):  # two halves, also through a face of the cell
        begin, reach = place[grain], (radius[grain] - contact["overlap"] / 2)[:, None]
        lines += list(np.stack([begin, begin + sign * reach * normal], axis=1))
    axes.add_collection(LineCollection(lines, colors=BLUE, capstyle="round",
                                       linewidths=np.tile(WIDTH * contact["normal_force"] / mean_force, 2)))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.axis("off")


def draw_motions(column, axes):
    axis = (column.horizontal or column.moving)[0]
    axes.plot(column.time, column[f"input_a{axis}"], color=GREY, linewidth=0.7, label="base")
    axes.plot(column.time, column[f"surface_a{axis}"], color=BLACK, linewidth=0.8, label="surface")
    axes.set_ylabel(f"$a_{axis}$ (m/s$^2$)")
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=2, borderaxespad=0)


def draw_map(column, figure, axes, depths, times):
    """I_R, with the places and moments of the packings next to it."""
    shade_index(column, figure, axes, 30)
    axes.plot(*np.meshgrid(times, depths), "o", color=BLACK, markerfacecolor="white", markersize=5, clip_on=False,
              linestyle="none", zorder=5)
    depth_axis(column, axes, column.grains.profiles["depth"])
    axes.set(xlim=(column.time[0], column.time[-1]), xlabel="Time (s)", ylabel="Depth (m)")


def snapshot_rows(column):
    """The first depths that have snapshots."""
    asked = [quantity(depth) for depth in column.scene.get("grains", {}).get("snapshot_depths", [])]
    return [(depth, taken) for k, depth in enumerate(asked) if len(taken := snapshots(column.folder, k)) > 1][:ROWS]


@draws("fig_picture")
def picture(column):
    """Acceleration of base and surface; I_R over depth and time; where it has circles, packings from the side with
    their contact forces (grains.snapshot_depths)."""
    rows = snapshot_rows(column)
    if not rows or "IR" not in column.grains.profiles or not column.moving:
        return None
    figure = plt.figure(figsize=(10.5, 5.2), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=(1.25, 1))
    top, below = left.subplots(2, 1, sharex=True, height_ratios=(1, 2.2))
    chosen = [0, len(rows[0][1]) // 2, -1]
    times = [rows[0][1][k][0] for k in chosen]
    draw_motions(column, top)
    draw_map(column, left, below, [depth for depth, _ in rows], times)
    panels = right.subplots(len(rows), len(chosen), squeeze=False)
    for row, (depth, taken) in zip(panels, rows):
        mean_force = forces(taken[0][1]).mean()
        for axes, k in zip(row, chosen):
            draw_packing(axes, taken[k][1], mean_force)
        row[0].annotate(f"{depth:g} m", (0, 0.5), xycoords="axes fraction", xytext=(-6, 0), rotation=90, va="center",
                        ha="right", textcoords="offset points", fontsize=9)
    for axes, time in zip(panels[0], times):
        axes.set_title(f"{time:.1f} s", fontsize=9)
    letters([top, below, panels[0][0]])
    right.suptitle("contact forces, as wide as they are large", fontsize=8.5, x=0.99, ha="right")
    return figure

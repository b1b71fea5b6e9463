# SPDX-License-Identifier: BSD-3-Clause
"""Figure of a plate that moves into a box of soil."""
from .column_box import Mesh
from .common import BLACK, BLUE, GREY, cut_ends, letters, plt
from .drawing import draws


def has_plate(column):
    return bool(column.plate)


@draws("fig_plate")
def plate(column):
    """Force against it and normal stress next to it over its way, shear strain at the end."""
    if not has_plate(column) or not column.maps:
        return None
    figure, panels = plt.subplot_mosaic([["force", "pressure"], ["map", "map"]], figsize=(7.2, 5.6),
                                        height_ratios=(1, 1.25), layout="constrained")
    way = 1e3 * column.plate["displacement"]
    panels["force"].plot(way, column.plate["force"] / 1e3, color=BLACK)
    panels["force"].axhline(column.plate["force"][0] / 1e3, color=GREY, linewidth=0.7, label="in situ")
    panels["force"].legend()
    panels["force"].set_ylabel("Force against the plate (kN/m)")
    panels["pressure"].plot(way, column.plate["pressure"] / 1e3, color=BLUE)
    panels["pressure"].set_ylabel("Normal stress next to it (kPa)")
    for name in ("force", "pressure"):
        panels[name].set(xlabel="Displacement into the soil (mm)", ylim=(min(0, panels[name].get_ylim()[0]), None))
    mesh, maps = Mesh(column.maps), column.maps
    gamma = 100 * abs(maps["gamma_xz"][-1])
    high = max(sorted(gamma)[int(0.98 * len(gamma))], 1e-6)
    elements = mesh.show(panels["map"], len(maps["time"]) - 1, gamma, 0, high, "magma_r")
    figure.colorbar(elements, ax=panels["map"], label=r"$|\gamma_{xz}|$ (%)", fraction=0.03, pad=0.01,
                    extend=cut_ends(mesh.means(gamma), 0, high))
    panels["map"].set_title(f"End, displacements drawn {mesh.exaggeration:g} times", fontsize=8.5, loc="right")
    panels["map"].set_xlabel("x (m)")
    letters(list(panels.values()))
    return figure

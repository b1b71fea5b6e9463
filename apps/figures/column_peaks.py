# SPDX-License-Identifier: BSD-3-Clause
"""Figure of the largest values of a column over the depth: acceleration, velocity, displacement, shear strain."""
import numpy as np
from matplotlib.ticker import MaxNLocator

from .column_box import is_box
from .column_soil import depth_axis
from .common import BLACK, letters, plt
from .drawing import draws

SPECS = (("peak_acceleration", "node_depth", 1, "acceleration", "m/s$^2$"),
         ("peak_velocity", "node_depth", 1, "velocity", "m/s"),
         ("peak_displacement", "node_depth", 1, "displacement", "m"),
         ("peak_gamma", "depth", 100, r"shear strain $\gamma$", "%"))


@draws("fig_peaks")
def peaks(column):
    """Largest horizontal acceleration, velocity and displacement and largest shear strain of all steps over the depth;
    a dot marks the largest of each, whose value and depth are above it."""
    specs = [spec for spec in SPECS if column.profiles and {spec[0], spec[1]} <= column.profiles.keys()
             and column.profiles[spec[0]].any()]
    if not column.shaken or is_box(column) or not specs:
        return None
    figure, panels = plt.subplots(1, len(specs), figsize=(2.3 * len(specs), 4.0), sharey=True, squeeze=False,
                                  layout="constrained")
    figure.get_layout_engine().set(w_pad=0.1)
    letters(panels)
    for axes, (name, over, factor, word, unit) in zip(panels[0], specs):
        values, depth = factor * column.profiles[name], column.profiles[over]
        at = int(np.argmax(values))
        axes.plot(values, depth, color=BLACK, linewidth=1.2)
        axes.plot(values[at], depth[at], "o", color=BLACK, markersize=3.5, clip_on=False, zorder=5)
        axes.set_title(f"{values[at]:.3g} {unit}\nat {depth[at]:.3g} m", loc="right", fontsize=8.5, pad=5)
        against = "\nagainst the base" if column.base is None and name in ("peak_velocity", "peak_displacement") else ""
        axes.set(xlabel=f"Largest {word} ({unit}){against}", xlim=(0, None))
        axes.xaxis.set_major_locator(MaxNLocator(4))
        depth_axis(column, axes, depth)
    panels[0, 0].set_ylabel("Depth (m)")
    return figure

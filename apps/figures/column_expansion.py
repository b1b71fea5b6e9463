# SPDX-License-Identifier: BSD-3-Clause
"""Where soil expands and where it compresses while its water moves: figure of a column under a less permeable layer."""
import numpy as np
from matplotlib.colors import SymLogNorm

from .column_soil import map_over_time
from .common import BLACK, BLUE, ORANGE, letters, plt
from .drawing import draws


@draws("fig_expansion")
def expansion(column):
    """Below less permeable layers (black lines): net expansion and settlement, above the volumetric strain over depth
    and time, on one scale for both signs; dotted: boundaries between layers."""
    caps = dict(zip((f"expansion_{k}" for k in range(len(column.columns))), column.capped_boundaries()))
    names = [name for name in caps if column.peak(name) > 1e-6]
    strain = column.profile("eps_zz")
    if not names or strain is None or len(column.profiles["time"]) < 2:
        return None
    figure, (top, axes) = plt.subplots(2, 1, figsize=(7.2, 5.2), sharex=True, height_ratios=(1, 2),
                                       layout="constrained")
    for name, style in zip(names, ("-", "--", ":", "-.") * len(names)):
        top.plot(column.time, 1e3 * column[name], style, color=BLUE, label=f"net expansion below {caps[name]:.3g} m")
    top.plot(column.time, 1e3 * column["settlement"], color=ORANGE, label="settlement of the surface")
    top.set_ylabel("Height (mm)")
    top.legend(loc="upper left", fontsize=8)
    top.set_ylim(-0.06 * top.get_ylim()[1], 1.25 * top.get_ylim()[1])
    expanded = -100 * strain  # volume strain of a column, positive in expansion
    largest = max(1e-6, float(np.nanmax(np.abs(expanded))))
    linear = float(f"{largest / 50:.1g}")
    norm = SymLogNorm(linear, vmin=-largest, vmax=largest)  # one for both sides: where water gathers they are far apart
    shade, _, _ = map_over_time(column, axes, expanded, cmap="RdBu", norm=norm)
    decades = [linear * 10**k for k in range(3) if linear * 10**k < 0.7 * largest]
    ticks = [-largest, *(-x for x in reversed(decades)), 0, *decades, largest]
    bar = figure.colorbar(shade, ax=axes, aspect=25, pad=0.015, ticks=ticks, format="%.2g")
    bar.ax.minorticks_off()
    bar.set_label(f"Volumetric strain (%), logarithmic beyond {linear:g} %\ncompression     expansion", fontsize=8.5)
    for name in names:
        axes.axhline(caps[name], color=BLACK, linewidth=0.9)
    letters([top, axes])
    return figure

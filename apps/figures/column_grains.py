# SPDX-License-Identifier: BSD-3-Clause
"""Figures of the packings in a soil column: redundancy index, coordination number, fabric, yielding contacts."""
import numpy as np
from matplotlib.colors import TwoSlopeNorm
from matplotlib.lines import Line2D

from .column_soil import (LIQUEFIED_RU, MIN_RU, cells_over_depth, depth_axis, draw_input, edges, outline, paged,
                          pore_pressure_ratio, profiles_in_time)
from .common import BLACK, BLUE, GREEN, ORANGE, RED, index_label, letters, plt
from .drawing import draws

ISOSTATIC = 1.0  # redundancy index below which the contacts cannot hold the grains
MIN_Z = 2  # coordination number below which the fabric of the few contacts left means nothing
YIELDING = (("f_S", "sliding (S)", BLUE), ("f_SR", "both (SR)", GREEN), ("f_R", "rolling (R)", ORANGE))


def first(time, reached):
    """The time from which on a condition is met for the first time, or None."""
    return float(time[np.argmax(reached)]) if np.any(reached) else None


def label_of(grains, names=("IR_constraints",)):
    """Of an axis with the redundancy index of packings, by the columns that say what it counts."""
    return "Redundancy index\n" + index_label(np.concatenate([np.ravel(grains.get(name, 6)) for name in names]))


@draws("fig_grains_profiles")
def grains_profiles(column):
    """Packings of grains: redundancy index I_R, coordination number, fabric over the depth at several times; dashed:
    I_R = 1 and no fabric, dotted: boundaries between layers."""
    grains = column.grains.profiles
    if "IR" not in grains:
        return None
    specs = [(grains["IR"], label_of(grains), ISOSTATIC), (grains["Z"], "Coordination number $Z$", None),
             (np.where(grains["Z"] >= MIN_Z, grains["F_yx"], np.nan),
              rf"Fabric $F_{{[v-h]}}$, where $Z \geq {MIN_Z}$", 0.0)]
    panels = profiles_in_time(column, specs, grains, grains["time"][:1], 9.0, marker=".", linewidth=0.9, markersize=3.5)
    for axes in panels[:2]:
        axes.set_xlim(left=0)
    return panels[0].figure


# --- map -------------------------------------------------------------------------------------------------------------


def wet_cells(column):
    """r_u as [time x depth], with its depths and times; None in a dry soil."""
    ru = pore_pressure_ratio(column)
    if ru is None or len(column.profiles["time"]) < 2:
        return None
    return ru, column.profiles["depth"], column.profiles["time"]


def draw_onset(axes, depth, time, reached, **style):
    """When each depth gets there first."""
    at = [(first(time, row), z) for row, z in zip(reached, depth) if row.any()]
    axes.plot(*zip(*at) if at else ([], []), linestyle="none", **style)


def shade_index(column, figure, axes, aspect):
    """Colours of I_R over time and depth, white where there are no grains, and their bar; the borders of the cells in
    both and the values within. aspect: of the bar"""
    grains = column.grains.profiles
    time, (y, index) = grains["time"], cells_over_depth(column, grains["depth"], grains["IR"])
    x = edges(time, time[0], time[-1])
    shade = axes.pcolormesh(x, y, index, cmap="RdBu", rasterized=True,
                            norm=TwoSlopeNorm(ISOSTATIC, 0, max(2.0, float(np.nanmax(index)))))
    figure.colorbar(shade, ax=axes, aspect=aspect, pad=0.02).set_label(label_of(grains))
    axes.grid(False)
    return x, y, index


@draws("fig_grains_map")
def grains_map(column):
    """I_R over depth and time, white where there are no grains; next to it when each depth falls below I_R = 1 and
    exceeds r_u = 0.95; dotted: boundaries between layers."""
    grains = column.grains.profiles
    if "IR" not in grains or len(grains["time"]) < 2:
        return None
    depth, time, ir = grains["depth"], grains["time"], grains["IR"].T
    figure, ((top, corner), (axes, side)) = plt.subplots(
        2, 2, figsize=(8.6, 4.9), sharex="col", height_ratios=(1, 2.6), width_ratios=(3.2, 1), layout="constrained")
    draw_input(column, top)
    x, y, index = shade_index(column, figure, axes, 25)
    outline(axes, x, y, index < ISOSTATIC, colors=BLACK, linewidths=1.0)
    draw_onset(side, depth, time, ir < ISOSTATIC, marker="o", markersize=4, color=BLACK)
    wet = wet_cells(column)
    if wet:
        ru, places, times = wet
        borders, wet_ru = cells_over_depth(column, places, ru)
        outline(axes, edges(times, times[0], times[-1]), borders, wet_ru > LIQUEFIED_RU, colors=ORANGE, linewidths=0.8)
        draw_onset(side, places, times, ru.T > LIQUEFIED_RU, marker="o", markersize=7.5, color=ORANGE,
                   markerfacecolor="none", markeredgewidth=1.3)
    finish_map(column, (top, corner, axes, side), depth, time, wet)
    return figure


def finish_map(column, panels, depth, time, wet):
    top, corner, axes, side = panels
    corner.axis("off")
    handles = [Line2D([], [], color=BLACK, marker="o", markersize=4, linewidth=1.2, label="$I_R$ = 1")]
    if wet:
        handles.append(Line2D([], [], color=ORANGE, marker="o", markersize=7.5, markerfacecolor="none", linewidth=1.2,
                              label=f"$r_u$ = {LIQUEFIED_RU}"))
    corner.legend(handles=handles, loc="center")
    for each in (axes, side):
        depth_axis(column, each, depth)
        each.set_xlabel("Time (s)")
    side.tick_params(labelleft=False)
    side.set_xlim(time[0], time[0] + 1.12 * max(side.dataLim.x1 - time[0], 0.05 * (time[-1] - time[0])))
    side.set_title("first time", loc="right", fontsize=9, pad=5)
    axes.set(xlim=(time[0], time[-1]), ylabel="Depth (m)")
    letters([top, axes, side])


# --- output depths ---------------------------------------------------------------------------------------------------


def marked(axes, time, values, at, colour):
    """A dot on a curve."""
    if at is not None:
        axes.plot(at, values[np.searchsorted(time, at)], "o", color=colour, markersize=4.5, markeredgecolor=BLACK,
                  markeredgewidth=0.6, zorder=6)


def onsets(column, prefix):
    """When I_R falls below 1 for the first time and when r_u exceeds 0.95, at an output depth."""
    ir = first(column.grains.columns["time"], column.grains.columns[f"{prefix}_IR"] < ISOSTATIC)
    wet = column.has(f"{prefix}_ru")
    return ir, first(column.time, column[f"{prefix}_ru"] > LIQUEFIED_RU) if wet else None


def draw_redundancy(column, axes, points, shades):
    grains = column.grains.columns
    for (depth, prefix), shade in zip(points, shades):
        axes.plot(grains["time"], grains[f"{prefix}_IR"], color=shade, linewidth=0.9, label=f"{depth:g} m")
        marked(axes, grains["time"], grains[f"{prefix}_IR"], onsets(column, prefix)[0], shade)
    axes.axhline(ISOSTATIC, color=RED, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
    axes.set(ylim=(0, None), ylabel=label_of(grains, [f"{prefix}_IR_constraints" for _, prefix in points]))
    axes.set_title("dots: below 1 for the first time", loc="right", fontsize=8.5, pad=5)
    axes.legend(loc="upper left", bbox_to_anchor=(1.005, 1.0), borderaxespad=0)


def draw_ratio(column, axes, points, shades):
    for (_, prefix), shade in zip(points, shades):
        if column.has(f"{prefix}_ru"):
            axes.plot(column.time, column[f"{prefix}_ru"], color=shade)
            marked(axes, column.time, column[f"{prefix}_ru"], onsets(column, prefix)[1], shade)
    axes.axhline(LIQUEFIED_RU, color=RED, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
    axes.set(ylim=(min(0, axes.get_ylim()[0]), max(1.02, axes.get_ylim()[1])), ylabel="Pore pressure ratio $r_u$")
    axes.set_title(f"dots: above {LIQUEFIED_RU} for the first time", loc="right", fontsize=8.5, pad=5)


def draw_yielding(column, axes, depth, prefix):
    """Stacked shares of the contacts that yield."""
    grains = column.grains.columns
    shares = [np.nan_to_num(grains[f"{prefix}_{name}"]) for name, _, _ in YIELDING]
    axes.stackplot(grains["time"], shares, labels=[label for _, label, _ in YIELDING], linewidth=0,
                   colors=[colour for _, _, colour in YIELDING], rasterized=True)
    onset = onsets(column, prefix)[0]
    if onset is not None:
        axes.axvline(onset, color=BLACK, linewidth=0.9, linestyle=(0, (4, 2)), label="first $I_R$ < 1")
    axes.set_ylim(0, 1)
    axes.set_yticks([0, 0.5, 1])
    axes.annotate(f"{depth:g} m", (1.005, 0.5), xycoords="axes fraction", xytext=(2, 0), textcoords="offset points",
                  ha="left", va="center", fontsize=9)


@draws("fig_grains_history")
def grains_history(column):
    """I_R, r_u and yielding contacts at the output depths; dashed, red: I_R = 1 and r_u = 0.95."""
    grains = column.grains
    points = [(depth, prefix) for depth, prefix in grains.points if f"{prefix}_IR" in grains.columns]
    if not points or len(grains.columns["time"]) < 2:
        return None
    return paged(points, lambda some: draw_grains_history(column, some))


def draw_grains_history(column, points):
    grains = column.grains
    wet = any(column.peak(f"{prefix}_ru") > MIN_RU for _, prefix in points)
    n, shades = len(points), plt.get_cmap("plasma")(np.linspace(0.0, 0.85, len(points)))
    figure, panels = plt.subplots(1 + wet + n, 1, figsize=(7.2, 2.1 * (1 + wet) + 0.95 * n + 0.7), sharex=True,
                                  height_ratios=[2.1] * (1 + wet) + [0.95] * n, layout="constrained")
    draw_redundancy(column, panels[0], points, shades)
    if wet:
        draw_ratio(column, panels[1], points, shades)
    for axes, (depth, prefix) in zip(panels[1 + wet:], points):
        draw_yielding(column, axes, depth, prefix)
    known = {text: handle for axes in panels[1 + wet:] for handle, text in zip(*axes.get_legend_handles_labels())}
    panels[1 + wet].legend(known.values(), known.keys(),
                           loc="lower right", bbox_to_anchor=(1, 1), ncols=4, borderaxespad=0.1, handlelength=1.4)
    panels[1 + wet + (n - 1) // 2].set_ylabel("Share of the contacts")
    letters(panels[:2 + wet])
    panels[-1].set(xlim=(grains.columns["time"][0], grains.columns["time"][-1]), xlabel="Time (s)")
    return figure

# SPDX-License-Identifier: BSD-3-Clause
"""Figures of the soil in a column: profiles, pore pressure over depth and time, loops and stress paths."""
import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap, PowerNorm
from matplotlib.ticker import MaxNLocator

from .common import BLACK, BLUE, GREY, NOISE, ORANGE, RED, letters, note, plt
from .drawing import draws

TIMES = ListedColormap(plt.get_cmap("viridis_r")(np.linspace(0.06, 1, 256)))  # of time: pale early, dark late
EARLY = 0.25  # of the motion: half of its squared acceleration by then is early
SHARES = (0.02, 0.1, 0.3, 0.5, 0.7, 0.9)  # of the squared acceleration: when profiles are drawn
MOST_DEPTHS = 6  # output depths on a page
MIN_RU = 1e-3  # below it water plays no part
LIQUEFIED_RU = 0.95
MIN_CHANGE = 1e-3  # of an effective stress, for a stress path
MIN_SHARE = 0.1  # of the largest shear stress: a direction with less is not drawn (grains always stray a little)


def depth_axis(column, axes, depth):
    """Depth downwards, with the layers' boundaries."""
    bottom = column.bottom(depth)
    axes.set_ylim(bottom, 0)
    for boundary in column.boundaries():
        axes.axhline(boundary, color=GREY, linewidth=0.7, linestyle=(0, (1, 1.5)), zorder=1.4)


def times_of_motion(column, shares):
    """Times by which these shares of the squared acceleration have passed, on the mean of surface and input: a surface
    that liquefies soon comes to rest. Evenly spread if nothing moves."""
    passed = []
    for where in ("surface", "input"):
        energy = sum(np.cumsum(np.nan_to_num(column[f"{where}_a{axis}"]) ** 2) for axis in "xyz"
                     if column.has(f"{where}_a{axis}"))
        if np.ndim(energy) and energy[-1] > 0:
            passed.append(energy / energy[-1])
    if not passed:
        return column.time[0] + np.array(shares) * (column.time[-1] - column.time[0])
    at = np.searchsorted(np.mean(passed, axis=0), shares)
    return column.time[np.minimum(at, len(column.time) - 1)]


def time_norm(column):
    """Colours for the motion; what follows has one colour. Where the surface soon comes to rest, more of them for the
    beginning: half by half of the squared acceleration."""
    half, end = times_of_motion(column, [0.5, 0.99]) - column.time[0]
    end = max(end, column.time[1] - column.time[0])
    early = 0 < half < EARLY * end
    gamma = max(0.3, np.log(0.5) / np.log(half / end)) if early else 1.0
    return PowerNorm(gamma, column.time[0], column.time[0] + end)


def time_bar(figure, panels, norm, last, aspect=40, unit="s"):
    """The bar that explains the colours of time."""
    bar = figure.colorbar(plt.cm.ScalarMappable(norm, TIMES), ax=panels, aspect=aspect, pad=0.015,
                          extend="max" if norm.vmax < 0.98 * last else "neither", extendfrac=0.03)
    later = f"; one colour after {norm.vmax:.3g} {unit}" if norm.vmax < 0.98 * last else ""
    bar.set_label(f"Time ({unit}){later}")


def resultant(one, other):
    if one is None or other is None:
        return np.abs(one) if other is None else np.abs(other)
    return np.hypot(one, other)


def so_far(values):
    return np.maximum.accumulate(np.nan_to_num(np.abs(values)), axis=0)


def vertical_ratio(column, stress):
    """A stress over the initial effective vertical stress; at the very surface there is none."""
    initial = column.profiles.get("sigma_v0")
    if stress is None or initial is None:
        return None
    return stress / np.where(initial > 1e-3 * initial.max(), initial, np.nan)


def pore_pressure_ratio(column):
    ru = column.profile("ru")
    return ru if ru is not None and np.nanmax(np.abs(ru)) > MIN_RU else None


def profiles_in_time(column, specs, table, more, width, **line):
    """A panel for each (values [time x depth], label, level of a line or None), with a curve at each of several times:
    those of the motion, the last, and `more`.   @param table  with time and depth"""
    depth, time = table["depth"], table["time"]
    figure, panels = plt.subplots(1, len(specs), figsize=(width, 4.3), sharey=True, squeeze=False, layout="constrained")
    norm = time_norm(column)
    targets = [*more, *times_of_motion(column, SHARES), time[-1]]
    chosen = np.unique([int(np.argmin(np.abs(time - t))) for t in targets])
    time_bar(figure, panels[0], norm, time[-1])
    letters(panels)
    for axes, (values, label, level) in zip(panels[0], specs):
        for row in chosen:
            z, curve = column.broken(depth, values[row])
            axes.plot(curve, z, color=TIMES(norm(time[row])), **line)
        if level is not None:
            axes.axvline(level, color=RED, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
        axes.set_xlabel(label)
        axes.xaxis.set_major_locator(MaxNLocator(5))
        depth_axis(column, axes, depth)
    panels[0, 0].set_ylabel("Depth (m)")
    return panels[0]


@draws("fig_profiles")
def profiles(column):
    """Shear strain, r_u, shear stress over sigma'_v in situ, against the depth at several times; strain and stress are
    the largest of the profiles stored so far, not of all steps (fig_peaks); dashed: r_u = 1, dotted: boundaries between
    layers."""
    if not column.shaken or not column.profiles:
        return None
    gamma = [column.profile(name) for name in ("gamma_xz", "gamma_yz")]
    tau, pressed = [column.profile(name) for name in ("tau_xz", "tau_yz")], column.profile("sigma_v")
    specs = []
    if pressed is not None and all(values is None or np.nanmax(np.abs(values)) < NOISE * np.ptp(pressed, axis=0).max()
                                   for values in tau):
        gamma = tau = [None, None]
    if any(values is not None for values in gamma):
        specs.append((100 * so_far(resultant(*gamma)), r"Largest $|\gamma|$ of profiles (%)", None))
    if pore_pressure_ratio(column) is not None:
        specs.append((column.profile("ru"), "Pore pressure ratio $r_u$", 1.0))
    if any(values is not None for values in tau):
        ratio = vertical_ratio(column, so_far(resultant(*tau)))
        if ratio is not None:
            specs.append((ratio, r"Largest $|\tau|/\sigma_{v0}^\prime$ of profiles", None))
    if not specs:
        return None
    panels = profiles_in_time(column, specs, column.profiles, [], 2.6 * len(specs) + 1.2, linewidth=1.2)
    for axes, (values, *_) in zip(panels, specs):
        axes.set_xlim(left=min(0.0, float(np.nanmin(values))))
    return panels[0].figure


@draws("fig_velocity")
def velocity(column):
    """Shear-wave velocity of small strain at the points over the depth at the start, where it varies; dotted:
    boundaries between layers."""
    speeds = column.velocities.get("shear_velocity")
    if speeds is None or np.ptp(speeds) < 1e-6 * speeds.max():
        return None
    figure, axes = plt.subplots(figsize=(5.2, 4.0), layout="constrained")
    depth = column.velocities["depth"]
    z, curve = column.broken(depth, speeds)
    axes.plot(curve, z, color=BLACK, linewidth=1.0, marker=".", markersize=4 if len(depth) < 50 else 0)
    axes.set(xlim=(0, None), xlabel="Shear-wave velocity at the start (m/s)", ylabel="Depth (m)")
    depth_axis(column, axes, depth)
    return figure


def edges(middle, low, high):
    """Borders of cells around the given points."""
    return np.concatenate([[low], 0.5 * (middle[1:] + middle[:-1]), [high]])


def draw_input(column, axes):
    for axis in column.moving:
        axes.plot(column.time, column[f"input_a{axis}"], linewidth=0.7, label=f"${axis}$",
                  color={"x": BLACK, "y": ORANGE, "z": BLUE}[axis])
    if len(column.moving) > 1:
        axes.legend(loc="upper right", ncols=len(column.moving))
    axes.set_ylabel("Input (m/s$^2$)")


def outline(axes, x, y, inside, **style):
    """The borders of the cells [y, x] that are inside, along the cells: no shape between points is made up."""
    rows, columns = np.nonzero(inside[1:] != inside[:-1])
    parts = [[(x[i], y[j + 1]), (x[i + 1], y[j + 1])] for j, i in zip(rows, columns)]
    rows, columns = np.nonzero(inside[:, 1:] != inside[:, :-1])
    parts += [[(x[i + 1], y[j]), (x[i + 1], y[j + 1])] for j, i in zip(rows, columns)]
    axes.add_collection(LineCollection(parts, capstyle="projecting", **style))


def cells_over_depth(column, depth, values):
    """Borders of cells around points and values [time x depth] as [depth x time]: what each point stands for, and
    cells of not-a-number over layers that have no point."""
    borders, rows = [], []
    for top, bottom, row in zip(*column.shares(depth), values.T):
        if borders and top > borders[-1] + 1e-9:
            borders.append(top)
            rows.append(np.full(len(row), np.nan))
        borders += [bottom] if borders else [top, bottom]
        rows.append(row)
    return np.array(borders), np.array(rows)


def map_over_time(column, axes, values, **style):
    """Colours of a profile over depth and time, whose cells are the points' own share of both.
    @return  the coloured cells, their borders in time and depth, values in the order of the cells"""
    depth, time = column.profiles["depth"], column.profiles["time"]
    x, (y, cells) = edges(time, time[0], time[-1]), cells_over_depth(column, depth, values)
    shade = axes.pcolormesh(x, y, cells, rasterized=True, **style)
    depth_axis(column, axes, depth)
    axes.grid(False)
    axes.set(xlim=(time[0], time[-1]), xlabel="Time (s)", ylabel="Depth (m)")
    return shade, (x, y), cells


@draws("fig_ru_map")
def ru_map(column):
    """r_u over depth and time, below the input; dotted: boundaries between layers."""
    ru = pore_pressure_ratio(column)
    if column.consolidation or ru is None or len(column.profiles["time"]) < 2:
        return None
    figure, (top, axes) = plt.subplots(2, 1, figsize=(7.2, 4.9), sharex=True, height_ratios=(1, 2.6),
                                       layout="constrained")
    draw_input(column, top)
    shade, borders, cells = map_over_time(column, axes, ru, cmap="YlGnBu", vmin=0, vmax=max(1.0, float(np.nanmax(ru))))
    if np.nanmax(ru) > LIQUEFIED_RU:
        outline(axes, *borders, cells > LIQUEFIED_RU, colors=RED, linewidths=0.9)
        axes.annotate(f"line: $r_u$ = {LIQUEFIED_RU}", (0.99, 1.01), xycoords="axes fraction", ha="right", va="bottom",
                      fontsize=9, color=RED)
    bar = figure.colorbar(shade, ax=axes, aspect=25, pad=0.015, extend="min" if np.nanmin(ru) < -0.01 else "neither")
    bar.set_label("Pore pressure ratio $r_u$")
    letters([top, axes])
    return figure


# --- output depths ---------------------------------------------------------------------------------------------------


def moving_shears(column):
    """Directions of the shear that some output depth feels, next to the strongest, and to what vertical stress
    changes by."""
    vertical = [f"{prefix}_sigma_v" for _, prefix in column.points]
    pressed = max((np.ptp(column[name]) for name in vertical if column.has(name)), default=0.0)
    largest = {axis: max((column.peak(f"{prefix}_tau_{axis}z") for _, prefix in column.points), default=0.0)
               for axis in "xy"}
    return [axis for axis in "xy" if largest[axis] > max(MIN_SHARE * max(largest.values()), NOISE * pressed)]


def coloured_path(axes, x, y, time, norm):
    points = np.column_stack([x, y])[:, None, :]
    lines = LineCollection(np.concatenate([points[:-1], points[1:]], axis=1), cmap=TIMES, norm=norm, linewidths=0.8,
                           capstyle="round")
    lines.set_array(0.5 * (time[1:] + time[:-1]))
    axes.add_collection(lines)
    axes.plot(x[0], y[0], "o", color=BLACK, markersize=3, zorder=5)
    axes.autoscale_view()


def path_stress(column):
    """The stress of the paths: p' where the run has it, else sigma'_v; none if it does not change."""
    for name, label in (("p", r"$p^\prime$"), ("sigma_v", r"$\sigma_v^\prime$")):
        values = [column[f"{prefix}_{name}"] for _, prefix in column.points if column.has(f"{prefix}_{name}")]
        if values:
            moves = any(np.ptp(of_depth) > MIN_CHANGE * np.abs(of_depth).max() for of_depth in values)
            return (name, label) if moves else (None, None)
    return None, None


def point_label(depth, prefix):
    return f"{depth:.3g} m" if depth is not None else prefix


def paged(points, draw):
    """A figure, or pages of one, for at most MOST_DEPTHS of the points each."""
    pages = [draw(points[k:k + MOST_DEPTHS]) for k in range(0, len(points), MOST_DEPTHS)]
    return pages if len(pages) > 1 else pages[0]


@draws("fig_loops")
def loops(column):
    """Shear loops and, where the effective stress changes, stress paths at the output depths, coloured by time; dot:
    start."""
    axes_moving = moving_shears(column) if column.shaken else []
    if not axes_moving or not column.points:
        return None
    return paged(column.points, lambda points: draw_loops(column, points, axes_moving))


def draw_loops(column, points, axes_moving):
    stress, stress_label = path_stress(column)
    specs = [("gamma", axis) for axis in axes_moving] + [("path", axis) for axis in axes_moving if stress]
    n, m = len(points), len(specs)
    figure, panels = plt.subplots(n, m, figsize=(7.2 if m <= 2 else 2.7 * m, 1.8 * n + 0.9), squeeze=False,
                                  layout="constrained")
    norm = time_norm(column)
    for row, (depth, prefix) in zip(panels, points):
        for axes, (kind, axis) in zip(row, specs):
            name = f"{prefix}_gamma_{axis}z" if kind == "gamma" else f"{prefix}_{stress}"
            if not (column.has(name) and column.has(f"{prefix}_tau_{axis}z")):
                note(f"no column `{name}`; its curve is left out")
                continue
            factor = 100 if kind == "gamma" else 1e-3
            coloured_path(axes, factor * column[name], column[f"{prefix}_tau_{axis}z"] / 1e3, column.time, norm)
            axes.axhline(0, color=BLACK, linewidth=0.6, zorder=1.4)
            axes.set_ylabel(rf"$\tau_{{{axis}z}}$ (kPa)")
            axes.xaxis.set_major_locator(MaxNLocator(4))
            if kind == "path":
                axes.set_xlim(left=min(0.0, axes.get_xlim()[0]))
        row[0].set_title(f"depth {point_label(depth, prefix)}", loc="left", fontsize=9.5, fontweight="bold", pad=4)
    for axes, (kind, axis) in zip(panels[-1], specs):
        axes.set_xlabel(rf"Shear strain $\gamma_{{{axis}z}}$ (%)" if kind == "gamma"
                        else f"{'Mean' if stress == 'p' else 'Vertical'} effective stress {stress_label} (kPa)")
    time_bar(figure, panels, norm, column.time[-1], aspect=20 * n)
    return figure


def is_wet(column):
    """Whether there is a pore pressure ratio to be drawn."""
    return column.peak("max_ru") > MIN_RU or any(column.peak(f"{p}_ru") > MIN_RU for _, p in column.points)


def sinks(column):
    """Whether there is a settlement to be drawn."""
    return column.peak("settlement") > 1e-6


@draws("fig_histories", {"wet": "r_u at the output depths and its largest value anywhere; dashed, red: r_u = 1",
                         "sinking": "settlement of the surface"})
def histories(column):
    wet, sinking = is_wet(column), sinks(column)
    if not column.shaken or not (wet or sinking):
        return None
    return paged(column.points or [(None, "")], lambda points: draw_histories(column, points, wet, sinking))


def draw_histories(column, points, wet, sinking):
    figure, panels = plt.subplots(wet + sinking, 1, figsize=(7.2, 2.5 * (wet + sinking) + 0.5), sharex=True,
                                  squeeze=False, layout="constrained")
    panels = list(panels[:, 0])
    letters(panels if len(panels) > 1 else [])
    if wet:
        draw_ru(column, panels[0], points)
    if sinking:
        panels[-1].plot(column.time, 1e3 * column["settlement"], color=BLACK)
        panels[-1].invert_yaxis()
        panels[-1].set_ylabel("Settlement (mm)")
    panels[-1].set(xlim=(column.time[0], column.time[-1]), xlabel="Time (s)")
    return figure


def draw_ru(column, axes, points):
    if column.has("max_ru"):
        axes.plot(column.time, column["max_ru"], color=BLACK, linewidth=0.9, linestyle=(0, (3, 1.5)),
                  zorder=3, label="anywhere")
    shades = plt.get_cmap("plasma")(np.linspace(0.0, 0.85, len(points)))
    for (depth, prefix), shade in zip(points, shades):
        if column.has(f"{prefix}_ru"):
            axes.plot(column.time, column[f"{prefix}_ru"], color=shade, label=point_label(depth, prefix))
    axes.axhline(1, color=RED, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
    axes.set(ylim=(min(0, axes.get_ylim()[0]), None), ylabel="Pore pressure ratio $r_u$")
    axes.legend(loc="upper left", bbox_to_anchor=(1.005, 1.0), borderaxespad=0)

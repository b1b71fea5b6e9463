# SPDX-License-Identifier: BSD-3-Clause
"""Figures of the motion of a soil column: accelerations, response spectra, transfer function."""
import numpy as np

from .column_analysis import exact_transfer, is_cut_off, response_spectrum, smoothed_transfer, transfer_function
from .column_soil import MOST_DEPTHS
from .common import BLACK, BLUE, GREY, ORANGE, letters, note, plt
from .drawing import draws
from .site_response import input_name, spectrum, transfer

LEGEND_COLUMNS, LEGEND_ROW = 4, 0.18  # of the spectra; inches
PERIODS = np.geomspace(0.02, 5, 160)
COLOURS = {"x": BLUE, "y": ORANGE, "z": GREY}
ROOM = 1.75  # limits of a panel over its peak: room for the peak's label between curve and axis


def peak_text(drawn, of_all_steps):
    """The largest value that is drawn and, if the steps between went higher, that of all steps."""
    text = f"{drawn:.3g} m/s$^2$"
    higher = of_all_steps is not None and f"{of_all_steps:.3g}" != f"{drawn:.3g}"
    return text + f" ({of_all_steps:.3g} in all steps)" if higher else text


def peak_mark(axes, t, a, colour, of_all_steps=None):
    """The largest value, marked and written, away from the curve."""
    at = int(np.argmax(np.abs(a)))
    axes.plot(t[at], a[at], "o", color=colour, markersize=3.5, zorder=5)
    side, up = (1 if t[at] < t[0] + 0.5 * (t[-1] - t[0]) else -1), (1 if a[at] > 0 else -1)
    axes.annotate(peak_text(abs(a[at]), of_all_steps), (t[at], a[at]), xytext=(5 * side, 2.5 * up), zorder=6,
                  textcoords="offset points", ha="left" if side > 0 else "right", va="bottom" if up > 0 else "top",
                  fontsize=9, color=colour, bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.8})


@draws("fig_motions")
def motions(column):
    """Acceleration of input and surface, for each direction that moves, on one scale. The input is the outcrop motion
    of the rock or, above a rigid base, the motion within; dots: largest values."""
    if column.consolidation or not column.moving:
        return None
    rows = len(column.moving)
    figure, panels = plt.subplots(2 * rows, 1, figsize=(7.2, 3.2 * rows + 0.5), sharex=True, squeeze=False,
                                  layout="constrained")
    letters(panels)
    for row, axis in enumerate(column.moving):
        pair = panels[2 * row:2 * row + 2, 0]
        curves = ((f"input_a{axis}", f"{input_name(column)} (input)", BLACK), (f"surface_a{axis}", "surface", BLUE))
        limit = ROOM * max(column.peak(name) for name, _, _ in curves)
        for axes, (name, label, colour) in zip(pair, curves):
            if not column.has(name):
                note(f"no column `{name}`; its curve is left out")
                continue
            axes.plot(column.time, column[name], color=colour, linewidth=0.8)
            peak_mark(axes, column.time, column[name], colour, column.peaks.get(name))
            axes.set(ylim=(-limit, limit), ylabel=f"$a_{axis}$ (m/s$^2$)")
            axes.set_title(label, loc="right", fontsize=9, color=colour, pad=5)
    panels[-1, 0].set(xlim=(column.time[0], column.time[-1]), xlabel="Time (s)")
    return figure


def column_spectrum(column, where, axis):
    """Periods and SA: of every step of the run if it left them, else of the rows, which are fewer and filtered."""
    if f"{where}_{axis}_SA" in column.spectra:
        return column.spectra["period"], column.spectra[f"{where}_{axis}_SA"]
    a, dt = column.motion(f"{where}_a{axis}")
    return PERIODS, response_spectrum(a, dt, PERIODS, column.spectrum_damping)


@draws("fig_spectra")
def spectra(column):
    """Response spectra (absolute acceleration SA; spectra.csv has the pseudo-acceleration PSA, too) of input and
    surface from every step and, thin, at the output depths from the rows of the history, and the ratio of surface and
    input (dashed: 1); grey: periods that belong to frequencies above analysis.highest_frequency, or to what
    depends on the mesh (--check-mesh)."""
    axes_moving = [axis for axis in column.moving if column.has(f"surface_a{axis}")]
    if column.consolidation or not axes_moving:
        return None
    if not column.spectra:
        note("no spectra.csv; response spectra are those of the rows of the history")
    figure, panels = plt.subplots(2, len(axes_moving), figsize=(3.6 * max(len(axes_moving), 1.5), 5.2), sharex=True,
                                  sharey="row", height_ratios=(1.5, 1), squeeze=False, layout="constrained")
    for k, axis in enumerate(axes_moving):
        top, bottom = panels[:, k]
        of = {}
        for where, label, colour in (("input", f"{input_name(column)} (input)", BLACK), ("surface", "surface", BLUE)):
            periods, of[where] = column_spectrum(column, where, axis)
            top.plot(periods, of[where], color=colour, label=label)
        draw_depths(column, top, axis)
        bottom.plot(periods, of["surface"] / of["input"], color=BLACK)
        bottom.axhline(1, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
        top.set_title(f"along ${axis}$", loc="right", fontsize=9, pad=5)
    letters(panels)
    finish_spectra(panels, column.spectrum_damping, min(column.damping["viscous_above"], column.mesh_frequency))
    return figure


def draw_depths(column, axes, axis):
    """Of some of the output depths, from the first period on that the rows of the history show."""
    known = [k for k, depth in enumerate(column.motion_depths) if depth is not None]
    known = [known[k] for k in np.unique(np.linspace(0, len(known) - 1, min(len(known), MOST_DEPTHS)).astype(int))]
    for k, shade in zip(known, plt.get_cmap("plasma")(np.linspace(0.0, 0.85, max(1, len(known))))):
        depth = column.motion_depths[k]
        periods, absolute, _ = spectrum(column, depth, axis, PERIODS[PERIODS >= 4 * column.motion(f"input_a{axis}")[1]])
        axes.plot(periods, absolute, color=shade, linewidth=0.7, label=f"{depth:.3g} m")


def finish_spectra(panels, damping, highest_frequency):
    """Grey: periods of what is above the highest frequency of interest, or depends on the mesh."""
    for axes in panels.flat:
        axes.axvspan(PERIODS[0], max(PERIODS[0], 1 / highest_frequency), color="#eeeeee", zorder=0)
        axes.set(xscale="log", xlim=(PERIODS[0], PERIODS[-1]), ylim=(0, None))
        axes.grid(True, which="minor", axis="x", color="#f2f2f2", linewidth=0.4)
    for axes in panels[-1]:
        ticks = [0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5]
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.set_xticks([], minor=True)
        axes.set_xlabel("Period $T$ (s)")
    panels[0, 0].set_ylabel(f"Absolute acceleration SA (m/s$^2$)\n{100 * damping:g} % damping")
    panels[1, 0].set_ylabel("Surface / input")
    figure, (handles, labels) = panels[0, 0].figure, panels[0, 0].get_legend_handles_labels()
    below = (LEGEND_ROW * -(-len(labels) // LEGEND_COLUMNS) + 0.1) / figure.get_figheight()
    figure.legend(handles, labels, loc="lower center", ncols=LEGEND_COLUMNS)
    figure.get_layout_engine().set(rect=(0, below, 1, 1 - below))


# --- transfer function -----------------------------------------------------------------------------------------------


def highest_frequency(column, dt):
    """To the fourth mode of the column by its travel time, at most 25 Hz and what the rows can show. The velocity of a
    layer of grains is not in the scene."""
    known = column.layers and all(layer["velocity"] for layer in column.layers)
    target = 2 / sum(layer["height"] / layer["velocity"] for layer in column.layers) if known else 20
    return min(max(5.0, target), 25.0, 0.4 / dt)


def report_difference(f, ratio, exact, strong, axis, column):
    """Largest difference, of the exact curve's own value and of its peak, where the input says anything."""
    if not strong.any():
        return
    relative = np.where(strong, np.abs(ratio / exact - 1), 0)
    at = int(np.argmax(relative))
    print(f"transfer function along {axis}: largest difference from the exact curve {relative[at]:.2e} of its value at "
          f"{f[at]:.2f} Hz, {np.where(strong, abs(ratio - exact), 0).max() / exact[strong].max():.2e} of its peak, "
          f"{f[strong][0]:.2f} to {f[strong][-1]:.2f} Hz")
    surface = column[f"surface_a{axis}"]
    tail = np.abs(surface[-max(1, len(surface) // 50):]).max() / np.abs(surface).max()
    if tail > 1e-2:
        note(f"the surface still moves with {100 * tail:.2g} % of its peak when the run ends; a longer one sharpens "
             "the transfer function")


def draw_transfer(column, axes, axis):
    surface, dt = column.motion(f"surface_a{axis}")
    base, _ = column.motion(f"input_a{axis}")
    f_max = highest_frequency(column, dt)
    layer = column.uniform_elastic()
    f, ratio, strong = transfer_function(surface, base, dt, f_max)
    if strong.any():
        f_max = min(f_max, 1.05 * f[strong][-1])
    shown, centres = np.where(strong, ratio, np.nan), np.geomspace(max(0.1, 4 * f[0]), f_max, 600)
    if layer:
        fine = np.linspace(f_max / 4000, f_max, 4000)
        axes.plot(f, shown, color=COLOURS[axis], linewidth=2.2, alpha=0.75, label="computed")
        axes.plot(fine, exact_transfer(fine, layer, column.base, **column.damping), color=BLACK, linewidth=0.9,
                  linestyle=(0, (4, 2)), label="exact, elastic layer")
        report_difference(f, ratio, exact_transfer(f, layer, column.base, **column.damping), strong, axis, column)
        top = 1.12 * np.nanmax(shown)
    else:
        smooth = smoothed_transfer(surface, base, dt, centres)
        axes.plot(f, shown, color=GREY, linewidth=0.6, alpha=0.7, label="every frequency")
        axes.plot(centres, smooth, color=COLOURS[axis], linewidth=1.5, label="smoothed")
        top = 1.35 * np.nanmax(smooth)
    if column.base and column.has(f"base_a{axis}"):
        axes.plot(centres, transfer(column, axis, "within", centres)[1], color=BLACK, linewidth=0.7,
                  label="over the motion within")
    axes.axhline(1, color=GREY, linewidth=0.8, linestyle=(0, (4, 3)), zorder=1.5)
    axes.set(xlim=(0, f_max), ylim=(0, top))
    axes.legend(loc="lower right", bbox_to_anchor=(0.85, 1.0), ncols=3, borderaxespad=0.2)


def broad(column, axis):
    """Whether the input holds two octaves at least; from a sine alone nothing can be seen."""
    surface, dt = column.motion(f"surface_a{axis}")
    f, _, strong = transfer_function(surface, column.motion(f"input_a{axis}")[0], dt, highest_frequency(column, dt))
    return strong.any() and f[strong][-1] > 4 * f[strong][0]


@draws("fig_transfer", {"one elastic layer": "next to its exact curve, from which the largest difference is printed",
                        "other soil": "smoothed, too (Konno and Ohmachi 1998, b = 80)"})
def transfer_functions(column):
    """Fourier amplitudes, surface over input (dashed: 1), which is the outcrop motion of the rock or, above a rigid
    base, the motion within; above rock also surface over the motion within, at the base."""
    if column.consolidation or len(column.time) < 8:
        return None
    cut_off = [axis for axis in column.horizontal if is_cut_off(column[f"input_a{axis}"])]
    if cut_off:
        note(f"fig_transfer: the run ends while the input along {', '.join(cut_off)} still moves; not drawn")
    axes_moving = [axis for axis in column.horizontal
                   if axis not in cut_off and column.has(f"surface_a{axis}") and broad(column, axis)]
    if not axes_moving:
        return None
    n = len(axes_moving)
    figure, panels = plt.subplots(n, 1, figsize=(7.2, 2.8 * n + 0.4), sharex=True, squeeze=False,
                                  layout="constrained")
    letters(panels if n > 1 else [])
    for axes, axis in zip(panels[:, 0], axes_moving):
        draw_transfer(column, axes, axis)
        axes.set_ylabel(f"|surface / {input_name(column)}|")
        if n > 1:
            axes.set_title(f"along ${axis}$", loc="right", fontsize=9, pad=5)
    panels[-1, 0].set_xlabel("Frequency (Hz)")
    return figure

# SPDX-License-Identifier: BSD-3-Clause
"""Figures of a box of soil: maps over the mesh as it has moved, and the motion of its surface.

tested: tests/apps/box_test.py, tests/studies/canyon_test.py
"""
from collections import Counter

import numpy as np
from matplotlib.collections import PolyCollection

from .column_analysis import fourier, is_cut_off
from .common import BLACK, BLUE, GREY, NOISE, ORANGE, cut_ends, letters, note, plt
from .drawing import draws

LARGEST_SHARE = 0.15  # of the depth, that displacements are drawn with


def is_box(column):
    return bool(column.maps)


class Mesh:
    """Elements of a box with their points, at the instants of its maps."""

    def __init__(self, maps):
        self.maps = maps
        self.corners = np.stack([maps["corner_x"], maps["corner_z"]], axis=-1).reshape(-1, 4, 2)
        self.points_per_cell = len(maps["x"]) // len(self.corners)
        moved = np.hypot(maps["displacement_x"], maps["displacement_z"]).max()
        depth = self.corners[..., 1].max()
        self.exaggeration = 1.0
        for factor in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000):
            if factor * moved < LARGEST_SHARE * depth:
                self.exaggeration = factor

    def moved(self, row):
        shift = np.stack([self.maps[f"displacement_{axis}"][row] for axis in "xz"], axis=-1).reshape(-1, 4, 2)
        return self.corners + self.exaggeration * shift

    def means(self, values):
        return values.reshape(-1, self.points_per_cell).mean(axis=1)

    def show(self, axes, row, values, low, high, colours):
        elements = PolyCollection(self.moved(row), array=self.means(values), cmap=colours, edgecolor="white",
                                  linewidth=0.15)
        elements.set_clim(low, high)
        axes.add_collection(elements)
        outline = np.concatenate([self.corners.reshape(-1, 2), self.moved(row).reshape(-1, 2)])
        bottom, top = outline.min(axis=0), outline.max(axis=0)
        axes.plot([0, self.corners[..., 0].max()], [0, 0], color=GREY, linewidth=0.6)
        margin = 0.02 * (top - bottom)
        axes.set(xlim=(bottom[0] - margin[0], top[0] + margin[0]), ylim=(bottom[1] - margin[1], top[1] + margin[1]),
                 aspect="equal")
        axes.grid(False)
        axes.set_ylabel("z (m)")
        return elements

    def surface(self):
        """Corners at the surface from left to right: (place in the table of corners, their x)."""
        flat = self.corners.reshape(-1, 2).round(6)
        corners = np.arange(len(flat)).reshape(-1, 4)
        sides = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 2)  # anticlockwise
        ends = [frozenset(map(tuple, flat[side])) for side in sides]
        once = Counter(ends)
        top = {float(flat[index, 0]): index for side, pair in zip(sides, ends)  # has soil on its left, seen leftwards
               if once[pair] == 1 and flat[side[1], 0] < flat[side[0], 0] - 1e-6 for index in side}
        return np.array([top[x] for x in sorted(top)]), np.array(sorted(top))


@draws("fig_box")
def box_maps(column):
    """r_u where its mean is largest and at the end, shear strain at the end, of packings I_R where its mean is
    smallest (white: no grains), over the mesh as it has moved; grey: the base at the start."""
    if not is_box(column) or column.plate:
        return None
    maps, mesh = column.maps, Mesh(column.maps)
    gamma = 100 * np.hypot(maps["gamma_xz"], maps["gamma_yz"])
    fields = [("gamma", len(gamma) - 1, gamma[-1], 0, max(float(np.quantile(gamma[-1], 0.995)), 1e-6), "magma_r",
               r"$|\gamma|$ (%)")]
    if np.abs(maps["u"]).max() > 0:
        mean = maps["ru"].mean(axis=1)
        worst = int(np.argmax(mean))
        fields = [("ru", worst, maps["ru"][worst], 0, 1, "viridis", r"$r_u$"),
                  ("ru", len(mean) - 1, maps["ru"][-1], 0, 1, "viridis", r"$r_u$")] + fields
    if "redundancy" in maps:
        mean = np.nanmean(maps["redundancy"], axis=1)
        worst = int(np.argmin(mean))
        fields.append(("redundancy", worst, maps["redundancy"][worst], 0, 2, "RdBu", r"$I_R$"))
    across, up = np.ptp(mesh.corners.reshape(-1, 2), axis=0)
    height = np.clip(6 * up / across + 0.6, 1.6, max(2.2, 6.6 / len(fields)))
    figure, panels = plt.subplots(len(fields), 1, figsize=(7.2, height * len(fields)), layout="constrained",
                                  squeeze=False)
    letters(panels)
    for (_, row, values, low, high, colours, label), axes in zip(fields, panels[:, 0]):
        elements = mesh.show(axes, row, values, low, high, colours)
        figure.colorbar(elements, ax=axes, label=label, fraction=0.03, pad=0.01,
                        extend=cut_ends(mesh.means(values), low, high))
        axes.annotate(f"t = {maps['time'][row]:.4g} s, displacements drawn {mesh.exaggeration:g} times", (1, 1), (0, 4),
                      "axes fraction", "offset points", ha="right", va="bottom", fontsize=8.5)
    panels[-1, 0].set_xlabel("x (m)")
    return figure


@draws("fig_surface")
def box_surface(column):
    """Displacement of the surface in time and over the box."""
    if not is_box(column) or column.plate:
        return None
    maps, mesh = column.maps, Mesh(column.maps)
    indices, x = mesh.surface()
    figure, panels = plt.subplots(2, 2, figsize=(7.2, 5.0), layout="constrained")
    rows = np.unique(np.linspace(0, len(maps["time"]) - 1, 6).astype(int))[1:]
    for column_of_panels, (axis, label) in enumerate((("x", "Along x (cm)"), ("z", "Upwards (cm)"))):
        moved = 100 * maps[f"displacement_{axis}"][:, indices]
        for share, colour in ((0.25, BLUE), (0.5, BLACK), (0.75, ORANGE)):
            k = int(np.argmin(np.abs(x - share * x[-1])))
            panels[0, column_of_panels].plot(maps["time"], moved[:, k], color=colour, label=f"x = {x[k]:.3g} m")
        for row, shade in zip(rows, np.linspace(0.75, 0, len(rows))):
            panels[1, column_of_panels].plot(x, moved[row], color=str(shade), label=f"{maps['time'][row]:.3g} s")
        panels[0, column_of_panels].set_ylabel(label)
        panels[1, column_of_panels].set_ylabel(label)
        panels[0, column_of_panels].set_xlabel("Time (s)")
        panels[1, column_of_panels].set_xlabel("x (m)")
    least = NOISE * max(np.abs(maps[f"displacement_{axis}"][:, indices]).max() for axis in "xz")
    for axes in panels.flat:
        if np.ptp(axes.get_ylim()) < 200 * least:  # of round-off alone, in cm
            axes.set_ylim(-100 * least, 100 * least)
    panels[0, 0].legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=3, fontsize=7, handlelength=1.2)
    panels[1, 1].legend(fontsize=7)
    letters(panels)
    return figure


def amplification(column, axis, f):
    """x of the corners of the surface, m, and Fourier amplitudes of their acceleration over the input's (f x corners)
    at frequencies f, Hz: second differences of the maps' displacement, corrected to those of a sine."""
    indices, x = Mesh(column.maps).surface()
    time, w = column.maps["time"], 2 * np.pi * np.asarray(f, dtype=float)[:, None]
    dt = (time[-1] - time[0]) / (len(time) - 1)
    bends = np.diff(column.maps[f"displacement_{axis}"][:, indices], 2, axis=0)
    moved = np.exp(-1j * w * time[1:-1]) @ bends * dt * (w / (2 * np.sin(w * dt / 2))) ** 2
    a, step = column.motion(f"input_a{axis}")
    put_in = step * np.exp(-1j * w * step * np.arange(len(a))) @ a[:, None]
    return x, np.abs(moved + (0 if column.base else put_in)) / np.abs(put_in)


@draws("fig_amplification")
def surface_amplification(column):
    """Fourier amplitude of the surface over that of the input, along a box with free fields, where the input's is
    largest and at half that frequency."""
    if not is_box(column) or not column.moving or column.scene["mesh"]["sides"] != "free-field":
        return None
    if any(is_cut_off(column[f"input_a{axis}"]) for axis in column.moving):
        note("fig_amplification: the run ends while the input still moves; not drawn")
        return None
    spectra = [fourier(*column.motion(f"input_a{axis}")) for axis in column.moving]
    largest = [frequencies[np.argmax(np.abs(amplitude))] for frequencies, amplitude in spectra]
    if np.diff(column.maps["time"]).max() > 1 / (8 * max(largest)):
        note(f"fig_amplification needs profiles every {1 / (8 * max(largest)):.2g} s (output.profile_interval)")
        return None
    figure, panels = plt.subplots(len(column.moving), 1, figsize=(7.2, 2.6 * len(column.moving)), squeeze=False,
                                  sharex=True, layout="constrained")
    for axes, axis, f_input in zip(panels[:, 0], column.moving, largest):
        x, ratios = amplification(column, axis, (f_input / 2, f_input))
        for f, ratio, colour in zip((f_input / 2, f_input), ratios, (BLACK, BLUE)):
            axes.plot(x, ratio, color=colour, label=f"{f:.3g} Hz")
        axes.set(ylim=(0, 1.2 * ratios.max()), ylabel=f"Amplification along {axis}")
        axes.legend(loc="upper right", ncols=2)
    panels[-1, 0].set_xlabel("x (m)")
    return figure

# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of a run of biaxial from its history.csv, maps.h5 and summary.json.

    python3 -m figures biaxial RESULTS [--beside OTHER ...]

Of fig_rate_maps the last map is asked for the inclination of a band: the direction of the smallest spread of the points
with the largest shear strain, printed with their number; of fig_band.png its thickness and inclination in the middle
half of the block's width. Compression is positive.
"""
import h5py
import numpy as np

from .common import BLACK, BLUE, GREEN, ORANGE, BadInput, cut_ends, plain, plt, read_history, read_summary
from .drawing import Drawing, draws

PANELS = 5


class Block:
    def __init__(self, folder):
        self.history = read_history(folder / "history.csv")
        self.summary = read_summary(folder / "summary.json")
        self.name = folder.resolve().name
        self.title = self.summary.get("title") or self.name
        with h5py.File(folder / "maps.h5") as file:
            self.maps = {name: np.asarray(values) for name, values in file.items()}
        self.strain = self.maps["axial_strain"]
        if len(self.strain) < 2:
            raise BadInput(f"{folder}: only the start of a run")
        self.size = [self.summary.get(key, float(self.maps[axis].max())) for key, axis in
                     (("width_m", "x"), ("height_m", "z"))]
        self.counts = [int(self.summary.get(key, 1)) for key in ("cells_across", "cells_up")]
        self.beside = []

    def chosen(self):
        """Maps to show: the last one, and others at equal distances in axial strain."""
        targets = np.linspace(0, self.strain[-1], PANELS + 1)[1:]
        return sorted({int(np.argmin(np.abs(self.strain - s))) for s in targets} - {0})

    def cells(self, values):
        """Means over the elements."""
        column, row = (np.minimum((self.maps[axis] / size * n).astype(int), n - 1) for axis, size, n in
                       zip("xz", self.size, self.counts))
        number = row * self.counts[0] + column
        return np.bincount(number, values) / np.bincount(number)

    def show(self, axes, values, low, high, label):
        """Points as the squares around them: sorted by place they are a table."""
        x, z = (np.unique(np.round(self.maps[axis], 9)) for axis in "xz")
        order = np.lexsort((np.round(self.maps["x"], 9), np.round(self.maps["z"], 9)))
        table = values[order].reshape(len(z), len(x))
        edges = [np.concatenate(([0], (p[1:] + p[:-1]) / 2, [size])) for p, size in zip((x, z), self.size)]
        image = axes.pcolormesh(*edges, table, vmin=low, vmax=high, cmap="viridis")
        axes.set_aspect("equal")
        axes.grid(False)
        axes.set_title(label, fontsize=8.5)
        axes.set_xticks([0, self.size[0]])
        axes.set_yticks([0, self.size[1]])
        return image


@draws("fig_stress_strain")
def stress_strain(block):
    """Axial stress and volumetric strain (undrained: pore pressure) against axial strain, and the scatter of the shear
    strain."""
    figure, axes = plt.subplots(1, 3, figsize=(9.6, 3.0), constrained_layout=True)
    strain = 100 * block.history["axial_strain"]
    axes[0].plot(strain, block.history["axial_stress"] / 1e3, color=BLACK)
    axes[0].set(ylabel=r"Axial stress $\sigma_z$ (kPa)", ylim=(0, None))
    if "pore_pressure" in block.history:
        axes[1].plot(strain, block.history["pore_pressure"] / 1e3, color=BLUE)
        axes[1].set_ylabel(r"Excess pore pressure $\Delta u$ (kPa)")
    else:
        axes[1].plot(strain, 100 * block.history["volumetric_strain"], color=BLUE)
        axes[1].set_ylabel("Volumetric strain (%)")
    for name, label, color in (("shear_mean", "mean", BLACK), ("shear_quantile", "90 % quantile", BLUE),
                               ("shear_max", "largest", ORANGE)):
        axes[2].plot(strain, 100 * block.history[name], color=color, label=label)
    axes[2].set_ylabel("Shear strain of points (%)")
    axes[2].legend()
    for panel in axes:
        panel.set(xlabel=r"Axial strain $\varepsilon_z$ (%)", xlim=(0, None))
    return figure


def map_row(block, fields, labels, bar):
    figure, axes = plt.subplots(1, len(fields), figsize=(1.7 * len(fields) + 1, 3.6), constrained_layout=True,
                                squeeze=False)
    high = max(np.quantile(field, 0.99) for field in fields)
    for panel, field, label in zip(axes[0], fields, labels):
        image = block.show(panel, field, 0, high, label)
        panel.set_xlabel("$x$ (m)")
    axes[0][0].set_ylabel("$z$ (m)")
    figure.colorbar(image, ax=axes, label=bar, shrink=0.8, extend=cut_ends(fields, 0, high))
    return figure


@draws("fig_shear_maps")
def shear_maps(block):
    """Shear strain since the start over the block at several axial strains."""
    chosen = block.chosen()
    return map_row(block, [100 * block.maps["shear_strain"][k] for k in chosen],
                   [f"{100 * block.strain[k]:.2g} %" for k in chosen], "Shear strain (%)")


def differences(block):
    """Shear strain that came between shown maps over that of a uniform block."""
    chosen = [0, *block.chosen()]
    for before, now in zip(chosen, chosen[1:]):
        came = block.maps["shear_strain"][now] - block.maps["shear_strain"][before]
        yield before, now, came / came.mean()


@draws("fig_rate_maps")
def rate_maps(block):
    """Shear strain between two of them: where the block deforms at the time."""
    rows = list(differences(block))
    report_band(block, rows[-1][2])
    return map_row(block, [field for _, _, field in rows],
                   [f"{100 * block.strain[a]:.2g}-{100 * block.strain[b]:.2g} %" for a, b, _ in rows],
                   "Shear strain meanwhile / mean")


def report_band(block, field):
    """Inclination to the horizontal of the line through the fifth of the points that shears most."""
    most = field >= np.quantile(field, 0.8)
    place = np.stack([block.maps["x"][most], block.maps["z"][most]])
    values, vectors = np.linalg.eigh(np.cov(place))
    angle = np.degrees(np.arctan2(abs(vectors[1, 1]), abs(vectors[0, 1])))
    side = "rising" if vectors[0, 1] * vectors[1, 1] > 0 else "falling"
    print(f"the fifth of points that shears most has {field[most].sum() / field.sum():.2f} of the shear strain; it "
          f"lies along {angle:.0f} deg to the horizontal, {side}; spread across over along "
          f"{np.sqrt(max(values[0], 0) / values[1]):.2f}")


def band_shape(block, field):
    """Thickness (m) and inclination (deg) of a band: the width of its profile, the mean along it by the distance across
    it, that is above half of its largest value. From the points in the middle half of the block's width; its direction
    is the regression of z on x of those with more than 0.6 of what the uppermost fiftieth has. nan: the profile does
    not fall to half on both sides."""
    middle = np.abs(block.maps["x"] / block.size[0] - 0.5) < 0.25
    place, field = np.stack([block.maps["x"], block.maps["z"]])[:, middle], field[middle]
    weight = np.where(field > 0.6 * np.quantile(field, 0.98), field, 0)
    place = place - (place * weight).sum(axis=1, keepdims=True) / weight.sum()
    slope = (weight * place[0] * place[1]).sum() / (weight * place[0] ** 2).sum()
    along = np.array([1, slope]) / np.hypot(1, slope)
    across = np.array([-along[1], along[0]])
    edges = np.linspace(-0.5, 0.5, 51) * block.size[0]
    bins = np.digitize(across @ place, edges) - 1
    inside = (bins >= 0) & (bins < 50) & (np.abs(along @ place) < 0.2 * block.size[0])
    count = np.bincount(bins[inside], minlength=50)
    centre = ((edges[1:] + edges[:-1]) / 2)[count > 0]
    profile = np.bincount(bins[inside], field[inside], 50)[count > 0] / count[count > 0]
    high = np.flatnonzero(profile > profile.max() / 2)
    angle = np.degrees(np.arctan(abs(slope)))
    if high[0] == 0 or high[-1] == len(profile) - 1:
        return np.nan, angle
    ends = [np.interp(profile.max() / 2, *np.array(sorted([(profile[k], centre[k]), (profile[j], centre[j])])).T)
            for k, j in ((high[0] - 1, high[0]), (high[-1] + 1, high[-1]))]
    return ends[1] - ends[0], angle


def band_words(block, field):
    thickness, angle = band_shape(block, field)
    if np.isnan(thickness):
        return "in the middle half of the width it nowhere falls to half on both sides of a line: no band"
    return (f"band in the middle half of the width: {thickness:.3f} m thick at half of it, {angle:.0f} deg to the "
            "horizontal")


@draws("fig_band")
def band(block):
    """Axial stress next to that of other runs (named by their folders), shear strain at the end, where it came last,
    void ratio."""
    # all of a band; shear strains over their mean
    before, _, came = list(differences(block))[-1]
    total = block.maps["shear_strain"][-1] / block.maps["shear_strain"][-1].mean()
    for when, field in ("the start", total), (f"{100 * block.strain[before]:.2g} %", came):
        elements = block.cells(field)
        print(f"shear strain since {when} over its mean: points up to {field.max():.2f}, elements {elements.min():.2f} "
              f"to {elements.max():.2f}; {band_words(block, field)}")
    whose = f"{plain(block.name)}: " if block.beside else ""
    maps = [(total, 0, "Shear strain / mean", whose + "since the start"),
            (came, 0, "Shear strain / mean", f"since {100 * block.strain[before]:.2g} %")]
    if block.maps["redundancy"].any():
        void = block.maps["void_ratio"][-1]
        maps.append((void, void.min(), "Void ratio $e$", "at the end"))
    figure, axes = plt.subplots(1, 1 + len(maps), figsize=(3.2 + 2.1 * len(maps), 3.5), constrained_layout=True,
                                gridspec_kw={"width_ratios": [1.7] + [1] * len(maps)})
    for run, color in zip([block, *block.beside], (BLACK, ORANGE, BLUE, GREEN)):
        axes[0].plot(100 * run.history["axial_strain"], run.history["axial_stress"] / 1e3, color=color,
                     label=plain(run.name))
    axes[0].set(xlabel=r"Axial strain $\varepsilon_z$ (%)", ylabel=r"Axial stress $\sigma_z$ (kPa)", xlim=(0, None),
                ylim=(0, None))
    if block.beside:
        axes[0].legend(loc="lower right")
    for panel, (field, low, bar, label) in zip(axes[1:], maps):
        high = np.quantile(field, 0.99)
        image = block.show(panel, field, low, high, label)
        panel.set_xlabel("$x$ (m)")
        figure.colorbar(image, ax=panel, label=bar, shrink=0.8, extend=cut_ends(field, low, high))
    axes[1].set_ylabel("$z$ (m)")
    return figure


@draws("fig_grain_maps")
def grain_maps(block):
    """Void ratio and redundancy index at the end, of packings; white: no grains."""
    if not block.maps["redundancy"].any():
        return None
    figure, axes = plt.subplots(1, 2, figsize=(5.4, 3.6), constrained_layout=True)
    for panel, name, label in zip(axes, ("void_ratio", "redundancy"), ("Void ratio $e$", "Redundancy index $I_R$")):
        field = np.where(block.maps["void_ratio"][-1] > 0, block.maps[name][-1], np.nan)
        ends = np.nanquantile(field, [0.01, 0.99])
        image = block.show(panel, field, *ends, f"{100 * block.strain[-1]:.2g} %")
        panel.set_xlabel("$x$ (m)")
        figure.colorbar(image, ax=panel, label=label, shrink=0.8, extend=cut_ends(field, *ends))
    axes[0].set_ylabel("$z$ (m)")
    return figure


DRAWING = Drawing(Block, [stress_strain, shear_maps, rate_maps, band, grain_maps])

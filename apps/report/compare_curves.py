# SPDX-License-Identifier: BSD-3-Clause
"""The main curves of two runs over each other: what is drawn for each program."""
import dataclasses
import typing

import numpy as np

from figures import biaxial, element_test, soil_column
from figures.common import BLACK, GREY, letters, mark_level, plt
from figures.drawing import Drawing

# The second run lies on the first one, which shows on both sides of it: curves that are equal are seen to be two.
LINES = ({"color": "#56b4e9", "linewidth": 3.0, "zorder": 2}, {"color": BLACK, "linewidth": 0.8, "zorder": 2.1})
WORDS = ("wide light blue", "thin black")
LEGEND = 0.28  # height of the legend above the panels, inches


@dataclasses.dataclass
class Curves:
    """drawing: reads the results   kind(results): a word for what can be compared with what
    figures: {name: (title, caption(pair of results), draw(pair of results, their names) -> figure or None)}
    numbers(results): {quantity (unit): number} of the curves, which the summaries do not have"""

    drawing: Drawing
    kind: typing.Callable
    figures: dict
    numbers: typing.Callable = lambda results: {}


def draw_pair(axes, pair, names, x, y):
    """y(run) against x(run) of both runs."""
    for run, name, line in zip(pair, names, LINES):
        axes.plot(x(run), y(run), label=name, **line)


def legend_of(figure, axes):
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles[:2], labels[:2], loc="upper right", ncols=2)
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - LEGEND / figure.get_figheight()))


def panels_of(rows, columns, width=7.6, height=3.0):
    figure, panels = plt.subplots(rows, columns, figsize=(width, 0.4 + height * rows), squeeze=False,
                                  layout="constrained")
    letters(panels if panels.size > 1 else [])
    return figure, panels


# --- element tests ---------------------------------------------------------------------------------------------------


def kind_of_test(run):
    """Triaxial or simple shear."""
    return "simple shear" if run.shear else "triaxial"


def stress_curves(pair, names):
    """Stress path; q (tau), p' and void ratio or redundancy index against strain, of cyclic tests against cycles."""
    shear = pair[0].shear
    load, load_label = ("tau_xy", r"Shear stress $\tau$ (kPa)") if shear else ("q", r"Deviatoric stress $q$ (kPa)")
    path, path_label = ("sigma_y", r"Vertical effective stress $\sigma_v^\prime$ (kPa)") if shear else (
        "p", r"Mean effective stress $p^\prime$ (kPa)")
    cyclic = all(run.cyclic for run in pair)
    progress = (lambda run: run.progress) if cyclic else (lambda run: 100 * run.strain)
    progress_label = pair[0].progress_label if cyclic else pair[0].strain_label
    figure, ((one, two), (three, four)) = panels_of(2, 2)
    draw_pair(one, pair, names, lambda run: run[path] / 1e3, lambda run: run[load] / 1e3)
    draw_pair(two, pair, names, lambda run: 100 * run.strain, lambda run: run[load] / 1e3)
    draw_pair(three, pair, names, progress, lambda run: run["p"] / 1e3)
    last, last_label = ("e", "Void ratio $e$") if any(run.drained for run in pair) else (
        "IR", "Redundancy index $I_R$")
    draw_pair(four, pair, names, progress, lambda run: run[last] if run.has(last) else np.full(run.n_rows, np.nan))
    one.set_xlim(0, 1.05 * max(np.nanmax(run[path]) for run in pair) / 1e3)
    three.set_ylim(0, 1.1 * max(np.nanmax(run["p"]) for run in pair) / 1e3)
    for axes, x, y in ((one, path_label, load_label), (two, pair[0].strain_label, load_label),
                       (three, progress_label, r"Mean effective stress $p^\prime$ (kPa)"),
                       (four, progress_label, last_label)):
        axes.set(xlabel=x, ylabel=y)
        axes.locator_params(axis="x", nbins=5)
    for axes in (one, two):
        axes.axhline(0, color=GREY, linewidth=0.6, zorder=1.4)
    if last == "IR":
        mark_level(four, 1.0, "isostatic\n$I_R = 1$")
    legend_of(figure, one)
    return figure


def caption_of_test(pair):
    """What stress_curves() draws of these two."""
    load, effective = ("tau", "sigma'_v") if pair[0].shear else ("q", "p'")
    strain = "gamma" if pair[0].shear else "axial strain"
    progress = "the number of cycles" if all(run.cyclic for run in pair) else strain
    last = "void ratio" if any(run.drained for run in pair) else "redundancy index"
    return f"(a) {load} against {effective}, (b) {load} against {strain}, (c) p' and (d) {last} against {progress}."


def numbers_of_test(run):
    """Peak and ends of the curves. q (tau) is signed; its peak is where its amount is largest. Which end of a cycle
    that is depends on an overshoot: of cyclic tests both are given."""
    name = "tau_xy" if run.shear else "q"
    load, strain, p = run[name] / 1e3, 100 * run.strain, run["p"] / 1e3
    peak = int(np.nanargmax(np.abs(load)))
    numbers = {f"peak {name} (kPa)": load[peak], f"strain at peak {name} (%)": strain[peak]}
    if run.cyclic:
        numbers = {f"largest {name} (kPa)": np.nanmax(load), f"smallest {name} (kPa)": np.nanmin(load),
                   "largest strain (%)": np.nanmax(strain), "smallest strain (%)": np.nanmin(strain)}
    numbers |= {"least p' (kPa)": p.min(), "p' at the end (kPa)": p[-1], f"{name} at the end (kPa)": load[-1]}
    if run.drained:
        numbers["void ratio at the end"] = run["e"][-1]
    if run.has("IR"):
        numbers["least redundancy index"] = np.nanmin(run["IR"])
    return {name: float(value) for name, value in numbers.items()}


# --- columns ---------------------------------------------------------------------------------------------------------


def kind_of_analysis(column):
    """Consolidation or shaking."""
    return "a consolidation" if column.consolidation else "shaken"


def surface_motion(pair, names):
    """Acceleration of the surface, for each direction that moves in one of the runs."""
    moving = [axis for axis in "xyz" if any(column.peak(f"surface_a{axis}") > 0 for column in pair)]
    if not moving or pair[0].consolidation:
        return None
    figure, panels = panels_of(len(moving), 1, height=2.2)
    for axes, axis in zip(panels[:, 0], moving):
        draw_pair(axes, pair, names, lambda run: run.time, lambda run, name=f"surface_a{axis}":  # noqa: B023
                  run[name] if run.has(name) else 0 * run.time)
        axes.set_ylabel(f"Surface $a_{axis}$ (m/s$^2$)")
    panels[-1, 0].set_xlabel("Time (s)")
    legend_of(figure, panels[0, 0])
    return figure


def there(pair):
    """Of largest r_u and settlement those that one of the runs has: column, factor, label, word."""
    specs = [("max_ru", 1, "Largest $r_u$", "Largest pore pressure ratio anywhere"),
             ("settlement", 1e3, "Settlement (mm)", "Settlement")]
    return [spec for spec in specs[int(pair[0].consolidation):] if any(run.peak(spec[0]) > 1e-6 for run in pair)]


def caption_of_water(pair):
    """What water_and_settlement() draws of these two."""
    words = ", ".join(spec[3] if k == 0 else spec[3].lower() for k, spec in enumerate(there(pair)))
    return f"{words} against time."


def water_and_settlement(pair, names):
    """Largest r_u anywhere, and settlement, against time."""
    specs = there(pair)
    if not specs:
        return None
    figure, panels = panels_of(len(specs), 1, height=2.2)
    for axes, (name, factor, label, _) in zip(panels[:, 0], specs):
        draw_pair(axes, pair, names, lambda run: run.time, lambda run, name=name, factor=factor:
                  factor * run[name] if run.has(name) else np.full(len(run.time), np.nan))
        axes.set_ylabel(label)
        if name == "settlement":
            axes.invert_yaxis()
        else:
            mark_level(axes, 1.0, "$r_u = 1$")
        if pair[0].consolidation:
            axes.set_xscale("log")
    panels[-1, 0].set_xlabel("Time (s)")
    legend_of(figure, panels[0, 0])
    return figure


# --- blocks ----------------------------------------------------------------------------------------------------------


def block_curves(pair, names):
    """Axial stress, volumetric strain and largest shear strain of a point, against axial strain."""
    figure, panels = panels_of(1, 3, width=9.6)
    for axes, (name, factor, label) in zip(panels[0], (("axial_stress", 1e-3, r"Axial stress $\sigma_z$ (kPa)"),
                                                       ("volumetric_strain", 100, "Volumetric strain (%)"),
                                                       ("shear_max", 100, "Largest shear strain (%)"))):
        draw_pair(axes, pair, names, lambda run: 100 * run.history["axial_strain"],
                  lambda run, name=name, factor=factor: factor * run.history[name])
        axes.set(xlabel=r"Axial strain $\varepsilon_z$ (%)", ylabel=label)
    legend_of(figure, panels[0, 0])
    return figure


OF_PROGRAM = {
    "element_test": Curves(element_test.DRAWING, kind_of_test, {
        "curves": ("Stress and strain", caption_of_test, stress_curves)}, numbers_of_test),
    "soil_column": Curves(soil_column.DRAWING, kind_of_analysis, {
        "surface": ("Surface motion", lambda pair: "Acceleration of the surface against time.", surface_motion),
        "water": ("Pore pressure and settlement", caption_of_water, water_and_settlement)}),
    "biaxial": Curves(biaxial.DRAWING, lambda block: "a block", {
        "curves": ("Stress and strain", lambda pair: "(a) axial stress, (b) volumetric strain, (c) largest shear "
                   "strain of a point, against axial strain.", block_curves)}),
}

# SPDX-License-Identifier: BSD-3-Clause
"""What damping does to the ringing of a column that liquefies, and to its signal.

The scene is apps/scenes/column/recorded_motion.toml.
"""
import numpy as np

from figures.column_analysis import response_spectrum
from figures.column_results import Column
from figures.common import BLUE, GREY, ORANGE, panel_letter, plt
from studies.columns import SCENES, Run
from studies.drawing import save
from studies.history import parsed
from studies.tables import write_tables

DEFAULTS, QUICK = {}, {}
FINE = {f"layer.{k}.cells": n for k, n in enumerate((8, 24, 28))}
PLAIN = {"analysis.highest_frequency": "0.001 Hz"}
CASES = {  # name: keys
    "none": {"analysis.viscosity": "0 ms"},
    "stiffness-proportional, 0.025 ms": {"analysis.viscosity": "0.025 ms", **PLAIN},
    "0.05 ms": {"analysis.viscosity": "0.05 ms", **PLAIN},
    "0.1 ms": {"analysis.viscosity": "0.1 ms", **PLAIN},
    "above 25 Hz, 0.05 ms": {"analysis.viscosity": "0.05 ms"},
    "the default, 0.1 ms": {},
    "0.2 ms": {"analysis.viscosity": "0.2 ms"},
    "the default, half the step": {"analysis.time_step": "0.3775 ms"},
    "none, elements half as high": {"analysis.viscosity": "0 ms", **FINE},
    "the default, elements half as high": FINE,
    "the default, rows of 10 ms": {},
}
PERIODS = np.array([0.023, 0.1, 0.3, 1.0])


def runs(_options):
    """Rows of the histories at every step, unless the case says otherwise."""
    return [Run((name,), SCENES / "column/recorded_motion.toml",
                tuple((keys if "rows" in name else {**keys, "output.history_interval": "0.001 ms"}).items()))
            for name, keys in CASES.items()]


def share(a, dt):
    """Of the squared Fourier amplitudes above 25 Hz."""
    power = np.abs(np.fft.rfft(a)) ** 2
    return power[np.fft.rfftfreq(len(a), dt) > 25].sum() / power.sum()


def row(name, column, summary):
    cells = [name]
    motion = {axis: column.motion(f"surface_a{axis}") for axis in "xy"}
    cells.append(", ".join(f"{100 * share(*motion[axis]):.0f} %" for axis in "xy"))
    cells.append(", ".join(f"{np.abs(motion[axis][0]).max():.2f}" for axis in "xy"))
    for axis in "xy":
        cells.append(", ".join(f"{value:.3g}" for value in response_spectrum(*motion[axis], PERIODS)))
    cells += [f"{100 * summary['peak_gamma']:.1f} %", f"{summary['max_ru']:.3f}", f"{summary['steps']:,}"]
    return cells


def draw(columns, path):
    figure, panels = plt.subplots(2, 2, figsize=(7.2, 5), layout="constrained", sharex="col", width_ratios=(1.5, 1))
    styles = (("none", "undamped, every step", GREY), ("the default, 0.1 ms", "default, every step", ORANGE),
              ("the default, rows of 10 ms", "default, rows of 10 ms", BLUE))
    for k, axis in enumerate("xy"):
        for name, label, colour in styles:
            column = columns[name]
            panels[k, 0].plot(column.time, column[f"surface_a{axis}"], color=colour, linewidth=0.6, label=label)
            if "rows" not in name:
                panels[k, 1].plot(column.spectra["period"], column.spectra[f"surface_{axis}_SA"], color=colour)
        panels[k, 0].set(xlim=(1, 9), ylabel=f"$a_{axis}$ of the surface (m/s$^2$)")
        panels[k, 1].set(ylabel="$S_a$ (m/s$^2$), 5 % damping", xscale="log")
        panels[k, 1].axvspan(0.02, 0.04, color="#eeeeee", zorder=0)
        panels[k, 1].set(xlim=(0.02, 5), ylim=(0, None))
        panel_letter(panels[k, 0], "ac"[k])
        panel_letter(panels[k, 1], "bd"[k])
    panels[0, 0].legend(loc="lower right", fontsize=8)
    panels[1, 0].set_xlabel("Time (s)")
    panels[1, 1].set_xlabel("Period (s)")
    save(figure, path, dpi=110)


def report(store, planned, folder):
    found = {name: store.folder(run) for name, run in zip(CASES, planned) if store.is_done(run)}
    columns = {name: Column(path) for name, path in found.items()}
    write_tables(folder, {"damping": (
        ["damping", "above 25 Hz, x and y", "peak, m/s2", "S_a(0.023, 0.1, 0.3, 1 s) along x, m/s2", "along y",
         "peak strain", "largest r_u", "steps"],
        [row(name, columns[name], parsed(path)) for name, path in found.items()])})
    if len(found) == len(CASES):
        draw(columns, folder / "surface.png")

# SPDX-License-Identifier: BSD-3-Clause
"""Undrained triaxial compression in a box and in periodic cells of the same void ratio or friction."""
import dataclasses

import numpy as np

from isostat import Scene
from studies import APPS
from studies.drawing import panels, save
from studies.history import History
from studies.scenes import cloud_edge
from studies.tables import write_tables

DEFAULTS, QUICK = {}, {}
FEW = 500  # grains, of --quick
STRAINS = (1e-4, 1e-3, 5e-3, 1e-2)  # of the table
COLOURS = ("#1a1a1a", "#0072b2", "#d55e00", "#009e73")


@dataclasses.dataclass(frozen=True)
class Run:
    """A specimen and its test in one; in the order of the table the box comes first."""

    name: str
    label: str
    degrees: float  # of preparation friction; 0: the void ratio of the scene is searched for
    quick: bool
    kind = "monotonic"

    def scene(self):
        keys = {"stage.0.strain": STRAINS[-1]}
        if self.degrees:
            keys["specimen.preparation_friction"] = f"{self.degrees:g} deg"
        if self.quick:
            keys |= {"grading.grains": FEW, "grading.cloud_edge": cloud_edge(FEW)}
        domain = "" if self.name == "box" else "_periodic"
        return Scene(APPS / f"scenes/monotonic_compression_dr64{domain}.toml", set=keys)

    def estimated_seconds(self):
        return 15 if self.quick else 600


def runs(options):
    return [Run("box", "box, D_r = 0.64", 4.78 if options.quick else 0, options.quick),
            Run("cell", "cell, same e", 7.53 if options.quick else 0, options.quick),
            Run("cell48", "cell, same friction", 4.776, options.quick),
            Run("cell40", "cell, e of the box inside", 4.02, options.quick)]


def report(store, planned, folder):
    tests = [(run.label, History(store.folder(run))) for run in planned if store.is_done(run)]
    for _, h in tests:
        h.keep(slice(int(h.summary["shear_stage_first_row"]), None))
    header = ["run", "e", "prepared at, °", "Z", *(f"q; p' at {100 * s:g} %, kPa" for s in STRAINS)]
    write_tables(folder, {"box_against_cell": (header, [
        [label, f"{h.summary['void_ratio']:.3f}", f"{h.summary['preparation_friction_deg']:.2f}", f"{h.Z[0]:.2f}",
         *("; ".join(f"{np.interp(s, h.eps_y, column) / 1e3:.1f}" for column in (h.q, h.p)) for s in STRAINS)]
        for label, h in tests])})
    if tests:
        draw(tests, folder / "box_against_cell.png")


def draw(tests, path):
    figure, (row,) = panels(1, 3, 9.6)
    for (label, h), colour in zip(tests, COLOURS):
        small = h.eps_y <= 1e-3
        row[0].plot(100 * h.eps_y[small], h.q[small] / 1e3, color=colour,
                    label=f"{label.split(', D_r')[0]}, e = {h.summary['void_ratio']:.3f}")
        row[1].plot(100 * h.eps_y, h.q / 1e3, color=colour)
        row[2].plot(h.p / 1e3, h.q / 1e3, color=colour)
    for axes, x in zip(row, ("Axial strain (%)", "Axial strain (%)", "p' (kPa)")):
        axes.set(xlabel=x, ylabel="q (kPa)")
    row[0].legend(loc="lower right")
    save(figure, path)

# SPDX-License-Identifier: BSD-3-Clause
"""Slopes, boxes, plates and blocks of Iwan and Mohr-Coulomb soil: what varies their displacements and loads."""
import numpy as np

from figures import biaxial, soil_column
from studies.columns import SCENES, Run
from studies.drawing import draw_figure
from studies.history import parsed
from studies.tables import write_tables

DEFAULTS, QUICK = {}, {}
FEW = {"mesh.points": 2}
SLOPE = {  # label: (keys, CPU seconds)
    "as it is": ({}, 10),
    "peak 0.05 g": ({"motion.0.peak": "0.05 g"}, 10), "peak 0.1 g": ({"motion.0.peak": "0.1 g"}, 10),
    "peak 0.3 g": ({"motion.0.peak": "0.3 g"}, 10),
    **{f"{angle} deg": ({"slope.angle": f"{angle} deg"}, 10) for angle in (1, 2, 6, 7)},
    "water table at 2 m": ({"water.table": "2 m"}, 10),
    "elements half as long": ({"layer.0.cells": 4, "layer.1.cells": 20, "layer.2.cells": 16}, 40),
    "loose sand with air, S = 0.99": ({"layer.1.saturation": 0.99}, 10)}
BOX = {"20 x 6 elements": ({}, 25), "10 x 4 elements": ({"mesh.cells_across": 10, "layer.0.cells": 4}, 6),
       "20 x 6 elements, 2 x 2 points": (FEW, 20)}
STRIP = {
    "as it is": ({}, 25), "2 kPa": ({"load.surcharge": "2 kPa"}, 25), "10 kPa": ({"load.surcharge": "10 kPa"}, 25),
    "60 kPa": ({"load.surcharge": "60 kPa"}, 25),
    "no water": ({"water.drainage": "dry", "layer.0.density": "1640 kg/m3"}, 15)}
COARSE = {"mesh.cells_across": 16, "layer.0.cells": 8}
LOOSE = {"analysis.tolerance": 1e-3}
PLATES = {  # theory: docs/results/plates.md, tests/apps/limit_loads.py, tests/apps/characteristics.py
    "wall drawn away": ("wall", {}, 12), "wall pushed in": ("wall", {"analysis.displacement": "60 mm"}, 30),
    "trapdoor": ("trapdoor", {}, 30), "footing": ("footing", LOOSE, 60),
    "footing, elements twice as long": ("footing", LOOSE | COARSE, 15)}
FINE = {"mesh.cells_across": 16, "layer.0.cells": 32, "analysis.weak.cells": 2}
BLOCKS = {"8 x 16": ({}, 6), "16 x 32": (FINE, 25),
          "8 x 16, no length": ({"analysis.nonlocal.length": "0 m"}, 5)}
SHIFTS = range(3)  # of the amplitude of the box: k times 7e-10 of it


def runs(_):
    column = SCENES / "column"
    shifted = {(label, k): (keys | {"motion.0.amplitude": f"{0.15 * (1 + 7e-10 * k):.12g} g"}, seconds)
               for label, (keys, seconds) in BOX.items() for k in SHIFTS}
    return [*(Run(("slope", label), column / "slope_iwan.toml", tuple(keys.items()), seconds)
              for label, (keys, seconds) in SLOPE.items()),
            *(Run(("box", *case), column / "box_slope_iwan.toml", tuple(keys.items()), seconds)
              for case, (keys, seconds) in shifted.items()),
            *(Run(("strip", label), column / "box_footing_iwan.toml", tuple(keys.items()), seconds)
              for label, (keys, seconds) in STRIP.items()),
            *(Run(("plate", label), column / f"plate_{name}.toml", tuple(keys.items()), seconds)
              for label, (name, keys, seconds) in PLATES.items()),
            *(Run(("block", label), SCENES / "biaxial/mohr_coulomb.toml", tuple(keys.items()), seconds)
              for label, (keys, seconds) in BLOCKS.items())]


def of(folders, kind):
    """(rest of the case, folder, summary) of the runs of a kind."""
    return [(case[1:], folder, parsed(folder)) for case, folder in folders.items() if case[0] == kind]


def slopes(folders):
    return ["varied", "downslope (m)", "largest shear strain at the end (%)", "factor of safety"], [
        [label, f"{s['downslope']:.3f}", f"{100 * s['end_gamma']:.2g}", f"{s['factor_of_safety']:.2f}"]
        for (label,), _, s in of(folders, "slope")]


def boxes(folders):
    """Means and standard deviations of runs whose amplitudes differ by 7e-10."""
    rows = []
    for label in BOX:
        motions = [s["surface_motion"] for (name, _), _, s in of(folders, "box") if name == label]
        if motions:
            columns = [[motion[key] for motion in motions] for key in ("along_x", "settlement", "heave")]
            rows.append([label, len(motions), *(f"{np.mean(c):.3f} ± {np.std(c, ddof=1):.3f}" if len(c) > 1 else
                                                f"{c[0]:.3f}" for c in columns)])
    return ["mesh", "runs", "x = 10 m along x (m)", "largest settlement (m)", "largest heave (m)"], rows


def strips(folders):
    return ["varied", "the surface sinks by (m)", "largest heave (m)"], [
        [label, f"{s['surface_motion']['settlement']:.3f}", f"{s['surface_motion']['heave']:.3f}"]
        for (label,), _, s in of(folders, "strip")]


def plates(folders):
    """Forces in kN/m, and over the length of the plate; those of the footing are of half of it."""
    return ["problem", "force in situ (kN/m)", "smallest", "largest", "at the end", "at the end over the length (kPa)",
            "largest residual"], [
        [label, *(f"{p[key] / 1e3:.2f}" for key in ("force_in_situ", "smallest_force", "largest_force",
                                                    "force_at_the_end")),
         f"{p['force_at_the_end'] / p['length'] / 1e3:.1f}", f"{p['largest_residual']:.1e}"]
        for (label,), _, s in of(folders, "plate") for p in (s["plate"],)]


def blocks(folders):
    rows = []
    for (label,), folder, s in of(folders, "block"):
        block = biaxial.Block(folder)
        thickness, angle = biaxial.band_shape(block, block.maps["shear_strain"][-1])
        strain, stress = (block.history[name] for name in ("axial_strain", "axial_stress"))
        slope = np.diff(np.interp([0.008, 0.012], strain, stress))[0] / 1e3 / 0.4
        rows.append([label, f"{s['peak_stress_Pa'] / 1e3:.1f}", f"{slope:.1f}", f"{s['last_stress_Pa'] / 1e3:.1f}",
                     f"{thickness:.3f}", f"{angle:.0f}", s["iterations"]])
    return ["mesh", "peak (kPa)", "slope, 0.8 to 1.2 % (kPa per %)", "at 1.5 % (kPa)", "thickness (m)",
            "inclination (deg)", "iterations"], rows


# figures of single runs: case, module, what it draws, name
FIGURES = ((("slope", "as it is"), soil_column, "fig_spreading", "slope_spreading"),
           (("slope", "as it is"), soil_column, "fig_loops", "slope_loops"),
           (("box", "20 x 6 elements", 0), soil_column, "fig_box", "box_maps"),
           (("box", "20 x 6 elements", 0), soil_column, "fig_surface", "box_surface"),
           (("strip", "as it is"), soil_column, "fig_box", "strip_maps"),
           (("strip", "as it is"), soil_column, "fig_surface", "strip_surface"),
           (("plate", "wall pushed in"), soil_column, "fig_plate", "wall"),
           (("plate", "trapdoor"), soil_column, "fig_plate", "trapdoor"),
           (("block", "16 x 32"), biaxial, "fig_band", "block"))


def report(store, planned, folder):
    folders = {run.case: store.folder(run) for run in planned if store.is_done(run)}
    write_tables(folder, {table.__name__: table(folders) for table in (slopes, boxes, strips, plates, blocks)})
    for case, module, name, target in FIGURES:
        if case in folders:
            others = [other for key, other in folders.items() if key[0] == case[0] == "block" and key != case]
            draw_figure(module.DRAWING, name, folders[case], folder / f"{target}.png", others)

# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of a run of soil_column from its history.csv, profiles.h5, scene.toml and summary.json.

    python3 -m figures soil_column RESULTS

What the run does not have is left out: a dry soil has no r_u, a base at rest no spectra, a sine no transfer function, a
plate no time.
The input is the motion of a rigid base, or that of the outcrop of a compliant one. Stresses and strains are positive in
compression.
"""
from .column_plate import plate
from .column_results import Column
from .column_box import box_maps, box_surface, surface_amplification
from .column_consolidation import isochrones, settlement
from .column_expansion import expansion
from .column_grains import grains_history, grains_map, grains_profiles
from .column_motion import motions, spectra, transfer_functions
from .column_peaks import liquefaction, peaks
from .column_picture import picture
from .column_slope import spreading
from .column_soil import histories, is_wet, loops, profiles, ru_map, sinks, velocity
from .drawing import Drawing


def kinds(column):
    """Whose parts of captions fit the column."""
    soil = {"one elastic layer" if column.uniform_elastic() else "other soil"}
    return soil | {word for word, fits in (("wet", is_wet(column)), ("sinking", sinks(column))) if fits}


DRAWING = Drawing(Column, [motions, spectra, transfer_functions, peaks, liquefaction, profiles, velocity, ru_map,
                           histories, spreading, box_maps, box_surface, surface_amplification, plate, loops, expansion,
                           isochrones, settlement, grains_profiles, grains_map, grains_history, picture], kinds=kinds)

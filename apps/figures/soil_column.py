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
from .column_box import box_maps, box_surface
from .column_consolidation import isochrones, settlement
from .column_expansion import expansion
from .column_grains import grains_history, grains_map, grains_profiles
from .column_motion import motions, spectra, transfer
from .column_peaks import peaks
from .column_picture import picture
from .column_slope import spreading
from .column_soil import histories, is_wet, loops, profiles, ru_map, sinks, velocity
from .drawing import Drawing

CAPTIONS = {
    "fig_motions": "acceleration of input and surface, for each direction that moves",
    "fig_spectra": "response spectra of input and surface of every step (spectra.csv), and their ratio; grey: "
                   "periods that belong to frequencies above analysis.highest_frequency",
    "fig_transfer": {"": "Fourier amplitudes, surface over input",
                     "one elastic layer": "beside its exact curve, from which the largest difference is printed",
                     "other soil": "smoothed, too (Konno and Ohmachi 1998, b = 80)"},
    "fig_profiles": "largest shear strain so far, r_u, largest shear stress so far over sigma'_v in situ, against "
                    "the depth at several times",
    "fig_peaks": "largest horizontal acceleration, velocity and displacement and largest shear strain of all steps "
                 "over the depth; a dot marks the largest of each, whose value and depth are above it",
    "fig_velocity": "velocity of shear waves of small strain over the depth at the start, where it varies",
    "fig_ru_map": "r_u over depth and time, below the input",
    "fig_histories": {"wet": "r_u at the output depths and its largest value anywhere",
                      "sinking": "settlement"},
    "fig_spreading": "displacement of the surface in time; at the end displacement and shear strain over the depth, "
                     "beside static shear stress and normal effective stress of the start",
    "fig_box": "r_u where its mean is largest and at the end, shear strain at the end, of packings I_R where its mean "
               "is smallest, over the mesh as it has moved",
    "fig_surface": "displacement of the surface in time and over the box",
    "fig_plate": "force against it and normal stress beside it over its way, shear strain at the end",
    "fig_loops": "shear loops and stress paths at the output depths, coloured by time",
    "fig_expansion": "below less permeable layers: net expansion and settlement, above the volumetric strain over "
                     "depth and time, on one scale for both signs",
    "fig_isochrones": "excess pore pressure over the depth, beside Terzaghi's series if it applies",
    "fig_settlement": "settlement against time, beside Terzaghi's if it applies",
    "fig_grains_profiles": "packings of grains: redundancy index I_R, coordination number, fabric over the depth",
    "fig_grains_map": "I_R over depth and time; beside it when each depth falls below I_R = 1 and exceeds r_u = 0.95",
    "fig_grains_history": "I_R, r_u and yielding contacts at the output depths",
    "fig_picture": "acceleration of base and surface; I_R over depth and time; where it has circles, packings from the "
                   "side with their contact forces (grains.snapshot_depths)",
}

FIGURES = {
    "fig_motions": motions,
    "fig_spectra": spectra,
    "fig_transfer": transfer,
    "fig_profiles": profiles,
    "fig_peaks": peaks,
    "fig_velocity": velocity,
    "fig_ru_map": ru_map,
    "fig_histories": histories,
    "fig_spreading": spreading,
    "fig_box": box_maps,
    "fig_surface": box_surface,
    "fig_plate": plate,
    "fig_loops": loops,
    "fig_expansion": expansion,
    "fig_isochrones": isochrones,
    "fig_settlement": settlement,
    "fig_grains_profiles": grains_profiles,
    "fig_grains_map": grains_map,
    "fig_grains_history": grains_history,
    "fig_picture": picture,
}


def kinds(column):
    """Whose parts of captions fit the column."""
    soil = {"one elastic layer" if column.uniform_elastic() else "other soil"}
    return soil | {word for word, fits in (("wet", is_wet(column)), ("sinking", sinks(column))) if fits}


DRAWING = Drawing(Column, FIGURES, CAPTIONS, kinds=kinds)

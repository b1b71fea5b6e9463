# SPDX-License-Identifier: BSD-3-Clause
"""In which units the numbers of a summary are shown; their files have SI.   tested: tests/apps/compare_test.py"""
from figures.column_results import SI
from figures.common import UNITS

FACTORS = {**SI, **UNITS}  # SI units in one of these

# {program: {number: unit}}, as the summary's text has them; what has no unit has "-".
SHOWN = {
    "element_test": {
        "grains": "-", "void_ratio": "-", "relative_density": "-", "e_min": "-", "e_max": "-",
        "preparation_friction_deg": "deg", "p0": "kPa", "p_end": "kPa", "IR_at_start": "-", "IR_at_end": "-",
        "steps": "-", "steps_since_resumed": "-", "seconds": "-",
        "shear_stage_first_row": "-", "reversals": "-", "worst_overshoot": "kPa", "energy_residual": "-",
        "inertial_number": "-", "max_indicator": "-",
        "cyclic_response.load_min": "kPa", "cyclic_response.load_max": "kPa",
        "cyclic_response.strain_min": "%", "cyclic_response.strain_max": "%",
        "gamma_max": "%", "tau_max": "kPa", "sigma_v0": "kPa", "stress_ratio_max": "-", "CSR": "-",
        "liquefaction.row": "-", "liquefaction.ratio": "-", "liquefaction.cycle": "-",
        "liquefaction.strain_before": "%", "liquefaction.p_ratio_before": "-", "liquefaction.IR_before": "-",
        "liquefaction.IR_at_onset": "-", "liquefaction.IR_min": "-", "liquefaction.IR_recovered": "-"},
    "soil_column": {
        "dimension": "-", "height": "m", "mass_damping": "1/s", "viscosity": "ms",
        "highest_frequency": "Hz", "spectrum_damping": "%", "elements": "-", "points": "-",
        "steps": "-", "time_step": "ms", "end": "s", "peak_input": "m/s2", "peak_surface": "m/s2",
        "amplification": "-", "peak_surface_below": "m/s2", "share_above": "%",
        "input_share_above": "%", "peak_gamma": "%", "peak_gamma_depth": "m",
        "peak_velocity": "m/s", "peak_velocity_depth": "m",
        "peak_displacement": "m", "peak_displacement_depth": "m",
        "max_ru": "-", "max_ru_depth": "m",
        "max_ru_time": "s", "settlement": "mm", "immediate_settlement": "mm", "final_settlement": "mm",
        "degree_of_consolidation": "%", "energy_residual": "J/m2", "relative_energy_residual": "-", "packings": "-",
        "min_redundancy": "-", "min_redundancy_depth": "m", "min_redundancy_time": "s",
        "min_redundancy_constraints": "-",
        "surface_motion.settled": "mm", "surface_motion.x": "m", "surface_motion.along_x": "m",
        "surface_motion.largest": "m", "surface_motion.largest_x": "m", "surface_motion.settlement": "mm",
        "surface_motion.settlement_x": "m", "surface_motion.heave": "mm", "surface_motion.heave_x": "m",
        "plate.length": "m", "plate.force_in_situ": "N/m", "plate.largest_force": "N/m", "plate.largest_at": "mm",
        "plate.smallest_force": "N/m", "plate.smallest_at": "mm", "plate.force_at_the_end": "N/m",
        "plate.largest_residual": "-"},
    "biaxial": {
        "steps": "-", "points": "-", "width_m": "m", "height_m": "m", "cells_across": "-", "cells_up": "-",
        "confinement_Pa": "kPa", "axial_strain": "%", "peak_stress_Pa": "kPa", "peak_strain": "%",
        "last_stress_Pa": "kPa", "volumetric_strain": "%", "localisation": "-", "max_strain": "%",
        "max_rotation_deg": "deg", "large_strain_from": "%", "iterations": "-", "trials": "-", "substeps": "-",
        "rejected": "-", "nonlocal_length_m": "m", "pore_pressure_Pa": "Pa",
        "nonlocal_stiffness": "-"},
}
IN_SI = ("_deg", "_m", "_Pa")  # ends of names that give the unit in the file


def flat(value, name=""):
    """{"layers.0.density": 1900, ...} of nested tables and lists; a list of plain values is one entry."""
    if isinstance(value, dict):
        items = value.items()
    elif isinstance(value, list) and any(isinstance(item, (dict, list)) for item in value):
        items = enumerate(value)
    else:
        return {name: value}
    return {key: entry for part, item in items for key, entry in flat(item, f"{name}.{part}" if name else part).items()}


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def named(program, name):
    """A number's name as it is shown, with its unit: `p0 (kPa)`."""
    unit = SHOWN.get(program, {}).get(name, "-")
    for end in IN_SI:
        name = name.removesuffix(end)
    return name if unit == "-" else f"{name} ({unit})"


def converted(program, name, value):
    """A value of a summary in the unit that it is shown in; what is no number as it is."""
    factor = FACTORS.get(SHOWN.get(program, {}).get(name, "-"), 1)
    return value / factor if is_number(value) and factor != 1 else value


def shown(value):
    if value is None:
        return "-"
    if isinstance(value, list):
        return f"[{', '.join(shown(entry) for entry in value)}]"
    return f"{value:.6g}" if isinstance(value, float) else str(value)

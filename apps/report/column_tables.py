# SPDX-License-Identifier: BSD-3-Clause
"""Tables of the report of a soil column: its layers, the site, motions, resistance to liquefaction.

tested: tests/apps/site_response_test.py"""
import re

import numpy as np

from figures import site_response

from . import html
from .quantities import flat, shown

# Keys of a layer that have a column of their own, or describe the mesh.
ELSEWHERE = {"name", "thickness", "cells", "cell_size", "density", "material", "shear_velocity", "shear_modulus"}
OF_WATER = {"permeability", "permeability_law", "saturation"}

ABOUT_SAFETY = (
    "CSR is 0.65 of the largest shear stress over σ'_v0, until r_u of the point reaches 0.5: later stress is that of "
    "soil that dilates. In cycles of one amplitude, for which 0.65 is not meant, it is CSR/0.65. CRR is that of "
    "magnitude 7.5 (15 cycles): multiply CRR by MSF for another.")
TWO_AXES = "CSR is that of the resultant of x and y, CRR that of shear in one direction."


def name_of(layer, k):
    return layer.get("name") or f"layer {k}"


def span(values, digits=3):
    """"120" or "92 to 131"."""
    low, high = (f"{value:.{digits}g}" for value in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


def speeds(column, k):
    """Of shear waves in a layer at the start; of a mesh from a file, whose layers lie anywhere, at its mean p'."""
    if column.is_drawn:
        velocity = said_of(column, k).get("in_situ_shear_velocity")
        return f"{velocity:.4g}" if velocity else "-"
    if column.velocities:
        inside = column.layer_at(column.velocities["depth"]) == k
        return span(column.velocities["shear_velocity"][inside]) if inside.any() else "-"
    velocity = column.layers[k]["velocity"]
    return f"{velocity:.4g}" if velocity else "-"


def said_of(column, k):
    """What the summary says of a layer; nothing in one of an older version."""
    return dict(enumerate(column.summary.get("layers") or [])).get(k, {})


def damping(column, k):
    """Of a layer: mass damping as a share of critical at the frequency of the site, a_M/(4 pi f); its own."""
    period, own = site_response.site(column).get("period"), said_of(column, k).get("damping")
    mass, material = column.damping["mass_damping"], column.scene["layer"][k]["material"]
    return ", ".join(filter(None, (
        f"{100 * mass * period / (4 * np.pi):.2g} % at {1 / period:.3g} Hz" if mass and period else "",
        f"{100 * own:.3g} %" if own else "", "hysteretic" if material != "elastic" else ""))) or "none"


def layers(column):
    """A row for each layer, from the surface down; without depths where layers lie anywhere."""
    ends, rows, parameters = np.cumsum([0.0, *(layer["height"] for layer in column.layers)]), [], []
    unused = ELSEWHERE | (OF_WATER if column.scene.get("water", {}).get("drainage") == "dry" else set())
    for k, table in enumerate(column.scene.get("layer", [])):
        used = said_of(column, k).get("sand", {})  # by its density
        given = ", ".join(f"{re.sub('[_.]', ' ', key)} {f'{value:.4g}' if key in used else shown(value)}"
                          for key, value in flat(table | used).items()
                          if key not in unused and not (key == "strength_ratio" and "shear_strength" in table))
        weight = column.layers[k]["density"] * column.water["gravity"] / 1e3
        height = column.layers[k]["height"]
        depths = () if column.is_drawn else (f"{ends[k]:.4g} to {ends[k + 1]:.4g}", f"{height:.4g}")
        rows.append((name_of(table, k), *depths, f"{weight:.4g}", speeds(column, k), damping(column, k),
                     table["material"].replace("_", "-")))
        parameters.append((name_of(table, k), given))
    depths = () if column.is_drawn else ("Depth (m)", "Thickness (m)")
    head = ("Layer", *depths, "Unit weight (kN/m³)", "V_s (m/s)", "Damping", "Material")
    numbers = range(1, len(depths) + 3)
    return html.table(head, rows, "layers", numbers=numbers) + html.properties(parameters) if rows else ""


def site(column):
    """Velocities and period."""
    s = site_response.site(column)
    if not s:
        return ""
    f1 = {axis: site_response.first_frequency(column, axis) for axis in column.horizontal if len(column.time) > 8}
    largest = site_response.largest_ru(column)
    liquefies = [("f1", f"not given: r_u reaches {largest:.2g}, and soil that liquefies has no one frequency")]
    shallow = "not defined: the column is less deep and its base is rigid"
    return html.properties([
        ("V_s, mean by travel time", f"{s['mean_velocity']:.1f} m/s over {s['height']:.4g} m"),
        ("V_s30", f"{s['V_s30']:.1f} m/s" + (", with rock below the column" if s["height"] < 30 else "")
         if s["V_s30"] else shallow),
        ("period 4H/V_s", f"{s['period']:.4g} s ({1 / s['period']:.4g} Hz), by travel time at small strain"),
        *((f"f1 along {axis}", f"{f:.2g} Hz, largest ratio of surface and {site_response.input_name(column)} motion "
           f"below {2 / s['period']:.3g} Hz") for axis, f in f1.items() if f),
        *(liquefies if largest >= site_response.LIQUEFYING else [])])


def motions(column):
    """Intensities of input, of the base of a column on rock, of the surface and the output depths."""
    name = site_response.input_name(column)
    places = [("input", f"input ({name})"), *([("within", "base (within)")] if column.base else []),
              ("surface", "surface"), *((z, f"{z:.4g} m") for z in column.motion_depths if z is not None)]
    rows = []
    for axis in column.moving:
        for where, label in places:
            if isinstance(where, str) and not column.has({"within": "base"}.get(where, where) + f"_a{axis}"):
                continue
            a = site_response.intensity_at(column, where, axis)
            rows.append((label, axis, f"{a['PGA']:.4g}", f"{a['PGA'] / site_response.GRAVITY:.3g}", f"{a['arias']:.4g}",
                         f"{a['D5_95']:.4g}", f"{a['CAV']:.4g}"))
    frequency = 0.25 * (len(column.time) - 1) / (column.time[-1] - column.time[0])
    table = html.table(("Motion", "Along", "PGA (m/s²)", "PGA (g)", "Arias intensity (m/s)", "D5-95 (s)", "CAV (m/s)"),
                       rows, "motions", numbers=range(2, 7))
    return [table, html.paragraph(f"Of the rows of the history, which hold frequencies up to {frequency:.3g} Hz.")]


def liquefaction(column):
    """The least factor of safety of each layer with a resistance."""
    found = site_response.resistance(column)
    if found is None:
        return []
    depth, csr, crr, safety = found
    ru = column.peak_profile["ru_max"][np.isfinite(column.peak_profile["CSR"])]
    rows = []
    for k, table in enumerate(column.scene.get("layer", [])):
        inside = np.flatnonzero((column.layer_at(depth) == k) & np.isfinite(safety))
        if inside.size:
            at = inside[np.argmin(safety[inside])]
            rows.append((name_of(table, k), f"{depth[at]:.4g}",
                         *(f"{values[at]:.3g}" for values in (csr, crr, safety, ru))))
    head = ("Layer", "Depth of the least (m)", "CSR there", "CRR", "Factor of safety", "Largest r_u there")
    return [html.table(head, rows, "liquefaction", numbers=range(1, 6)), html.paragraph(ABOUT_SAFETY),
            html.paragraph(TWO_AXES) if len(column.horizontal) > 1 else ""]


def sections(column):
    """Of the page; those that the run has nothing for are left out."""
    shaken = column.shaken and column.moving
    return [html.section("Soil layers", layers(column), name="layers"),
            html.section("Site", site(column) if shaken else "", name="site"),
            html.section("Motions", *(motions(column) if shaken else []), name="motions"),
            html.section("Resistance to liquefaction", *liquefaction(column), name="liquefaction")]

# SPDX-License-Identifier: BSD-3-Clause
"""Every key that a scene may be refused for, beyond its own range, has the limit in its row of the scene reference."""
import re
import unittest

from support import ROOT

SOURCES = ("dem/scene/checks.cpp", "apps/deposit/checks.cpp", "apps/deposit/box.cpp", "apps/deposit/plate.cpp",
           "apps/deposit/slope.cpp", "apps/deposit/layer_tables.cpp", "apps/deposit/mesh_file.cpp",
           "apps/deposit/biaxial.cpp", "coupling/scene/packings.cpp", "fem/material/iwan_scene.cpp",
           "fem/material/mohr_coulomb_scene.cpp", "fem/material/umat_scene.cpp", "fem/solve/newton_scene.cpp")
# The key of a refusal: "mesh.degree", prefix + ".density", fmt::format("stage.{}.friction", i), key("lot"), and the
# {"cohesion", "must be ..."} of mohr_coulomb_problem().
REFUSED = re.compile(r'(?:refuse\(\s*|key\()(?:\w+ \+ |fmt::format\(\s*)?"([\w.{}]+)"|return \{"(\w+)",\s*"')
# Words of the limit in the row of the key; "": the limit is stated elsewhere (of the section, of another key).
STATED = {
    "scene": {
        "specimen.pressure": "a twentieth of the modulus", "specimen.e_min": "Below `e_max`",
        "specimen.consolidation": "in the periodic-cell only; not together with `file`",
        "sand.lowest_pressure": "at most `highest_pressure`", "sand.lowest_void_ratio": "at most `highest_void_ratio`",
        "specimen.relative_density": "", "motion.drive": "static needs a stage that shears",
        "specimen.file": "", "contact.rolling": "Needs `friction`", "contact.twisting": "Needs `friction`",
        "stage.friction": "Above 0 deg only where", "stage.stages": "At most as many as there are",
        "stage.kind": "need the domain periodic-cell", "stage.deviator_average": "q must lie between them"},
    "column_scene": {
        "mesh.degree": '2 where drainage is "coupled"', "mesh.dimension": "1: a column",
        "mesh.distributed": "Of dimension 2 or 3", "mesh.points": "at least the degree", "mesh.sides": "dimension 2",
        "mesh.file": "in dimension 3", "refine.from": "of a block x, y", "refine.to": "above `from`",
        "mesh.cells_across": "left out with `file`", "mesh.width": "that of `file`",
        "layer.thickness": "left out with `mesh.file`",
        "mesh.ground_x": "on boundaries between elements", "mesh.ground_z": "the highest being that of all layers",
        "analysis.large_strain": "Not in an undrained column", "water.drainage": "a column only",
        "water.lagged_compressibility": "Undrained only",
        "water.henry": "Above 0 only where the volume may change", "water.air": "boyle needs air",
        "water.table": "Less than the height of the soil", "slope.angle": "Less than the soil can bear",
        "layer.saturation": "Below 1 only below the water table", "layer.density": "Above that of the water",
        "layer.permeability": "Must be given if the drainage is coupled", "layer.cell_size": "At most 1000000 elements",
        "layer.permeability_law": "Only where drainage is",
        "layer.name": "with `mesh.file` its own", "layer.material": "",
        "layer.umat.nstatv": "at least that in `umat.statev`", "layer.table": "",
        "water.base": 'drained only where drainage is "coupled"',
        "layer.phase_transformation_ratio": "at most `strength_ratio`",
        "layer.cohesion": "Above 0 kPa without friction",
        "layer.dilatancy_angle": "at most `friction_angle`", "layer.softening_strain": "Above 0 with a residual value",
        "layer.residual_friction_angle": "at most `friction_angle`", "layer.residual_cohesion": "at most `cohesion`",
        "layer.residual_dilatancy_angle": "at most `dilatancy_angle`",
        "layer.mixed_realisations": "1, or at least `realisations`",
        "layer.shear_velocity": "G = density V_s^2", "layer.shear_modulus": "Shear modulus G",
        "layer.k0": "0.9 of the strength", "layer.lot": "Only with `mixed_realisations` above 1",
        "layer.lot_length": "", "base.kind": "",
        "base.p_velocity": "More than 1.155 times", "motion.axis": "A motion along z needs a rigid base",
        "motion.file": "1e-5 s to 10 s apart and within 1e6 m/s2", "motion.ramp": "At most half of `duration`",
        "load.kind": "", "load.surcharge_from": "on a boundary between elements",
        "load.surcharge_to": "Between `surcharge_from` and the width", "grains.library": "Needed by soil of grains",
        "grains.path_depths": "Within the soil", "grains.snapshot_depths": "Within the soil",
        "analysis.kind": "A consolidation needs", "analysis.petsc": "for the linear systems",
        "analysis.scheme": "dry or coupled soil of formulas", "analysis.spectral_radius": "Of implicit steps",
        "analysis.safety": "Of explicit steps", "analysis.viscosity": "0 ms of implicit steps",
        "analysis.last_time": "After `first_time`",
        "analysis.duration": "At most 1e15 time steps", "analysis.from": "on a boundary between elements",
        "analysis.to": "likewise", "analysis.displacement": "less than the extent of the soil",
        "analysis.axial_strain": "not 0",
        "analysis.max_iterations": "0: relaxation alone", "analysis.nonlocal.length": "needs max_iterations = 0",
        "analysis.weak.cells": "The square lies in the block", "output.depths": "Within the soil",
        "output.profile_interval": "", "output.x": "Of a strip"},
}
WHOLE_SECTIONS = {"motion", "grains", "refine"}  # a table that is refused, not a key


def rows_of(page):
    """{key: text of all its rows} of a reference."""
    rows, section = {}, ""
    for line in (ROOT / f"docs/{page}_reference.md").read_text(encoding="utf-8").splitlines():
        if heading := re.match(r"## \[+(\w+)\]+", line):
            section = heading[1] + "."
        if row := re.match(r"\| `([\w.]+)` \|", line):
            rows[section + row[1]] = rows.get(section + row[1], "") + line
    return rows


class Limits(unittest.TestCase):
    def test_rows_state_them(self):
        for page, keys in STATED.items():
            rows = rows_of(page)
            for key, words in keys.items():
                with self.subTest(page=page, key=key):
                    self.assertIn(words, rows.get(key, "no such key in the reference"))

    def test_every_refusal_is_listed(self):
        listed = {key.split(".")[-1] for keys in STATED.values() for key in keys} | WHOLE_SECTIONS
        for source in SOURCES:
            found = [one or other for one, other in REFUSED.findall((ROOT / source).read_text(encoding="utf-8"))]
            self.assertTrue(found or source.endswith("newton_scene.cpp"), source)
            for key in found:
                name = key.split(".")[-1]
                if name not in ("", "{}"):  # else it is made of other words
                    self.assertIn(name, listed, f"{source} refuses {key}: state the limit in the text of the key, and "
                                                "its words here")

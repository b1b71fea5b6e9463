# SPDX-License-Identifier: BSD-3-Clause
"""Layers whose law is a shared library with the interface of Abaqus (examples/umat): closed forms are in
tests/fem/material/umat_test.cpp; here they run in columns."""
import pathlib
import shutil
import signal

import numpy as np

from column_support import ColumnTest, history, settings
from support import BIN

LAWS = BIN.parent / "tests/umat"
SHEAR, POISSON, DENSITY = 80e6, 0.3, 2000
LAYERS = """title = "a law of a library over an elastic layer"
[water]
drainage = "coupled"
[[layer]]
name = "sand"
thickness = "4 m"
cells = 4
permeability = "1e-5 m/s"
{law}
[[layer]]
thickness = "4 m"
cells = 4
permeability = "1e-7 m/s"
material = "elastic"
shear_velocity = "200 m/s"
"""
DYNAMIC = """[[motion]]
axis = "x"
kind = "ricker"
amplitude = "0.5 g"
frequency = "3 Hz"
[[motion]]
axis = "z"
kind = "ricker"
amplitude = "0.1 g"
frequency = "5 Hz"
[analysis]
duration = "0.8 s"
viscosity = "0 ms"  # that of elastic soil
[output]
depths = ["0.5 m", "2.5 m"]
profile_interval = "0.1 s"
"""
CONSOLIDATION = """[load]
kind = "step"
amplitude = "50 kPa"
[analysis]
kind = "consolidation"
first_time = "10 s"
last_time = "30 d"
steps = 10
"""
BLOCK = """title = "an elastic block"
[mesh]
dimension = 2
width = "1 m"
cells_across = 2
[water]
drainage = "dry"
[[layer]]
name = "sand"
thickness = "2 m"
cells = 2
{law}
[analysis]
kind = "biaxial"
confinement = "50 kPa"
axial_strain = 1e-3
load_steps = 4
"""
BUILT_IN = f'material = "elastic"\nshear_modulus = "{SHEAR} Pa"\npoisson_ratio = {POISSON}'


def law(library, props, more=""):
    return f'material = "umat"\numat.library = "{library}"\numat.props = {props}\n{more}'


ELASTIC = law("elastic.so", [SHEAR, POISSON])
# yields: 0.5 g against friction; without Fortran the probe, which counts its calls
HAS_FORTRAN = (LAWS / "drucker_prager.so").exists()
SOIL = (law("drucker_prager.so", [SHEAR, POISSON, 33, 2e3, 0], "umat.statev = [0]") if HAS_FORTRAN
        else law("probe.so", [SHEAR, POISSON, 0, 1], "umat.nstatv = 20"))


class UmatTest(ColumnTest):
    def setUp(self):
        super().setUp()
        for library in LAWS.iterdir():
            shutil.copy(library, self.folder)

    def scene_of(self, layer, analysis=DYNAMIC):
        return self.write("scene.toml", LAYERS.format(law=layer) + analysis)

    def test_an_elastic_law_is_the_built_in_one(self):
        for analysis, round_off in ((DYNAMIC, 1e-9), (CONSOLIDATION, 1e-9)):
            text = [LAYERS.format(law=layer) + analysis for layer in (BUILT_IN, ELASTIC)]
            (expected, summary), (found, other) = (self.rows_of(t, f"run{k}") for k, t in enumerate(text))
            self.assertEqual(expected.keys(), found.keys())
            for name, values in expected.items():
                if name != "residual":  # of energies, itself round-off
                    self.assert_near(found[name], values, round_off * max(np.abs(values).max(), 1e-6),
                                     f"round-off of all steps: {name}")
            self.assertEqual(other["layers"][0]["material"], "umat")
            shutil.rmtree(self.folder / "run0")
            shutil.rmtree(self.folder / "run1")

    def test_a_killed_run_resumes_bit_for_bit_and_ranks_change_nothing(self):
        scene = self.scene_of(SOIL)
        arguments = [scene, *settings(output__checkpoint="1e-9 min"), "--quiet"]
        self.assert_done(self.run_column(*arguments, "-o", "whole"))
        started = (self.folder / "parts/checkpoint/last.h5", True)
        self.run_and_stop(0.05, signal.SIGTERM, started, *arguments, "-o", "parts", program="soil_column")
        self.assert_done(self.run_column(*arguments, "-o", "parts", "--resume"))
        self.assert_same_files("whole", "parts")
        self.assert_done(self.run_command(["mpirun", "--oversubscribe", "-n", "2", *self.command(
            "soil_column", *arguments, "-o", "ranks", "--no-figures")]))
        self.assert_same_files("whole", "ranks")

    def test_a_mesh_that_is_shared_out(self):
        wide = settings(mesh__dimension=2, mesh__width="2 m", mesh__cells_across=2)
        text = self.scene_of(SOIL).read_text(encoding="utf-8").replace('profile_interval = "0.1 s"\n', "")
        path = self.write("scene.toml", text)
        found = []
        for name, more in (("copy", []), ("shared", settings(mesh__distributed="true"))):
            self.assert_done(self.run_command(["mpirun", "--oversubscribe", "-n", "2", *self.command(
                "soil_column", path, *wide, *more, "-o", name, "--no-figures", "--quiet")]))
            found.append(history(self.folder / name))
        del found[0]["residual"]
        for name, values in found[0].items():
            self.assert_near(found[1][name], values, 1e-6 * max(np.abs(values).max(), 1e-6), f"order of sums: {name}")

    def test_mistakes_are_named(self):
        line = LAYERS.splitlines().index("{law}") + 2

        def refused(layer, *parts):
            self.assert_refused(self.run_column(self.scene_of(layer), "-o", "none"), *parts)

        refused(law("nowhere.so", []), f"scene.toml:{line}: layer.0.umat.library", "does not exist: neither")
        self.write("text.so", "no library")
        refused(law("text.so", []), f"scene.toml:{line}: layer.0.umat.library", "cannot be loaded", "gfortran -shared")
        maps = pathlib.Path("/proc/self/maps").read_text(encoding="utf-8").split()
        refused(law(next(word for word in maps if "/libc.so" in word or "/libc-" in word), []),
                f"scene.toml:{line}: layer.0.umat.library", "has no symbol umat_", "outside of any module")
        refused(law("probe.so", [SHEAR, POISSON, 4, 0]), "layer.0 (sand): umat: point 0: ", "no wave runs with DDSDDE")
        refused(law("elastic.so", ["80 MPa"]), "layer.0.umat.props", "must be a plain number")
        refused(law("elastic.so", 3), "layer.0.umat.props", "list [...] of plain numbers")

    def test_an_increment_that_a_law_rejects_ends_with_its_place(self):
        result = self.run_column(self.scene_of(law("probe.so", [SHEAR, POISSON, 1, 1e-5])), "-o", "out")
        self.assertEqual(result.returncode, 1)
        for part in ("umat: point ", "layer.0 (sand), depth ", "smaller increment (PNEWDT = 0.25)", "step "):
            self.assertIn(part, result.stderr)

    def test_an_increment_that_a_law_rejects_is_divided_in_statics(self):
        """Axial stress of an elastic block rises by E/(1 - nu^2) times the strain."""
        scene = self.write("block.toml", BLOCK.format(law=law("probe.so", [SHEAR, POISSON, 1, 2e-4])))
        self.assert_done(self.run_column(scene, "-o", "out", "--quiet"))
        rows = history(self.folder / "out")
        self.assertGreater(rows["rejected"].sum(), 0)
        self.assertGreaterEqual(rows["substeps"].sum(), 2 * 4)
        modulus = 2 * SHEAR / (1 - POISSON)  # E/(1 - nu^2), E = 2 G (1 + nu)
        self.assert_close(rows["axial_stress"][-1], 50e3 + 1e-3 * modulus, 1e-8, "Newton's tolerance, small strain")

# SPDX-License-Identifier: BSD-3-Clause
"""Biaxial blocks of soil_column: an elastic one against its closed form, a weak element, packings, refusals."""
import h5py
import numpy as np

from column_support import SCENES, ColumnTest, history, settings
from figures.biaxial import Block, band, band_shape, rate_maps, shear_maps
from support import tiny_scene

BLOCKS = SCENES.parent / "biaxial"
ELASTIC = """title = "elastic block"
[mesh]
dimension = 2
cells_across = 3
degree = {degree}
[water]
drainage = "dry"
[[layer]]
thickness = "2 m"
cells = 4
material = "elastic"
shear_modulus = "50 MPa"
poisson_ratio = 0.3
[analysis]
kind = "biaxial"
axial_strain = 0.01
load_steps = 2
"""
TWO_HIGH = """title = "{title}"
[mesh]
dimension = 2
cells_across = {across}
degree = 1
[water]
drainage = "dry"
[[layer]]
thickness = "2 m"
cells = 2
"""
FRICTION = TWO_HIGH.format(title="friction", across=2) + """material = "mohr_coulomb"
shear_modulus = "50 MPa"
poisson_ratio = 0.25
friction_angle = "36 deg"
dilatancy_angle = "8 deg"
cohesion = "3 kPa"
[analysis]
kind = "biaxial"
axial_strain = 0.02
load_steps = 10
"""
GRAINS = TWO_HIGH.format(title="two elements", across=1) + """material = "grains"
[grains]
library = "library.h5"
inertial_number = 1e-3
[analysis]
kind = "biaxial"
confinement = "50 kPa"
axial_strain = 0.002
load_steps = 2
tolerance = 0.01
map_every = 1
"""
CELL = 'domain = "periodic-cell"\npressure = "50 kPa"\npreparation_friction = "10 deg"\n'
FEW = ("--set", "grading.truncate=[20, 80]", "--set", "grading.grains=150", "--set", "grading.cloud_edge=2.45 mm")


class Biaxial(ColumnTest):
    def run_block(self, text, *arguments, name="run"):
        return self.run_column(self.write("block.toml", text), "-o", name, "--overwrite", "-q", *arguments)

    def history(self, name="run"):
        return history(self.folder / name)

    def maps(self, name="run"):
        with h5py.File(self.folder / name / "maps.h5") as file:
            return {key: np.asarray(values) for key, values in file.items()}

    def test_mohr_coulomb_block_is_the_closed_form(self):
        self.assert_done(self.run_block(FRICTION))
        rows, phi, psi = self.history(), np.radians(36), np.radians(8)
        ratio = (1 + np.sin(phi)) / (1 - np.sin(phi))
        solved = "Newton's method with a consistent tangent: 1e-6 of the force"
        self.assert_close(rows["axial_stress"][-3:], ratio * 100e3 + 2 * 3e3 * np.sqrt(ratio), 1e-6, solved)
        axial, lateral = np.diff(rows["axial_strain"])[-1], np.diff(rows["lateral_strain"])[-1]
        self.assert_near((axial + lateral) / (axial - lateral), -np.sin(psi), 1e-6, solved)
        self.assertLessEqual(max(rows["iterations"]), 4)

    def test_a_band_forms_where_strength_falls(self):
        small = settings(mesh__cells_across=4, layer__0__cells=8, analysis__weak__row=3, analysis__axial_strain=0.02,
                         analysis__load_steps=20)
        self.assert_done(self.run_column(BLOCKS / "softening.toml", "-o", "run", "-q", *small))
        stress, shear = self.history()["axial_stress"], self.maps()["shear_strain"][-1]
        self.assert_near(stress.max(), 464.2e3, 15e3, "the peak of the uniform block lies between two steps of 0.1 %")
        self.assertTrue(339e3 < stress[-1] < 0.85 * stress.max(), stress)  # residual strength, 343 kPa, and a tolerance
        elements = shear.reshape(-1, 4).mean(axis=1)
        self.assertGreater(elements.max(), 3 * shear.mean())
        self.assert_below(np.median(elements) / shear.mean(), 0.5, "elements apart from the band do not shear with it")

    def test_weak_elements_have_less_strength(self):
        self.assert_done(self.run_block(FRICTION, *settings(analysis__weak__cells=2, analysis__weak__factor=0.9)))
        tangent = 0.9 * np.tan(np.radians(36))
        sine = tangent / np.hypot(1, tangent)
        ratio = (1 + sine) / (1 - sine)
        self.assert_close(self.history()["axial_stress"][-1], ratio * 100e3 + 2 * 2.7e3 * np.sqrt(ratio), 1e-6,
                          "a block that is weak everywhere: Newton's method to 1e-6 of the force")

    def test_elastic_block_is_the_closed_form(self):
        nu, strain = 0.3, 0.01
        modulus = 2 * 50e6 * (1 + nu) / (1 - nu**2)
        for degree in (1, 2):
            self.assert_done(self.run_block(ELASTIC.format(degree=degree)))
            rows = self.history()
            solved = "a direct solution: round-off times the condition of the system"
            self.assert_close(rows["axial_stress"], 100e3 + modulus * np.array([0, strain / 2, strain]), 1e-10, solved)
            self.assert_near(rows["axial_strain"][-1], strain, 1e-14, "round-off: the plate's way is given")
            self.assert_near(rows["lateral_strain"][-1], -nu / (1 - nu) * strain, 1e-13, solved)
            self.assert_near(rows["volumetric_strain"][-1], (1 - nu / (1 - nu)) * strain, 1e-13, solved)
            self.assertEqual(list(rows["iterations"]), [0, 1, 1])
            maps = self.maps()
            self.assert_close(maps["shear_strain"][-1], strain / (1 - nu), 1e-9, solved)
            self.assert_close(maps["q"][-1], modulus * strain / 2, 1e-9, solved)
            self.assertTrue((self.folder / "run/paraview/block_00001.vtu").exists())

    def test_undrained_elastic_block_is_the_closed_form(self):
        nu, strain, storage = 0.3, 0.01, 2.2e9 / 0.4  # K_f over the porosity
        lame = 2 * 50e6 * nu / (1 - 2 * nu)
        confined = lame + 2 * 50e6
        lateral = (lame + storage) / (confined + storage) * strain  # no change of total stress on the sides
        pressure = storage * (strain - lateral)
        undrained = settings(water__drainage="coupled", layer__0__permeability="0 m/s")
        for more in ((), settings(analysis__max_iterations=0, analysis__relaxation_iterations=2000),
                     settings(layer__0__permeability="1e-6 m/s")):
            self.assert_done(self.run_block(ELASTIC.format(degree=2), *undrained, *more))
            rows, maps = self.history(), self.maps()
            solved = "a direct solution of a uniform block: round-off times the condition of the system"
            stress = confined * strain - lame * lateral + pressure
            self.assert_close(rows["axial_stress"][-1], 100e3 + stress, 1e-10, solved)
            self.assert_close(rows["pore_pressure"][-1], pressure, 1e-10, solved)
            self.assert_close(-rows["lateral_strain"][-1], lateral, 1e-10, solved)
            self.assert_close(maps["pore_pressure"][-1], pressure, 1e-10, solved)

    def test_water_moves_by_permeability_times_time(self):
        """From a stiff block to a weak part of it: as far in 100 s as in 1,000 s with a tenth of the permeability."""
        keys = settings(water__drainage="coupled", analysis__weak="{cells = 1, column = 1, row = 1, factor = 0.2}")
        spread = {}
        for k, time in (("0 m/s", 100), ("0 m/s", 1), ("1e-8 m/s", 100), ("1e-9 m/s", 1000), ("1e-4 m/s", 100)):
            self.assert_done(self.run_block(ELASTIC.format(degree=2), *keys, *settings(
                layer__0__permeability=k, analysis__test_duration=f"{time} s")))
            pressure = self.maps()["pore_pressure"][-1]
            spread[k, time] = np.ptp(pressure) / pressure.mean()
            rows = self.history()
            self.assert_close(rows["pore_pressure"][-1], 2.2e9 / 0.4 * rows["volumetric_strain"][-1], 1e-8,
                              "no water leaves the block: round-off of strains of 1e-4")
        self.assert_close(spread["0 m/s", 1], spread["0 m/s", 100], 1e-9, "no water moves at any time")
        self.assert_close(spread["1e-9 m/s", 1000], spread["1e-8 m/s", 100], 1e-9, "k t counts alone: round-off")
        self.assert_below(spread["1e-8 m/s", 100], 0.9 * spread["0 m/s", 100], "it flows over decimetres")
        self.assert_below(spread["1e-4 m/s", 100], 1e-3 * spread["0 m/s", 100], "all differences have gone")

    def test_undrained_mohr_coulomb_block_is_the_closed_form(self):
        """Without dilatancy the mean s of the stresses in the plane changes by the volume of the water alone."""
        self.assert_done(self.run_block(FRICTION, *settings(
            water__drainage="coupled", layer__0__permeability="0 m/s", mesh__degree=2,
            layer__0__dilatancy_angle="0 deg")))
        rows, maps = self.history(), self.maps()
        sine, soft = np.sin(np.radians(36)), 100e6 / (2.2e9 / 0.4)  # of soil over water: (lambda + G) n/K_f
        start = 100e3 * sine + 3e3 * np.cos(np.radians(36))  # radius of Mohr's circle: s sin(phi) + c cos(phi)
        pressure = start / (1 + soft * (1 - sine))  # s = 100 kPa + soft u, and total stress on the sides stays
        solved = "Newton's method to 1e-6 of the force"
        self.assert_close(rows["pore_pressure"][-1], pressure, 1e-5, solved)
        self.assert_close(maps["q"][-1], start + soft * pressure * sine, 1e-5, solved)
        self.assert_close(rows["axial_stress"][-1], 100e3 + 2 * maps["q"][-1].mean(), 1e-5, solved)
        self.assert_close(maps["shear_strain"][-1].max(), maps["shear_strain"][-1].min(), 1e-6, "it stays uniform")

    def test_maps_have_labels(self):
        self.assert_done(self.run_block(ELASTIC.format(degree=1)))
        block = Block(self.folder / "run")
        for draw in band, shear_maps, rate_maps:
            panels = [axes for axes in draw(block).axes if axes.get_label() != "<colorbar>"]
            self.assertEqual([axes.get_xlabel() == "" for axes in panels], [False] * len(panels), draw.__name__)

    def test_shape_of_a_band(self):
        """A band with a Gaussian profile, whose width at half of it is 2.355 standard deviations."""
        self.assert_done(self.run_block(ELASTIC.format(degree=1), *settings(
            mesh__cells_across=24, layer__0__cells=48, analysis__load_steps=1)))
        block = Block(self.folder / "run")
        for angle in 40, 60:
            across = np.array([-np.sin(np.radians(angle)), np.cos(np.radians(angle))])
            distance = across @ [block.maps["x"] - 0.5, block.maps["z"] - 1.1]
            thickness, found = band_shape(block, np.exp(-(distance / 0.08) ** 2 / 2))
            self.assert_near(thickness, 2.355 * 0.08, 0.004, "bins of 20 mm smear the profile; measured 2.5 mm")
            self.assert_near(found, angle, 0.5, "measured 0.08 deg")
        self.assertTrue(np.isnan(band_shape(block, block.maps["x"])[0]))

    def test_weak_element_shears_more(self):
        self.assert_done(self.run_block(ELASTIC.format(degree=1), *settings(
            analysis__weak="{cells = 1, column = 1, row = 2, factor = 0.5}")))
        maps = self.maps()
        inside = (abs(maps["x"] - 0.5) < 1 / 6) & (abs(maps["z"] - 1.25) < 1 / 4)
        self.assertEqual(inside.sum(), 4)
        self.assertGreater(maps["shear_strain"][-1][inside].min(), maps["shear_strain"][-1][~inside].mean())

    def test_strains_that_the_mesh_cannot_take_as_small_are_reported(self):
        for strain, large in ((0.05, False), (0.24, True)):
            result = self.run_block(ELASTIC.format(degree=1), *settings(analysis__axial_strain=strain))
            self.assert_done(result)
            summary = self.summary_of("run")
            self.assert_close(summary["max_strain"], strain, 1e-9, "a direct solution of a uniform block")
            self.assert_below(summary["max_rotation_deg"], 1e-9, "round-off: a uniform block does not rotate")
            text = (self.folder / "run/summary.txt").read_text(encoding="utf-8")
            self.assertIn(f"strain up to {100 * strain:.3g} %, rotation up to", text)
            self.assertEqual(text.count("beyond 10 %"), int(large))
            if large:
                self.assert_near(summary["large_strain_from"], 0.12, 1e-12, "the first of two steps, of 12 % each")
            else:
                self.assertIsNone(summary["large_strain_from"])

    def test_packings(self):
        scene = self.write("rve.toml", tiny_scene(specimen=CELL, stages="# none"))
        self.assert_done(self.run_app("isostat", "library", scene, *FEW, "-n", "2", "-o", "library.h5"))
        mixed = settings(layer__0__mixed_realisations=2)
        self.assert_done(self.run_block(GRAINS, *mixed))
        self.assert_done(self.run_block(GRAINS, *mixed, "--threads", "2", name="threads"))
        self.assert_done(self.run_on_ranks(2, "block.toml", "-o", "ranks", "-q", *mixed))
        for other in ("threads", "ranks"):
            self.assert_same_files("run", other)
        rows, maps = self.history(), self.maps()
        self.assertTrue(np.all(np.diff(rows["axial_stress"]) > 0))
        self.assert_below(rows["residual"].max(), 0.01, "tolerance of the scene")
        self.assertGreater(maps["redundancy"].min(), 1)
        self.assertGreater(len(np.unique(maps["void_ratio"][0])), 1)  # two realisations
        summary = self.summary_of("run")
        self.assertTrue(summary["complete"])
        self.assertEqual(summary["points"], 8)

    def test_too_much_strain_for_newton_leaves_what_it_found(self):
        iwan = ELASTIC.format(degree=1).replace('"elastic"', '"iwan"')
        result = self.run_block(iwan, *settings(analysis__max_iterations=1, analysis__max_halvings=0))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("no equilibrium in step 1", result.stderr)
        self.assertEqual(len(self.history()["step"]), 1)
        self.assertIn('"complete": false', (self.folder / "run/summary.json").read_text(encoding="utf-8"))

    def test_length(self):
        relaxed = settings(analysis__nonlocal__length="0.5 m", analysis__max_iterations=0,
                           analysis__relaxation_iterations=2000)
        self.assert_done(self.run_block(ELASTIC.format(degree=1), *relaxed, name="uniform"))
        self.assert_done(self.run_block(ELASTIC.format(degree=1), name="local"))
        stress = [self.history(name)["axial_stress"][-1] for name in ("uniform", "local")]
        self.assert_close(stress[0], stress[1], 1e-5, "uniform strain is untouched; tolerance of 1e-6")
        text = (self.folder / "uniform/summary.txt").read_text(encoding="utf-8")
        self.assertIn("length                   0.5 m", text)
        self.assertNotIn("mean_shear_strain", self.maps("local"))
        weak = settings(analysis__weak="{cells = 1, column = 1, row = 2, factor = 0.2}")
        self.assert_done(self.run_block(ELASTIC.format(degree=1), *weak, name="local"))
        self.assert_done(self.run_block(ELASTIC.format(degree=1), *weak, *relaxed))
        maps, local = self.maps(), self.maps("local")
        spread = [np.ptp(field[-1]) for field in (maps["mean_shear_strain"], maps["shear_strain"],
                                                  local["shear_strain"])]
        self.assertLess(spread[0], spread[1])
        self.assertLess(spread[1], spread[2])

    def test_band_with_a_length_is_that_of_every_mesh(self):
        stress = []
        for cells in (4, 8):
            self.assert_done(self.run_column(BLOCKS / "mohr_coulomb.toml", "-o", "run", "--overwrite", "-q", *settings(
                mesh__cells_across=cells, layer__0__cells=2 * cells, analysis__weak__cells=cells // 4,
                analysis__nonlocal__length="0.08 m", analysis__load_steps=15)))
            stress.append(self.history()["axial_stress"])
        coarse, fine = stress
        self.assert_below(fine[-1] / fine.max(), 0.85, "or nothing softens")
        self.assert_near(coarse / fine, 1, 5e-3, "measured 0.2 %")

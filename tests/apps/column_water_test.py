# SPDX-License-Identifier: BSD-3-Clause
"""The water of a column as a user sees it: expansion under a cap, air, three components of motion, viscosity."""

import re

import h5py
import numpy as np

from column_support import ColumnTest, SCENES, SOIL, history, settings

CLAY = """title = "clay under a fill"
[water]
drainage = "coupled"
[[layer]]
name = "clay"
thickness = "8 m"
cell_size = "0.8 m"
density = "1700 kg/m3"
porosity = 0.5
permeability = "2e-9 m/s"
material = "elastic"
shear_modulus = "1 MPa"
poisson_ratio = 0.25
[load]
kind = "step"
amplitude = "40 kPa"
[analysis]
kind = "consolidation"
first_time = "2 h"
last_time = "20000 d"
steps = 20
[output]
depths = ["4 m"]
"""


class Drainage(ColumnTest):
    """CLAY under 40 kPa: D = 3 MPa, c = kb/(1/D + n/K_f)."""
    C = 2e-9 / 9810 / (1 / 3e6 + 0.5 / 2.2e9)

    def test_a_first_time_that_no_mesh_shows(self):
        scene = self.write("clay.toml", CLAY)
        result = self.run_column(scene, "-o", "out", *settings(analysis__first_time="1e-9 s", analysis__steps=5))
        self.assert_done(result)
        cell = 0.8 / 2**20
        self.assertIn(f"the cells of layer.0 (clay) where water drains, {cell:.3g} m high", result.stderr)
        self.assertIn(f"within 2 % only from 1.5 h2/c = {1.5 * cell**2 / self.C:.3g} s after", result.stderr)
        self.assertRegex(result.stderr, r"Set layer.0.cell_size to \S+ m or less, or analysis.first_time to \S+ s or")

    def test_a_load_at_once_in_a_dynamic_run(self):
        shaken = CLAY.split("[analysis]")[0] + '[analysis]\nduration = "0.1 s"\n'
        bound = f"1.5 h2/c = {1.5 * 0.8**2 / self.C:.3g} s after the load on"
        for changes, warns in (((), True), (settings(load__ramp="1e8 s"), False),
                               (settings(load__direction="x"), False),
                               (settings(layer__0__permeability="0 m/s"), False)):
            result = self.run_column(self.write("shaken.toml", shaken), "-o", "out", "--overwrite", *changes)
            self.assert_done(result)
            self.assertEqual(bound in result.stderr, warns, changes)

    def test_the_skin_of_a_harmonic_load(self):
        shaken = CLAY.split("[analysis]")[0].replace('"step"', '"harmonic"\nfrequency = "2 Hz"')
        scene = self.write("harmonic.toml", shaken + '[analysis]\nduration = "0.02 s"\n')
        skin = np.sqrt(self.C / (np.pi * 2))
        for changes, warns in (((), True), (settings(load__frequency="1e-8 Hz"), False),
                               (settings(load__direction="x"), False),
                               (settings(layer__0__permeability="0 m/s"), False),
                               (settings(water__drainage="undrained"), False)):
            result = self.run_column(scene, "-o", "out", "--overwrite", *changes)
            self.assert_done(result)
            self.assertEqual(f"sqrt(2 c/omega) = {skin:.3g} m" in result.stderr, warns, changes)
            if warns:
                self.assertIn("the cells of layer.0 (clay) where water drains, 0.8 m high, do not show", result.stderr)
                self.assertIn(f"Set layer.0.cell_size to {0.37 * skin:.2g} m or less, or disregard pore pressures "
                              "within three cells, 2.4 m, of", result.stderr)


    def test_figures_know_the_drained_base(self):
        """Terzaghi's series next to the figures is that of half the thickness."""
        scene = self.write("both.toml", CLAY.replace("20000 d", "2000 d"))
        self.assert_done(self.run_app("soil_column", scene, "-o", "both", "-q",
                                      *settings(water__base="drained", layer__0__cell_size="0.2 m")))
        log = (self.folder / "both/figures.log").read_text(encoding="utf-8")
        found = [float(number) for number in re.findall(r"largest difference from Terzaghi's series (\S+)", log)]
        self.assertEqual(len(found), 2, log)  # pore pressure, settlement
        self.assert_below(max(found), 0.02, "20 steps in time; one-way drainage is off by 1")


class Water(ColumnTest):
    def run_scene(self, name, folder, *options):
        result = self.run_column(SCENES / f"{name}.toml", "-o", folder, "--quiet", *options)
        self.assert_done(result)
        return history(self.folder / folder), self.summary_of(folder), result.stdout

    def test_sand_expands_under_a_cap_after_the_shaking(self):
        rows, summary, text = self.run_scene("silt_cap", "cap")
        (cap,) = summary["expansions"]
        self.assertEqual((cap["below"], cap["depth"]), ("silt", 2))
        self.assertIn(f"{1e3 * cap['largest']:.3f} mm of water below silt (2.00 m)", text)
        self.assert_near(rows["expansion_0"].max(), cap["largest"], 1e-12, "digits of the history")
        self.assertGreater(cap["largest_time"], 10, "the shaking ends at 5 s")
        # liquefied sand: the gradient is (rho - rho_f)/rho_f, and what k i brings from below the silt keeps out
        rise = np.interp([6, 12], rows["time"], rows["expansion_0"])
        self.assert_near((rise[1] - rise[0]) / 6, 0.9 * (1e-3 - 1e-6), 0.05e-3,
                         "r_u is not quite 1, and the silt's own pressure changes")
        late = rows["time"] > 20
        self.assertLess(rows["d0_eps_zz"][late].max(), 0, "just below the silt: expanded")
        self.assertGreater(rows["d2_eps_zz"][late].min(), 0, "at 7 m: compressed")
        # from the profiles: in an element of degree 2 two Gauss points, each of half of its height, are exact
        with h5py.File(self.folder / "cap/profiles.h5") as file:
            depth, time, strain = (np.asarray(file[name]) for name in ("depth", "time", "eps_zz"))
        sand = depth > 2
        expanded = np.cumsum(-strain[:, sand] * 0.25, axis=1)[:, 1::2].max(axis=1).clip(0)
        found = np.interp(time, rows["time"], rows["expansion_0"])
        self.assert_below(np.abs(expanded - found).max() / found.max(), 0.02,
                          "the largest sum may be that of a node in the middle of an element")

    def test_no_cap_no_expansion(self):
        rows, summary = self.rows_of(SOIL)
        self.assertEqual(summary["expansions"], [], "the lower layer is the less permeable one")
        self.assertFalse([name for name in rows if name.startswith("expansion")])
        _, summary, _ = self.run_scene("silt_cap", "dry_cap", *settings(water__table="2 m", analysis__duration="0.5 s"))
        self.assertEqual(summary["expansions"], [], "above the water table no water gathers")

    def test_an_undrained_column_follows_its_base_along_z(self):
        text = SOIL.replace('axis = "y"', 'axis = "z"').replace('"coupled"', '"undrained"')
        rows, summary = self.rows_of(text, "rigid")
        self.assertIn("moves the column as a rigid body", summary["warnings"][-1])
        self.assertGreater(np.abs(rows["input_az"]).max(), 0.1)
        self.assertEqual(rows["surface_az"].tobytes(), rows["input_az"].tobytes())

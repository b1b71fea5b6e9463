# SPDX-License-Identifier: BSD-3-Clause
"""soil_column with a box of soil between walls whose surface is inclined: what it leaves, on how many ranks and after
which restarts."""
import functools
import json
import re
import shutil
import signal

import h5py
import numpy as np

from column_support import ColumnTest, settings
from figures.column_results import Column
from report import column_tables

BOX = """title = "slope in a box"
[mesh]
dimension = 2
width = "12 m"
cells_across = 6
sides = "walls"
ground_x = ["0 m", "12 m"]
ground_z = ["3.6 m", "2.4 m"]
[water]
drainage = "coupled"
[[layer]]
name = "sand"
thickness = "3.6 m"
cells = 3
density = "1950 kg/m3"
permeability = "1e-4 m/s"
material = "iwan"
reference_pressure = "100 kPa"
k0 = 0.5
shear_velocity = "140 m/s"
[[motion]]
axis = "x"
kind = "harmonic"
amplitude = "0.2 g"
frequency = "2 Hz"
duration = "2 s"
ramp = "0.5 s"
[analysis]
duration = "2 s"
safety = 0.5
[output]
depths = ["0.5 m", "2 m"]
profile_interval = "0.1 s"
paraview_interval = "1 s"
"""
SHARED = re.sub(r"(profile|paraview)_interval.*\n", "", BOX)  # what a mesh on several ranks can leave
DISTRIBUTED = settings(mesh__distributed="true")
MOTION = tuple(f"surface_motion.{key}" for key in ("along_x", "largest", "settlement", "heave"))


def gmsh_text(across, up, move):
    """A mesh of Gmsh of the unit square whose corners are moved to where `move` says; one layer, "sand"."""
    tag = {(i, k): 1 + i + (across + 1) * k for k in range(up + 1) for i in range(across + 1)}
    nodes = ["{} {!r} {!r} 0".format(number, *move(i / across, k / up)) for (i, k), number in tag.items()]
    base, surface = ([(1, 1 + row, ((i, up * row), (i + 1, up * row))) for i in range(across)] for row in (0, 1))
    low, high = ([(1, 3 + side, ((across * side, k), (across * side, k + 1))) for k in range(up)] for side in (0, 1))
    cells = [(3, 5, ((i, k), (i + 1, k), (i + 1, k + 1), (i, k + 1))) for k in range(up) for i in range(across)]
    elements = ["{} {} 2 {} 1 {}".format(number, kind, group, " ".join(str(tag[corner]) for corner in corners))
                for number, (kind, group, corners) in enumerate(base + surface + low + high + cells, 1)]
    names = ["1 1 \"base\"", "1 2 \"surface\"", "1 3 \"x_low\"", "1 4 \"x_high\"", "2 5 \"sand\""]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "5", *names, "$EndPhysicalNames",
                      "$Nodes", str(len(nodes)), *nodes, "$EndNodes", "$Elements", str(len(elements)), *elements,
                      "$EndElements", ""])


def extruded(text, width):
    """That mesh, one element of this width along y, in 3D."""
    def rows(name):
        lines = text.split(f"${name}\n")[1].split(f"$End{name}")[0].splitlines()[1:]
        return [[float(number) for number in line.split()] for line in lines]

    nodes = rows("Nodes")
    elements = []
    for _, kind, _, group, _, *corners in rows("Elements"):
        low, high = ([int(corner) + side * len(nodes) for corner in corners] for side in (0, 1))
        if kind == 3:
            elements += [(5, 5, low + high), (3, 6, low), (3, 7, high)]
        else:
            elements.append((3, int(group), low + high[::-1]))
    names = ["2 1 \"base\"", "2 2 \"surface\"", "2 3 \"x_low\"", "2 4 \"x_high\"", "3 5 \"sand\"", "2 6 \"y_low\"",
             "2 7 \"y_high\""]
    places = [f"{int(tag) + side * len(nodes)} {x!r} {side * width} {z!r}" for side in (0, 1) for tag, x, z, _ in nodes]
    return "\n".join(["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "7", *names, "$EndPhysicalNames",
                      "$Nodes", str(len(places)), *places, "$EndNodes", "$Elements", str(len(elements)),
                      *[" ".join(str(word) for word in (number, kind, 2, group, 1, *corners))
                        for number, (kind, group, corners) in enumerate(elements, 1)], "$EndElements", ""])


class Box(ColumnTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("box.toml", BOX)

    def maps(self, name):
        with h5py.File(self.folder / name / "maps.h5") as file:
            return {key: np.asarray(values) for key, values in file.items()}

    def test_what_it_leaves(self):
        rows, summary = self.rows_of(BOX)
        moved = summary["surface_motion"]
        self.assertEqual(moved["x"], 6)
        self.assertGreater(moved["along_x"], 0.005, "it flows down the slope, towards +x")
        self.assertGreater(moved["settlement"], 0.002)
        self.assertLess(moved["settlement_x"], 6, "it sinks at the upper end")
        self.assertGreater(moved["heave_x"], 6, "and rises at the lower one")
        self.assert_near(rows["d0_depth"][0], 0.5, 0.4, "the nearest of points 0.6 m apart")
        maps = self.maps("run")
        n = 6 * 3
        self.assertEqual(maps["corner_x"].shape, (4 * n,))
        self.assertEqual(maps["ru"].shape, (len(maps["time"]), 9 * n))
        area = 0.0  # of polygons: corners go round each element anticlockwise
        for x, z in zip(maps["corner_x"].reshape(-1, 4), maps["corner_z"].reshape(-1, 4)):
            part = 0.5 * np.sum(x * np.roll(z, -1) - np.roll(x, -1) * z)
            self.assertGreater(part, 0)
            area += part
        self.assert_near(area, 12 * 3, 1e-9, "round-off")
        walls = np.isin(maps["corner_x"], (0, 12))
        self.assertEqual(np.abs(maps["displacement_x"][:, walls]).max(), 0)
        base = maps["corner_z"] == 0
        self.assertEqual(np.abs(maps["displacement_z"][:, base]).max(), 0)
        text = (self.folder / "run/summary.txt").read_text(encoding="utf-8")
        self.assertRegex(text, r"surface moved +\+0\.\d+ m along x at x = 6 m")

    def test_refined_elements(self):
        """Nodes that hang are where their neighbours are, in maps, too; the same bits on any number of ranks."""
        short = settings(analysis__duration="0.3 s")
        refine = '[[refine]]\nfrom = ["3.5 m", "0.9 m"]\nto = ["8.5 m", "4 m"]\nlevels = 2\n'
        self.scene = self.write("refined.toml", BOX + refine)
        done = self.run_column(self.scene, "-o", "run", *short)
        self.assert_done(done)
        maps = self.maps("run")
        self.assertEqual(len(maps["corner_x"]), 4 * 102)
        self.assertRegex(done.stderr, r"\d+ unknowns\n")
        text = (self.folder / "run/summary.txt").read_text(encoding="utf-8")
        waves = re.search(r"waves carried +sand: elements of (\S+) m", text)
        self.assertEqual(float(waves[1]), 2)  # of the 12 m in 6, that are not halved
        places = np.round(np.stack([maps["corner_x"], maps["corner_z"]]), 9)
        u = maps["displacement_x"][-1]
        self.assertGreater(np.abs(u).max(), 1e-4)
        for k, (x, z) in enumerate(places.T):
            same = (places == [[x], [z]]).all(axis=0)
            self.assertTrue((u[same] == u[k]).all() or np.ptp(u[same]) < 1e-15, (x, z))
        self.check_ranks(*settings(analysis__duration="0.1 s"))

    def test_refined_elements_are_shared_out_and_meet_free_fields(self):
        refine = '[[refine]]\nfrom = ["3.5 m", "0.9 m"]\nto = ["8.5 m", "4 m"]\nlevels = 2\n'
        self.scene = self.write("shared.toml", SHARED + refine)
        self.check_shared_mesh((2,), MOTION, 1e-7, *DISTRIBUTED, *settings(analysis__duration="0.3 s"))
        level = re.sub(r"(ground_.|profile_interval|paraview_interval) = .*\n", "", BOX)
        level = level.replace('[analysis]\nduration = "2 s"\nsafety = 0.5',
                              '[analysis]\nduration = "0.5 s"\ntime_step = "0.2 ms"')
        band = '[[refine]]\nfrom = ["0 m", "1.2 m"]\nto = ["12 m", "2.4 m"]\n'
        for water, motion in (("dry", "0.2 g"), ("coupled", "0.01 g")):
            scene = level.replace("coupled", water).replace("0.2 g", motion) + band
            (free, _), (tied, _) = (self.rows_of(scene.replace("walls", sides), water + sides)
                                    for sides in ("free-field", "tied"))
            largest = np.abs(tied["surface_ux"]).max()
            self.assertGreater(largest, 1e-5)
            for name in ("surface_ux", "surface_uz"):
                self.assert_near(free[name], tied[name], 1e-9 * largest,
                                 f"round-off: the columns at the sides have the elements of the band ({water}, {name})")

    def test_at_rest_it_stays_still_bit_for_bit(self):
        rows, summary = self.rows_of(re.sub(r"\[\[motion\]\][^\[]*", "", BOX))
        self.check_stress_in_situ()
        self.assertEqual(summary["surface_motion"]["largest"], 0)
        self.assertGreater(np.abs(rows["d1_tau_xz"][0]), 10, "the slope has a static shear stress")
        for name in ("surface_ux", "surface_uz", "d0_u", "d1_u"):
            self.assertEqual(np.abs(rows[name]).max(), 0, name)

    def test_a_level_box_far_from_its_walls_is_a_column(self):
        level = re.sub(r"ground_. = .*\n", "", BOX).replace('"12 m"', '"120 m"').replace("cells_across = 6",
                                                                                       "cells_across = 30")
        level = level.replace("safety = 0.5", 'time_step = "0.5 ms"')
        box, _ = self.rows_of(level.replace('sides = "walls"', 'sides = "walls"\npoints = 2'), "level")
        column, _ = self.rows_of(re.sub(r"\[mesh\][^\[]*", "", level), "column")
        self.assert_near(box["surface_ux"], column["surface_ux"], 0.07 * np.abs(column["surface_ux"]).max(),
                         "walls, fifteen depths away, and liquefied sand, which magnifies what little comes from there")

    def test_a_mesh_of_a_file_and_solvers_by_options_find_the_same(self):
        short = settings(analysis__duration="0.3 s")
        self.assert_done(self.run_column(self.scene, "-o", "run", *short))
        in_a_box = self.maps("run")
        self.write("slope.msh", gmsh_text(6, 3, lambda x, z: (12 * x, z * (3.6 - 1.2 * x))))
        text = re.sub(r"(width|cells_across|ground_.|thickness|cells) = .*\n", "", BOX)
        self.scene = self.write("drawn.toml", text.replace('sides =', 'file = "slope.msh"\nsides ='))
        options = "-statics_pc_type gamg -water_pc_type hypre -water_ksp_type bcgs"
        self.assert_done(self.run_column(self.scene, "-o", "drawn", *short, "--petsc", options, "--no-figures"))
        drawn = self.maps("drawn")
        for name in ("corner_x", "corner_z", "sigma_v0", "displacement_x", "u", "gamma_xz"):
            self.assert_near(drawn[name], in_a_box[name], 1e-6 * np.abs(in_a_box[name]).max(),
                             f"solutions to 1e-10, and Newton's tolerance of 1e-6 where it settles ({name})")
        summary = json.loads((self.folder / "drawn/summary.json").read_text(encoding="utf-8"))
        self.assertEqual(summary["linear_solver"], "bcgs, hypre")
        self.assertGreater(summary["linear_iterations"], summary["linear_solutions"])
        table = column_tables.layers(Column(self.folder / "drawn"))  # whose layers lie at no one depth
        self.assertNotIn("Depth (m)", table)
        self.assertIn(f"{summary['layers'][0]['in_situ_shear_velocity']:.4g}", table)
        self.assertEqual(summary["settling_linear_solver"], "gmres, gamg")
        self.assertRegex((self.folder / "drawn/summary.txt").read_text(encoding="utf-8"), r"of settling +gmres, gamg: ")
        self.assert_refused(self.run_column(self.scene, "-o", "typo", *short, "--petsc", "-water_ksp_typ gmres"),
                            "-water_ksp_typ has no effect")
        self.assert_refused(self.run_column(self.scene, "-o", "typo", *short, "--petsc", "ksp_type gmres"),
                            "error: --petsc: analysis.petsc = ksp_type gmres; has the word ksp_type")
        for options, what in (("-water_ksp_type preonly -water_pc_type jacobi", "solves nothing"),
                              ("-water_pc_type jacobi -water_ksp_rtol 10",
                               "must be (below|non-negative and less than) 1")):
            done = self.run_column(self.scene, "-o", "none", *short, "--petsc", options)
            self.assert_refused(done)
            self.assertRegex(done.stderr, what)  # newer versions of PETSc refuse the second in their own words
        self.scene = self.write("shared.toml", self.scene.read_text(encoding="utf-8").replace("profile_interval", "#")
                                .replace("paraview_interval", "#"))
        self.check_shared_mesh((2,), MOTION, 1e-7, *DISTRIBUTED, *short)

    def test_a_strip_of_a_block_is_plane(self):
        """Hexahedra between smooth walls at both sides, too: the same equations as in 2D."""
        mesh = gmsh_text(6, 3, lambda x, z: (12 * x, z * (3.6 - 1.2 * x)))
        self.write("plane.msh", mesh)
        self.write("block.msh", extruded(mesh, 2.0))
        text = re.sub(r"(width|cells_across|ground_.|thickness|cells|safety) = .*\n", "", BOX)
        text = text.replace('[analysis]\nduration = "2 s"\n', '[analysis]\nduration = "0.3 s"\ntime_step = "0.5 ms"\n')
        (plane, _), (block, summary) = (
            self.rows_of(text.replace("sides =", f'file = "{name}.msh"\nsides =').replace(
                "dimension = 2", f"dimension = {dimension}"), name) for name, dimension in (("plane", 2), ("block", 3)))
        for name in ("surface_ux", "surface_uz", "d0_u", "d1_tau_xz"):
            self.assert_near(block[name], plane[name], 1e-6 * np.abs(plane[name]).max(),
                             f"Newton's tolerance of 1e-6 where the soil settles ({name})")
        self.assertGreater(np.abs(plane["d0_u"]).max(), 10)
        self.assertEqual(summary["elements"], 18)

    def test_ranks_are_alike_bit_for_bit(self):
        self.check_ranks(*settings(analysis__duration="0.2 s"))

    def test_one_mesh_over_ranks(self):
        self.scene = self.write("shared.toml", SHARED)
        self.check_shared_mesh((4,), MOTION, 1e-7, *DISTRIBUTED, *settings(analysis__duration="0.2 s"))

    def test_a_shared_mesh_continues_on_other_ranks(self):
        scene = self.write("shared.toml", SHARED)
        options = DISTRIBUTED + settings(analysis__duration="0.4 s", output__checkpoint="1e-9 min")
        self.assert_done(self.run_column(scene, "-o", "whole", *options))
        last = self.folder / "parts/checkpoint/last.h5"
        for n, then in ((1, 2), (3, 1)):
            shutil.rmtree(self.folder / "parts", ignore_errors=True)  # its checkpoint is none of the next run
            code, said = self.stop_when(last.exists, last, signal.SIGUSR1,
                                        self.command_on_ranks(n, scene, "-o", "parts", *options))
            self.assertEqual(code, 130, said)
            self.assert_done(self.run_on_ranks(then, scene, "-o", "parts", "--resume", *options))
            self.check_numbers("whole", "parts", MOTION, 1e-7)

    def check_stress_in_situ(self):
        """That of the theory."""
        maps = self.maps("run")
        inner = (maps["x"] > 4) & (maps["x"] < 8)
        vertical = 9.81 * 950 * maps["depth"]
        self.assert_near(maps["sigma_v0"], vertical, 1e-6 * vertical.max(), "round-off")
        shear = 0.5 * 0.1 * vertical  # K0 of the inclination 1.2 m in 12 m
        self.assert_near(maps["tau_xz"][0][inner], shear[inner], 0.25 * shear.max(),
                         "second order of the inclination, and what the walls leave one depth away")

    def test_a_surcharge_beyond_what_the_soil_bears_is_reported(self):
        weak = BOX.replace('"iwan"', '"mohr_coulomb"\nfriction_angle = "25 deg"\ndilatancy_angle = "0 deg"')
        strip = '[load]\nsurcharge = "{} kPa"\nsurcharge_from = "4 m"\nsurcharge_to = "6 m"\n'
        bears = self.run_column(self.write("bears.toml", weak + strip.format(2)), "-o", "bears", "--quiet",
                                *settings(analysis__duration="0.1 s"))
        self.assert_done(bears)
        fails = self.run_column(self.write("fails.toml", weak + strip.format(2000)), "-o", "fails", "--quiet")
        self.assertEqual(fails.returncode, 1)
        for words in ("does not settle under its weight and the surcharge", "no equilibrium",
                      "more than the soil bears"):
            self.assertIn(words, fails.stderr)
        self.assertFalse((self.folder / "fails/history.csv").exists())

    def test_a_sliver_of_an_element_is_named_by_its_time_step(self):
        sliver = BOX.replace('["3.6 m", "2.4 m"]', '["3.6 m", "0.001 m"]').replace('"2 m"]', '"1 m"]')
        result = self.run_column(self.write("sliver.toml", sliver), "-o", "sliver", "--quiet",
                                 *settings(analysis__time_step="0.1 ms"))
        self.assertEqual(result.returncode, 2)
        self.assertIn("the stable step of the stiffest element", result.stderr)

    def test_continues_where_it_was_stopped(self):
        self.assert_goes_on(self.scene, signal.SIGKILL, resume=functools.partial(self.run_on_ranks, 2))


class FreeField(ColumnTest):
    """A slope of sand on rock, and level ground."""

    SLOPE = (BOX.replace('"walls"', '"free-field"').replace(
        '"0 m", "12 m"', '"0 m", "4 m", "8 m", "12 m"').replace('"3.6 m", "2.4 m"', '"3 m", "3 m", "3.6 m", "3.6 m"')
             + '[base]\nkind = "compliant"\ndensity = "2300 kg/m3"\nshear_velocity = "500 m/s"\n')

    def test_level_ground_is_a_column(self):
        level = re.sub(r"ground_. = .*\n", "", self.SLOPE).replace("safety = 0.5", 'time_step = "0.4 ms"')
        box, summary = self.rows_of(level, "level")
        column, _ = self.rows_of(re.sub(r"\[mesh\][^\[]*", "[mesh]\npoints = 3\n", level), "column")
        self.assertGreater(summary["max_ru"], 0.5)
        for name, share in (("surface_ux", 1e-4), ("surface_uz", 1e-2)):
            self.assert_near(box[name], column[name], share * np.abs(column[name]).max(),
                             "Newton's tolerance of the soil that settles, which sand that liquefies magnifies")

    def test_ranks_and_restarts(self):
        scene = self.scene = self.write("slope.toml", self.SLOPE)
        options = settings(analysis__duration="0.3 s")
        self.assert_goes_on(scene, signal.SIGKILL, *options, resume=functools.partial(self.run_on_ranks, 2))
        rows, _ = self.rows_of(re.sub(r"\[\[motion\]\][^\[]*", "", self.SLOPE), "rest")
        self.assertEqual(np.abs(rows["surface_ux"]).max(), 0, "bit for bit")
        self.scene = self.write("shared.toml", re.sub(r"(profile|paraview)_interval.*\n", "", self.SLOPE))
        self.check_shared_mesh((2,), MOTION, 1e-7, *DISTRIBUTED, *options)

    def test_a_mesh_of_a_file_finds_the_same(self):
        short = settings(analysis__duration="0.3 s")
        self.assert_done(self.run_column(self.write("slope.toml", self.SLOPE), "-o", "in_a_box", *short))
        self.write("slope.msh", gmsh_text(6, 3, lambda x, z: (12 * x, z * (3 + 0.6 * min(max(3 * x - 1, 0), 1)))))
        text = re.sub(r"(width|cells_across|ground_.|thickness|cells) = .*\n", "", self.SLOPE)
        drawn = self.write("drawn.toml", text.replace("sides =", 'file = "slope.msh"\nsides ='))
        self.assert_done(self.run_column(drawn, "-o", "drawn", *short))
        self.check_numbers("in_a_box", "drawn", MOTION, 1e-5)

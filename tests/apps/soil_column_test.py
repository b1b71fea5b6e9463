# SPDX-License-Identifier: BSD-3-Clause
"""soil_column as a user runs it: its scenes, what a row holds, mistakes."""
import re
import shlex
import signal

import h5py
import numpy as np

from column_support import ColumnTest, SCENES, SOIL, settings, history
from support import contents


class Scenes(ColumnTest):
    def run_scene(self, name, *options):
        result = self.run_column(SCENES / f"{name}.toml", "-o", name, "--quiet", *options)
        self.assert_done(result)
        self.assert_no_warning(result)
        folder, summary = self.folder / name, self.summary_of(name)
        self.assertIn((folder / "summary.txt").read_text(encoding="utf-8"), result.stdout)
        for file in ("scene.toml", "provenance.txt", "history.csv", "history.h5", "profiles.h5", "checkpoint/last.h5"):
            self.assertTrue((folder / file).exists(), file)
        return summary, history(folder), folder

    def test_uniform_layer(self):
        dt, digits = 4e-4, "digits that are written of one number"
        summary, rows, folder = self.run_scene("uniform_layer", *settings(
            analysis__duration="2 s", analysis__time_step=f"{dt} s", output__history_interval=f"{dt} s",
            output__profile_interval="0.1 s", output__paraview_interval="1 s"))
        self.assert_below(summary["relative_energy_residual"], 1e-10, "round-off of the work of 5,000 steps")
        self.assertEqual(len(rows["time"]), 5001)
        # all of a row is of one instant: central differences in time, Hooke's law at the points
        u, v, a = rows["surface_ux"], rows["surface_vx"], rows["surface_ax"] - rows["base_ax"]
        self.assert_close((u[2:] - 2 * u[1:-1] + u[:-2]) / dt**2, a[1:-1], 1e-6,
                          "a second difference of displacements of cm, known to 1e-17 m, over dt^2")
        self.assert_close((u[2:] - u[:-2]) / (2 * dt), v[1:-1], 1e-9, "a difference of displacements of cm over dt")
        self.assert_close(rows["d0_tau_xz"], 1900 * 200**2 * rows["d0_gamma_xz"], 1e-9,
                          "round-off of increments that are added up")
        self.assert_close(rows["base_ax"], rows["input_ax"], 1e-12, "round-off of an interpolation")
        self.assert_near(summary["peak_surface"], np.abs(rows["surface_ax"]).max(), 5e-13, digits)
        with h5py.File(folder / "profiles.h5") as file:
            self.assertEqual(file["gamma_xz"].shape, (21, 80))
            self.assert_close(file["sigma_v0"], 1900 * 9.81 * np.asarray(file["depth"]), 1e-12,
                              "round-off of a sum over the depth")
            self.assert_close(file["shear_velocity"], np.full(80, 200.0), 1e-12, "round-off of G = rho V_s^2")
            self.assertTrue((np.diff(file["depth"]) > 0).all())
            self.assert_close(np.asarray(file["time"]), 0.1 * np.arange(21), 1e-12, "round-off of times")
            self.assertEqual(file["node_depth"][-1], 20)
            self.assert_near(file["peak_gamma"][()].max(), summary["peak_gamma"], 5e-16, digits)
            self.assert_near(file["peak_acceleration"][0], summary["peak_surface"], 5e-13, digits)
            self.assert_near(file["peak_acceleration"][-1], summary["peak_input"], 5e-13, digits)
            node = {name: file[f"node_{name}"][()] for name in ("displacement_x", "velocity_x", "displacement_z")}
            at = np.searchsorted(rows["time"], file["time"][()] - 1e-9)
            self.assert_close(node["displacement_x"][:, 0], rows["surface_ux"][at], 1e-9, "digits of the history")
            self.assert_close(node["velocity_x"][:, 0], rows["surface_vx"][at], 1e-9, "digits of the history")
            self.assertEqual(node["displacement_x"].shape, (21, len(file["node_depth"])))
            self.assertFalse(node["displacement_x"][:, -1].any(), "the base is what they count from")
            self.assert_close(file["peak_displacement"][0], np.abs(u).max(), 1e-9, "digits of the history")
            self.assert_close(file["peak_velocity"][0], np.abs(v).max(), 1e-4, "half a step from a row")
            for name in ("velocity", "displacement"):
                self.assert_near(file[f"peak_{name}"][()].max(), summary[f"peak_{name}"], 5e-13, digits)
                at = list(file["node_depth"]).index(summary[f"peak_{name}_depth"])
                self.assertEqual(file[f"peak_{name}"][at], summary[f"peak_{name}"])
        vtu = (folder / "paraview/column_00002.vtu").read_text(encoding="utf-8")
        self.assertIn('NumberOfPoints="120" NumberOfCells="80"', vtu)  # an element of degree 2 is two lines
        self.assertEqual((folder / "paraview/column.pvd").read_text(encoding="utf-8").count("<DataSet"), 3)

    def test_the_command_is_what_a_shell_takes(self):
        arguments = [self.write("a scene.toml", SOIL), "-o", "out", "-q", *settings(
            title="Kramer's; $HOME", analysis__duration="0.1 s")]
        self.assert_done(self.run_column(*arguments))
        command = (self.folder / "out/provenance.txt").read_text(encoding="utf-8").splitlines()[0]
        self.assertEqual(shlex.split(command.removeprefix("command")),
                         self.command("soil_column", *arguments, "--no-figures"))

    def test_two_layers_compliant(self):
        summary, rows, _ = self.run_scene("two_layers_compliant", *settings(analysis__duration="2 s"))
        self.assertEqual(summary["base"], "compliant")
        self.assertGreater(summary["amplification"], 2)
        self.assertGreater(np.abs(rows["base_ax"] - rows["input_ax"]).max(), 0.1)

    def test_recorded_motion_liquefies(self):
        summary, rows, folder = self.run_scene("recorded_motion", *settings(analysis__duration="6 s"))
        self.assertIn("x and y as a vector", (folder / "summary.txt").read_text(encoding="utf-8"))
        self.assert_close(np.hypot(rows["surface_ax"], rows["surface_ay"]).max(), summary["peak_surface"], 0.2,
                          "rows are a part of the steps, peaks are of all")
        self.assertGreater(summary["max_ru"], 0.95)
        self.assertLess(summary["max_ru_depth"], 8)
        # undrained: vertical total stress does not change
        self.assert_close(rows["d1_sigma_v"] + rows["d1_u"], np.full_like(rows["d1_u"], rows["d1_sigma_v"][0]), 1e-9,
                          "round-off of increments that are added up")
        self.assert_close(rows["d1_ru"], rows["d1_u"] / rows["d1_sigma_v"][0], 1e-12, "round-off of a quotient")
        self.assertEqual(np.abs(rows["settlement"]).max(), 0)

    def test_terzaghi(self):
        summary, rows, folder = self.run_scene("terzaghi", *settings(analysis__steps=200))
        solved = "a direct solution: round-off times the condition of the system"
        steps = "second order in 200 steps and 40 elements"
        # c = kb/S, S = 1/D + n/K_f; degree of consolidation as settlement, pressure at the base
        compliance, storage = 1 / 100e6, 0.33 / 2.2e9
        t_v = rows["time"] * 1e-6 / 9810 / (compliance + storage) / 10**2
        b = (np.arange(400)[:, None] + 0.5) * np.pi
        degree = 1 - (2 / b**2 * np.exp(-b**2 * t_v)).sum(axis=0)
        p0 = 100e3 * compliance / (compliance + storage)
        final, at_once = 100e3 * 10 * compliance, (100e3 - p0) * 10 * compliance
        self.assertEqual(rows["time"][0], 0)
        self.assert_near(rows["settlement"][0], at_once, 5e-10, solved)
        late = t_v > 0.01
        self.assert_close(rows["settlement"][late], (at_once + degree * (final - at_once))[late], 1e-3, steps)
        self.assert_near(summary["final_settlement"], final, 5e-10, solved)
        self.assert_near(summary["degree_of_consolidation"], degree[-1], 5e-4, steps)
        depth = summary["depths"][1]
        base = p0 * (2 / b * np.sin(b * depth / 10) * np.exp(-b**2 * t_v)).sum(axis=0)
        self.assert_close(rows["d1_u"][late], base[late], 1e-3, steps)
        self.assertIsNone(summary["max_ru"], "the load, not the earth, carries the pressure")
        self.assertNotIn("largest r_u", (folder / "summary.txt").read_text(encoding="utf-8"))
        with h5py.File(folder / "profiles.h5") as file:
            self.assertEqual(file["u"].shape, (201, 116), "40 elements, 18 more where water drains")
            self.assertEqual(file["time"][()].tobytes(), rows["time"].tobytes())


class Mistakes(ColumnTest):
    def refuse(self, parts, *arguments, text=None):
        """Refused, and older results are all there."""
        old = self.folder / "out"
        if not old.exists():
            old.mkdir()
            (old / "scene.toml").write_text("# old", encoding="utf-8")
            (old / "provenance.txt").write_text("old", encoding="utf-8")
            (old / "history.csv").write_text("precious", encoding="utf-8")
        before = contents(old)
        scene = self.write("changed.toml", text) if text else self.scene
        result = self.run_column(scene, "-o", "out", *(arguments or ("--overwrite",)))
        self.assert_refused(result, *parts)
        self.assertEqual(contents(old), before)

    def test_scene(self):
        text = SOIL.replace("cells = 4", "cells = 4\npermeabilty = 3", 1)
        line = 1 + text.splitlines().index("permeabilty = 3")
        self.refuse([f"changed.toml:{line}:", "permeabilty", "permeability"], text=text)

    def test_scene_of_another_program(self):
        for program, scene, right in (("element_test", SCENES / "terzaghi.toml", "soil_column"),
                                      ("soil_column", SCENES.parent / "drained_dr64.toml", "element_test")):
            result = self.run_app(program, scene, "-o", "other")
            self.assert_refused(result, f"is a scene of {right}", f"Run it with: {right} {scene}")
            self.assertFalse((self.folder / "other").exists())

    def test_more_steps_than_can_be_counted(self):
        self.refuse(["analysis.duration = 1e+17 s: must be at most ", "because the time step is "], "--overwrite",
                    *settings(analysis__duration="1e17 s"))

    def test_steps_without_end_are_announced(self):
        scene = self.write("thin.toml", SOIL)
        command = self.command("soil_column", scene, "-o", "thin", *settings(analysis__time_step="1e-4 ms"))
        said = self.stop_when((self.folder / "thin/history.csv").exists, "files", signal.SIGTERM, command)[1]
        self.assertRegex(said, r"warning: the run has \S+e\+\d+ time steps of 1e-07 s, .* of layer\.0, are \S+ m high")

    def test_time_step_above_the_stable_one(self):
        self.refuse(["time step", "must be <=", "Give a smaller one"], "--overwrite",
                    *settings(analysis__time_step="10 ms"))

    def test_elements_too_long(self):
        self.write("soil.toml", SOIL.replace('reference_pressure = "100 kPa"\n', ""))
        short = settings(analysis__duration="0.1 s", motion__0__frequency="40 Hz", layer__0__material="elastic")
        result = self.run_column(self.scene, "-o", "low", "-q", *short)
        self.assert_done(result)
        self.assert_no_warning(result, "12 nodes in a wave of 25 Hz; what is faster is of no interest")
        short += settings(analysis__highest_frequency="40 Hz")
        result = self.run_column(self.scene, "-o", "out", "-q", *short)
        self.assert_done(result)
        words = re.search(r"warning: (the elements of layer.0 \(sand\) are too long for the shortest wave of interest: "
                          r"(\S+) nodes in \S+ m \(150 m/s at 40 Hz\), 10 are needed. Set layer.0.cells to (\d+) "
                          r"or .*)",
                          result.stderr)
        self.assertIsNotNone(words, result.stderr)
        self.assert_near(float(words[2]), 2 * 150 / 40, 0.05, "cells of 1 m, degree 2; digits of the message")
        self.assertIn(words[1], result.stdout)
        self.assertEqual(self.summary_of("out")["warnings"][-1], words[1])
        result = self.run_column(self.scene, "-o", "fine", "-q", *short, *settings(layer__0__cells=words[3],
                                                                                   layer__1__cells=4 * int(words[3])))
        self.assert_done(result)
        self.assert_no_warning(result)

    def test_stress_beyond_the_strength(self):
        self.refuse(["layer.0.k0 = 0.2", "strength_ratio of 0.990"], "--overwrite", *settings(layer__0__k0=0.2))

    def test_folder(self):
        result = self.run_column(self.scene, "-o", "out", *settings(analysis__duration="0.1 s"))
        self.assert_done(result)
        self.assertIn("x and y as a vector", result.stdout, "there are two motions")
        self.refuse(["the results folder exists", "--overwrite", "--resume"], "--quiet")
        self.refuse(["another scene", "scene.toml"], "--resume", *settings(layer__1__thickness="5 m"))

    def test_options(self):
        self.assert_refused(self.run_app("soil_column"), "no scene given", "--help")
        self.assertEqual(self.run_column(self.scene, "--overwite").returncode, 2)
        self.assertIn("[analysis]", self.run_app("soil_column", "--print-manual").stdout)
        self.assertIn("[analysis]", self.run_app("soil_column", self.scene, "--validate").stdout)

    def test_failure_names_step_time_and_checkpoint(self):
        result = self.run_column(SCENES / "recorded_motion.toml", "-o", "out", "--quiet", *settings(
            analysis__safety=0.99, layer__2__contraction=0, layer__2__dilation=1, motion__0__peak="1 g",
            output__checkpoint="1e-9 min"))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertRegex(result.stderr, r"step \d+ \(t = [\d.]+ s\): unstable: .*\n.*last good checkpoint: out/check")

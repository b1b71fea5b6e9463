#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""soil_column as a user runs it: its scenes, what a row holds, mistakes, kills, ranks."""
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess

import h5py
import numpy as np

from support import AppTest, BIN, contents, main

os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OPENBLAS_NUM_THREADS="1",
                  OMP_NUM_THREADS="1")
SCENES = pathlib.Path(__file__).resolve().parents[2] / "apps/scenes/column"

SOIL = """title = "sand over clay"
[water]
drainage = "coupled"
[[layer]]
name = "sand"
thickness = "3 m"
cells = 3
permeability = "1e-4 m/s"
material = "iwan"
shear_velocity = "150 m/s"
[[layer]]
thickness = "4 m"
cells = 4
permeability = "1e-6 m/s"
material = "elastic"
shear_velocity = "200 m/s"
[[motion]]
axis = "x"
kind = "harmonic"
amplitude = "0.1 g"
frequency = "3 Hz"
duration = "60 s"
ramp = "1 s"
[[motion]]
axis = "y"
kind = "ricker"
amplitude = "0.05 g"
frequency = "4 Hz"
[analysis]
duration = "1 s"
[output]
depths = ["1 m", "5 m"]
"""
NO_FILES = {"provenance.txt"}  # time of the run, number of ranks


def settings(**values):
    """--set section__key=value ..., with a dot for two underscores."""
    return [part for key, value in values.items() for part in ("--set", f"{key.replace('__', '.')}={value}")]


def history(folder):
    with h5py.File(folder / "history.h5") as file:
        return {name: np.asarray(values) for name, values in file["history"].items()}


class ColumnTest(AppTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("soil.toml", SOIL)

    def run_column(self, *arguments):
        return self.run_app("soil_column", *arguments, "--no-figures")

    def run_on_ranks(self, n, *arguments):
        command = ["mpirun", "--oversubscribe", "-n", str(n), *self.command("soil_column", *arguments, "--no-figures")]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=120, check=False)

    def assert_same_files(self, one, other):
        """All files the same: HDF5 item by item, anything else byte by byte. Checkpoints come when the clock says."""
        def names(folder):
            return {n for n in contents(self.folder / folder) if n not in NO_FILES and not n.startswith("checkpoint")}
        self.assertEqual(names(one), names(other))
        for name in names(one):
            a, b = self.folder / one / name, self.folder / other / name
            if name.endswith(".h5"):
                self.assert_same_h5(a, b)
            else:
                self.assertEqual(a.read_bytes(), b.read_bytes(), name)


class Scenes(ColumnTest):
    def run_scene(self, name, *options):
        result = self.run_column(SCENES / f"{name}.toml", "-o", name, "--quiet", *options)
        self.assert_done(result)
        self.assertEqual(result.stderr, "")
        folder = self.folder / name
        summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
        self.assertIn((folder / "summary.txt").read_text(encoding="utf-8"), result.stdout)
        for file in ("scene.toml", "provenance.txt", "history.csv", "history.h5", "profiles.h5", "checkpoint/last.h5"):
            self.assertTrue((folder / file).exists(), file)
        return summary, history(folder), folder

    def test_uniform_layer(self):
        dt = 4e-4
        summary, rows, folder = self.run_scene("uniform_layer", *settings(
            analysis__duration="2 s", analysis__time_step=f"{dt} s", output__history_interval=f"{dt} s",
            output__profile_interval="0.1 s", output__paraview_interval="1 s"))
        self.assertLess(summary["relative_energy_residual"], 1e-10)
        self.assertEqual(len(rows["time"]), 5001)
        # all of a row is of one instant: central differences in time, Hooke's law at the points
        u, v, a = rows["surface_ux"], rows["surface_vx"], rows["surface_ax"] - rows["base_ax"]
        self.assert_close((u[2:] - 2 * u[1:-1] + u[:-2]) / dt**2, a[1:-1], 1e-6)
        self.assert_close((u[2:] - u[:-2]) / (2 * dt), v[1:-1], 1e-9)
        self.assert_close(rows["d0_tau_xz"], 1900 * 200**2 * rows["d0_gamma_xz"], 1e-9)
        self.assert_close(rows["base_ax"], rows["input_ax"], 1e-12)
        self.assertAlmostEqual(summary["peak_surface"], np.abs(rows["surface_ax"]).max(), 12)
        with h5py.File(folder / "profiles.h5") as file:
            self.assertEqual(file["gamma_xz"].shape, (21, 80))
            self.assert_close(file["sigma_v0"], 1900 * 9.81 * np.asarray(file["depth"]), 1e-12)
            self.assertTrue((np.diff(file["depth"]) > 0).all())
            self.assert_close(np.asarray(file["time"]), 0.1 * np.arange(21), 1e-12)
            self.assertEqual(file["node_depth"][-1], 20)
            self.assertAlmostEqual(file["peak_gamma"][()].max(), summary["peak_gamma"], 15)
            self.assertAlmostEqual(file["peak_acceleration"][0], summary["peak_surface"], 12)
            self.assertAlmostEqual(file["peak_acceleration"][-1], summary["peak_input"], 12)
        vtu = (folder / "paraview/column_00002.vtu").read_text(encoding="utf-8")
        self.assertIn('NumberOfPoints="120" NumberOfCells="80"', vtu)  # an element of degree 2 is two lines
        self.assertEqual((folder / "paraview/column.pvd").read_text(encoding="utf-8").count("<DataSet"), 3)

    def assert_close(self, one, other, relative):
        one, other = np.asarray(one), np.asarray(other)
        self.assertEqual(one.shape, other.shape)
        self.assertLess(np.abs(one - other).max(), relative * np.abs(other).max())

    def test_two_layers_compliant(self):
        summary, rows, _ = self.run_scene("two_layers_compliant", *settings(analysis__duration="2 s"))
        self.assertEqual(summary["base"], "compliant")
        self.assertGreater(summary["amplification"], 2)
        self.assertGreater(np.abs(rows["base_ax"] - rows["input_ax"]).max(), 0.1)

    def test_recorded_motion_liquefies(self):
        summary, rows, _ = self.run_scene("recorded_motion", *settings(analysis__duration="6 s"))
        self.assertGreater(summary["max_ru"], 0.95)
        self.assertLess(summary["max_ru_depth"], 8)
        # undrained: vertical total stress does not change
        self.assert_close(rows["d1_sigma_v"] + rows["d1_u"], np.full_like(rows["d1_u"], rows["d1_sigma_v"][0]), 1e-9)
        self.assert_close(rows["d1_ru"], rows["d1_u"] / rows["d1_sigma_v"][0], 1e-12)
        self.assertEqual(np.abs(rows["settlement"]).max(), 0)

    def test_terzaghi(self):
        summary, rows, folder = self.run_scene("terzaghi", *settings(analysis__steps=200))
        # c = kb/S, S = 1/D + n/K_f; degree of consolidation as settlement, pressure at the base (fem_references A.4)
        compliance, storage = 1 / 100e6, 0.33 / 2.2e9
        t_v = rows["time"] * 1e-6 / 9810 / (compliance + storage) / 10**2
        b = (np.arange(400)[:, None] + 0.5) * np.pi
        degree = 1 - (2 / b**2 * np.exp(-b**2 * t_v)).sum(axis=0)
        p0 = 100e3 * compliance / (compliance + storage)
        final, at_once = 100e3 * 10 * compliance, (100e3 - p0) * 10 * compliance
        self.assertEqual(rows["time"][0], 0)
        self.assertAlmostEqual(rows["settlement"][0], at_once, 9)
        late = t_v > 0.01
        self.assert_close(rows["settlement"][late], (at_once + degree * (final - at_once))[late], 1e-3)
        self.assertAlmostEqual(summary["final_settlement"], final, 9)
        self.assertAlmostEqual(summary["degree_of_consolidation"], degree[-1], 3)
        depth = summary["depths"][1]
        base = p0 * (2 / b * np.sin(b * depth / 10) * np.exp(-b**2 * t_v)).sum(axis=0)
        self.assert_close(rows["d1_u"][late], base[late], 1e-3)
        with h5py.File(folder / "profiles.h5") as file:
            self.assertEqual(file["u"].shape, (201, 80))
            self.assertEqual(file["time"][()].tobytes(), rows["time"].tobytes())


class Mistakes(ColumnTest):
    def refuse(self, parts, *arguments, text=None):
        """Refused, and older results are all there."""
        old = self.folder / "out"
        if not old.exists():
            old.mkdir()
            (old / "scene.toml").write_text("# old", encoding="utf-8")
            (old / "history.csv").write_text("precious", encoding="utf-8")
        before = contents(old)
        scene = self.write("changed.toml", text) if text else self.scene
        result = self.run_column(scene, "-o", "out", *(arguments or ("--overwrite",)))
        self.assert_refused(result, *parts)
        self.assertEqual(contents(old), before)

    @staticmethod
    def changed(old, new):
        assert old in SOIL
        text = SOIL.replace(old, new, 1)
        line = next(n for n, part in enumerate(text.splitlines(), 1) if new.splitlines()[-1] in part)
        return text, f"changed.toml:{line}:"

    def test_scene(self):
        for old, new, *parts in (
                ('thickness = "3 m"', 'thickness = "0 m"', "layer.0.thickness", "must be > 0 m"),
                ('permeability = "1e-6 m/s"', 'permeability = "-1e-6 m/s"', "layer.1.permeability", "must be >= 0"),
                ('cells = 4', 'cells = 4\npermeabilty = 3', "permeabilty", "permeability")):
            text, where = self.changed(old, new)
            self.refuse([where, *parts], text=text)

    def test_motion_file(self):
        text = SOIL.replace('kind = "ricker"\namplitude = "0.05 g"\nfrequency = "4 Hz"',
                            'kind = "record"\nfile = "record.txt"')
        self.refuse(["changed.toml:", "motion.1.file", "is not there"], text=text)
        for rows, *parts in ((["0 0", "0.01 1", "0.05 2", "0.06 1"], "record.txt:3:"),
                             (["0 0", "0.01 zero", "0.02 1"], "record.txt:2:", "zero")):
            self.write("record.txt", "\n".join(rows) + "\n")
            self.refuse(parts, text=text)

    def test_time_step_above_the_stable_one(self):
        self.refuse(["time step", "must be <=", "Give a smaller one"], "--overwrite",
                    *settings(analysis__time_step="10 ms"))

    def test_stress_beyond_the_strength(self):
        self.refuse(["layer.0 (sand)", "k0"], "--overwrite", *settings(layer__0__k0=0.2))

    def test_distributed(self):
        strip = settings(mesh__dimension=2, mesh__distributed="true")
        self.refuse(["profile_interval", "distributed"], "--overwrite", *strip,
                    *settings(output__profile_interval="1 s"))
        self.refuse(["cannot be resumed", "distributed"], "--resume", *strip)

    def test_folder(self):
        self.assert_done(self.run_column(self.scene, "-o", "out", *settings(analysis__duration="0.1 s")))
        self.refuse(["the results folder exists", "--overwrite", "--resume"], "--quiet")
        self.refuse(["another scene", "scene.toml"], "--resume", *settings(layer__1__thickness="5 m"))

    def test_options(self):
        self.assert_refused(self.run_app("soil_column"), "no scene given", "--help")
        self.assertEqual(self.run_column(self.scene, "--overwite").returncode, 2)
        printed = self.run_app("soil_column", "--print-manual").stdout
        self.assertEqual(printed, (SCENES.parents[2] / "docs/column_scene_reference.md").read_text(encoding="utf-8"))
        self.assertIn("[analysis]", self.run_app("soil_column", self.scene, "--validate").stdout)

    def test_failure_names_step_time_and_checkpoint(self):
        result = self.run_column(SCENES / "recorded_motion.toml", "-o", "out", "--quiet", *settings(
            analysis__safety=0.99, layer__2__contraction=0, layer__2__dilation=1, motion__0__amplitude="1 g",
            output__checkpoint="1e-9 min"))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertRegex(result.stderr, r"step \d+ \(t = [\d.]+ s\): unstable: .*\n.*last good checkpoint: out/check")


class Resume(ColumnTest):
    """A run that is killed and resumed leaves the same files."""

    OPTIONS = settings(analysis__duration="50 s", output__profile_interval="0.1 s", output__paraview_interval="2 s",
                       output__checkpoint="1e-9 min")

    def interrupt(self, with_signal, wanted, *more):
        arguments = [self.scene, *self.OPTIONS, *more]
        begin = os.times().elapsed
        self.assert_done(self.run_column(*arguments, "-o", "whole"))
        seconds = os.times().elapsed - begin
        moments, codes = random.Random(20240229), []
        started = (self.folder / "parts/checkpoint/last.h5", True)
        for resume in ([], ["--resume"], ["--resume"]):
            codes.append(self.run_and_stop(moments.uniform(0.02, 0.25) * seconds, with_signal, started, *arguments,
                                           "-o", "parts", *resume, program="soil_column"))
        self.assertEqual(codes[0], wanted)
        return arguments

    def finish(self, arguments):
        self.assert_done(self.run_column(*arguments, "-o", "parts", "--resume"))
        self.assert_same_files("whole", "parts")

    def test_sigterm(self):
        self.finish(self.interrupt(signal.SIGTERM, 130, *settings(water__drainage="undrained",
                                                                  water__lagged_compressibility="true")))

    def test_sigkill_and_a_damaged_checkpoint(self):
        arguments = self.interrupt(signal.SIGKILL, -signal.SIGKILL)
        checkpoints = self.folder / "parts/checkpoint"
        for name in ("fresh.h5", "last.h5"):
            if (checkpoints / name).exists():
                (checkpoints / name).write_bytes((checkpoints / name).read_bytes()[:3000])
        self.finish(arguments)


    def test_consolidation(self):
        options = [SCENES / "terzaghi.toml", *settings(analysis__steps=60, output__checkpoint="1e-9 min")]
        self.assert_done(self.run_column(*options, "-o", "whole"))
        started = (self.folder / "parts/checkpoint/last.h5", True)
        code = self.run_and_stop(0.02, signal.SIGTERM, started, *options, "-o", "parts", program="soil_column")
        self.assertIn(code, {0, 130})
        self.finish(options)


class MPIRanks(ColumnTest):
    def test_replicated_to_the_bit(self):
        options = settings(output__profile_interval="0.05 s", output__paraview_interval="0.5 s")
        results = [self.run_on_ranks(n, self.scene, "-o", f"on{n}", *options) for n in (1, 2, 3)]
        for n, result in enumerate(results, 1):
            self.assert_done(result)
            self.assertEqual(result.stdout.count("peak shear strain"), 1)
            self.assert_same_files("on1", f"on{n}")
            self.assertEqual(len(re.findall("time step .* stable up to", result.stderr)), 1)

    def test_distributed(self):
        options = settings(mesh__dimension=2, mesh__distributed="true", mesh__width="4 m", mesh__cells_across=3,
                           analysis__duration="0.5 s")
        rows = {}
        for n in (1, 2, 3):
            self.assert_done(self.run_on_ranks(n, self.scene, "-o", f"on{n}", *options))
            rows[n] = history(self.folder / f"on{n}")
            self.assertFalse((self.folder / f"on{n}/profiles.h5").exists())
            for name in ("surface_ax", "surface_ay", "surface_vx", "surface_ux", "surface_uz", "d0_tau_xz", "d0_u",
                         "max_ru", "min_p_ratio", "external"):
                scale = np.abs(rows[1][name]).max()
                self.assertGreater(scale, 0, name)
                self.assertLess(np.abs(rows[n][name] - rows[1][name]).max(), 1e-10 * scale, name)

    def test_failure_on_all_ranks(self):
        shutil.copy(self.scene, self.folder / "out")  # a file
        result = self.run_on_ranks(2, self.scene, "-o", "out")
        self.assertEqual(result.stderr.count("error: "), 1)
        self.assertIn("not a folder", result.stderr)
        self.assertEqual(result.returncode, 2)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: BSD-3-Clause
"""A column from Python whose layers have materials that are written in Python."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import numpy as np

from package import BINARIES, ToleranceTest, isostat
from isostat import column

SCENE = """title = "a pulse"
[water]
drainage = "dry"
[[layer]]
name = "sand"
thickness = "5 m"
cells = 5
material = "user"
[[layer]]
name = "clay"
thickness = "5 m"
cells = 5
material = "elastic"
shear_velocity = "150 m/s"
[[motion]]
kind = "ricker"
amplitude = "1 m/s2"
frequency = "4 Hz"
[analysis]
duration = "1.2 s"
viscosity = "0.1 ms"
[output]
history_interval = "0.01 s"
"""
CONSOLIDATION = """title = "a fill on sand and clay"
[water]
drainage = "coupled"
[[layer]]
name = "sand"
thickness = "5 m"
cells = 5
permeability = "1e-7 m/s"
material = "user"
[[layer]]
name = "clay"
thickness = "5 m"
cells = 5
permeability = "1e-9 m/s"
material = "elastic"
shear_velocity = "150 m/s"
[load]
kind = "step"
amplitude = "10 kPa"
[analysis]
kind = "consolidation"
first_time = "10 s"
last_time = "100 d"
steps = 20
"""
SHEAR, POISSON = 2000 * 200.0**2, 0.3


def elastic_stiffness():
    lame = 2 * SHEAR * POISSON / (1 - 2 * POISSON)
    stiffness = np.diag([2 * SHEAR] * 3 + [SHEAR] * 3)
    stiffness[:3, :3] += lame
    return stiffness


class Elastic(column.Material):
    tangent = elastic_stiffness()

    def initial(self, stress):
        return {"stress": stress.copy()}

    def update(self, state, gradient):
        stress = state["stress"] + column.strain(gradient) @ self.tangent
        return stress, {"stress": stress}

    def stiffness(self, state):
        return np.broadcast_to(self.tangent, (len(state["stress"]), 6, 6))


class Hyperbolic(Elastic):
    """Softens with shear strain: tau = G gamma / (1 + |gamma| / gamma_r), gamma_r = 2e-4."""

    def update(self, state, gradient):
        strained, state = super().update(state, gradient)
        stress = strained.copy()
        stress[:, 3:5] /= 1 + np.abs(stress[:, 3:5]) / (SHEAR * 2e-4)
        return stress, state


class Interrupts(Hyperbolic):
    calls = 0

    def __init__(self, last):
        self.last = last

    def update(self, state, gradient):
        self.calls += 1
        if self.calls == self.last:
            os.kill(os.getpid(), signal.SIGINT)
        return super().update(state, gradient)


class Forgets(Elastic):
    """Keeps the array that it is given, without a copy."""

    def initial(self, stress):
        return {"stress": stress}


class HoldsOn(Elastic):
    """Never ends on its own after the first signal."""

    def update(self, state, gradient):
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGINT)
        while True:
            time.sleep(0.01)


class ColumnTest(ToleranceTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = column.ColumnScene(SCENE)

    def run_with(self, law, name, **options):
        return column.run(self.scene, self.folder / name, materials={"sand": law}, **options)

    def run_program(self):
        """The column with an elastic layer instead, by soil_column."""
        scene = self.folder / "elastic.toml"
        scene.write_text(SCENE.replace('"user"', '"elastic"\nshear_velocity = "200 m/s"'), encoding="utf-8")
        folder = self.folder / "program"
        subprocess.run([BINARIES / "soil_column", scene, "--output", folder, "--quiet", "--no-figures"], check=True,
                       capture_output=True)
        return scene, folder

    def test_elastic_is_that_of_the_program(self):
        program = isostat.read(self.run_program()[1]).history
        ours = self.run_with(Elastic(), "python").history
        self.assertEqual(list(ours), list(program))
        self.assertGreater(np.max(np.abs(program["surface_ax"])), 1)
        self.assert_near(np.max(np.abs(ours["surface_ax"] - program["surface_ax"])), 0, 1e-9, "m/s2, rounding")

    def test_what_is_taken_out_of_a_site_response(self):
        """Methods of the results; their numbers are tested in tests/apps/site_response_test.py."""
        results = column.run(self.scene, self.folder / "out", materials={"sand": Elastic()}, quiet=True)
        a, dt = results.motion()
        self.assertEqual((len(a), round(dt, 9)), (121, 0.01))
        self.assertEqual(results.intensity()["PGA"], np.abs(a).max())
        self.assertEqual(results.profile["PGA"][0].round(6), round(results.summary["peak_surface"], 6))
        self.assertEqual([len(values) for values in results.spectrum("input", "x", [0.1, 1.0])], [2, 2, 2])
        self.assertEqual(results.site()["height"], 10)
        self.assertIsNone(results.resistance())
        self.assertGreater(results.first_frequency(), 1)
        results.write_at2(self.folder / "surface.at2")
        self.assertIn("NPTS= 121, DT= 0.01 SEC", (self.folder / "surface.at2").read_text(encoding="ascii"))
        for call, message in ((lambda: results.motion(5.0), "depth = 5 m: must be one of output.depths"),
                              (lambda: results.transfer(over="outcrop"), "there is no outcrop motion")):
            with self.assertRaisesRegex(isostat.InputError, message):
                call()

    def test_without_own_material_it_has_the_bits_of_the_program(self):
        scene, program = self.run_program()
        ours = column.run(column.ColumnScene(scene), self.folder / "python")
        self.assertEqual((ours.folder / "history.csv").read_bytes(), (program / "history.csv").read_bytes())
        self.assertEqual(ours.scene, column.ColumnScene(scene).with_(**{"output.folder": ours.scene.folder}))
        self.assertEqual(ours.summary["points"], 20)

    def test_a_biaxial_block_of_own_material_is_the_closed_form(self):
        scene = column.ColumnScene(
            mesh={"dimension": 2, "degree": 1}, water={"drainage": "dry"},
            layer=[{"name": "sand", "thickness": "2 m", "cells": 2, "material": "user"}],
            analysis={"kind": "biaxial", "confinement": "50 kPa", "axial_strain": 0.001, "load_steps": 2})
        ours = column.run(scene, self.folder / "block", materials={"sand": Elastic()})
        modulus = 2 * SHEAR / (1 - POISSON)
        self.assert_close(ours.history["axial_stress"], 50e3 + modulus * ours.history["axial_strain"], 1e-9, "rounding")
        self.assertEqual(ours.program, "biaxial")

    def test_a_consolidation_cuts_its_elements_where_water_drains(self):
        scene = column.ColumnScene(CONSOLIDATION)
        sand = {**scene.to_dict()["layer"][0], "material": "elastic", "shear_velocity": "200 m/s"}
        built_in = scene.with_(layer=[sand, scene.to_dict()["layer"][1]])
        due = column.run(built_in, self.folder / "built_in", quiet=True)
        self.assertEqual(due.warnings, [])
        self.assertGreater(due.summary["points"], 80, "of 20 without cuts")
        ours = column.run(scene, self.folder / "ours", materials={"sand": Elastic()}, quiet=True)
        self.assertEqual((ours.warnings, ours.summary["points"]), ([], due.summary["points"]))
        self.assert_close(ours.history["settlement"], due.history["settlement"], 1e-9, "rounding")
        again = column.run(scene, self.folder / "ours", materials={"sand": Elastic()}, quiet=True, resume=True)
        self.assertEqual(again.summary["points"], due.summary["points"])

        class KnowsItsNumber(Elastic):
            tangent = elastic_stiffness() / 100

            def initial(self, stress):
                if len(stress) == 1:
                    raise ValueError("one point alone")
                return super().initial(stress)

        coarse = column.run(scene, self.folder / "coarse", materials={"sand": KnowsItsNumber()}, quiet=True)
        self.assertEqual(len(coarse.warnings), 1)
        self.assertRegex(coarse.warnings[0], r"the cells of layer\.0 \(sand\) where water drains, \S+ m high, show")

    def test_softening_is_more_than_proportional(self):
        scene, peaks = self.scene, []
        for factor in (1, 5):
            self.scene = scene.with_(**{"motion.0.amplitude": f"{factor} m/s2"})
            run = self.run_with(Hyperbolic(), f"times_{factor}")
            peaks.append(np.max(np.abs(run.history["surface_ux"])))
        self.assertGreater(peaks[1] / peaks[0], 5.5)
        self.assertTrue(run.draw("fig_motions"))

    def test_signals_stay_those_of_the_interpreter(self):
        """PETSc would leave the handlers of the system: no BrokenPipeError, no faulthandler. In a fresh interpreter."""
        program = ("import faulthandler, pathlib, sys; from isostat import column\n"
                   "def masks():\n"
                   "    words = pathlib.Path('/proc/self/status').read_text().split()\n"
                   "    return [int(words[words.index(k) + 1], 16) % 2**31 for k in ('SigCgt:', 'SigIgn:')]\n"
                   "faulthandler.enable(); before = masks()\n"
                   "column.run(column.ColumnScene(sys.argv[1]), sys.argv[2])\n"
                   "print(before, masks(), before == masks(), sep='; ')")
        scene, _ = self.run_program()
        result = subprocess.run([sys.executable, "-c", program, scene, self.folder / "fresh"], capture_output=True,
                                text=True, env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}, check=True)
        self.assertTrue(result.stdout.strip().endswith("True"), result.stdout)

    def test_interrupted_and_resumed_bit_for_bit(self):
        whole = self.run_with(Hyperbolic(), "whole")
        before = signal.getsignal(signal.SIGINT)
        with self.assertRaises(KeyboardInterrupt):
            self.run_with(Interrupts(200), "parts")
        self.assertEqual(signal.getsignal(signal.SIGINT), before)
        parts = self.run_with(Interrupts(0), "parts", resume=True)
        self.assertEqual((parts.folder / "history.csv").read_bytes(), (whole.folder / "history.csv").read_bytes())

    def test_a_second_interrupt_is_that_of_the_interpreter(self):
        with self.assertRaises(KeyboardInterrupt):
            self.run_with(HoldsOn(), "held")

    def test_a_law_may_keep_what_it_is_given(self):
        one, other = self.run_with(Elastic(), "copies").history, self.run_with(Forgets(), "keeps").history
        for name in one:
            np.testing.assert_array_equal(one[name], other[name], err_msg=name)

    def test_wave_moduli_of_an_isotropic_stiffness(self):
        found = Elastic().wave_moduli({"stress": np.zeros((2, 6))})
        p_modulus = 2 * SHEAR * (1 - POISSON) / (1 - 2 * POISSON)
        self.assert_near(np.max(np.abs(found / [p_modulus, SHEAR] - 1)), 0, 1e-9, "directions are searched to rounding")

    def test_members_of_an_ensemble(self):
        """The next seeds, as many as a point has packings, or the next draw; other layers stay."""
        grains = {"thickness": "2 m", "cells": 2, "material": "grains", "realisation": 1}
        scene = column.ColumnScene(SCENE).with_(**{"grains.library": "library.h5", "grains.realisations": 3}).to_dict()
        scene["layer"] = [grains, {**grains, "mixed_realisations": 4}, scene["layer"][1]]
        scene = column.ColumnScene(scene)
        self.assertEqual(scene.member(0), scene)
        layers, before = scene.member(2).to_dict()["layer"], scene.to_dict()["layer"]
        self.assertEqual([layer.get("realisation") for layer in layers], [7, 1, None])
        self.assertEqual([layer.get("lot") for layer in layers], [0, 2, None])
        self.assertEqual(layers[2], before[2])

    def test_mistakes(self):
        class Flat(Elastic):
            def update(self, state, gradient):
                return np.zeros(6), state

        class Breaks(Elastic):
            def update(self, state, gradient):
                stress, state = super().update(state, gradient)
                stress[4, 2] = np.nan
                return stress, state

        class Raises(Elastic):
            def update(self, state, gradient):
                raise ZeroDivisionError("of the user")

        class Alone(Elastic):
            def update(self, state, gradient):
                return super().update(state, gradient)[0]

        class Backwards(Elastic):
            tangent = -elastic_stiffness()

        class InPlace(Elastic):
            def update(self, state, gradient):
                state["stress"] += column.strain(gradient) @ self.tangent
                return state["stress"], state

        for law, error, message in [(Backwards(), isostat.InputError, r"wave moduli of point 0 are .* must be above 0"),
                                    (InPlace(), ValueError, "read-only"),
                                    (Flat(), isostat.InputError, r"must be an array of shape \(10, 6\), but has \(6\)"),
                                    (Breaks(), isostat.RunFailure, r"the stress of point 4 is not finite"),
                                    (Raises(), ZeroDivisionError, "of the user"),
                                    (Alone(), isostat.InputError, r"must return \(stress, state\)")]:
            with self.subTest(law), self.assertRaisesRegex(error, message):
                self.run_with(law, type(law).__name__)
        for materials, message in [({}, r'layer.0 \("sand"\).*none was given'),
                                   ({"sand": Elastic(), "mud": Elastic()}, '"mud"'),
                                   (5, "^materials: must be a dictionary of names of layers, but is 5"),
                                   ({"sand": 3}, "must be an isostat.column.Material")]:
            with self.subTest(message), self.assertRaisesRegex(isostat.InputError, message):
                column.run(self.scene, self.folder / "none", materials=materials)
        with self.assertRaisesRegex(isostat.InputError, "^threads: must be a whole number, 0 or more, but is 'two'"):
            self.run_with(Elastic(), "none", threads="two")
        with self.assertRaisesRegex(isostat.InputError, "^overwrite and resume exclude each other"):
            self.run_with(Elastic(), "none", overwrite=True, resume=True)
        with self.assertRaisesRegex(isostat.InputError, "^scene: must be an isostat.column.ColumnScene, but is 5"):
            column.run(5)
        with self.assertRaisesRegex(isostat.InputError, "^stiffness: must be an array of numbers, but is 'stiff'"):
            isostat._column.wave_moduli("stiff")
        self.assertEqual(list(self.folder.glob("none/*")), [])

    def test_the_program_says_where_a_user_material_comes_from(self):
        scene = self.folder / "user.toml"
        scene.write_text(SCENE, encoding="utf-8")
        run = subprocess.run([BINARIES / "soil_column", scene, "--output", self.folder / "none"], capture_output=True,
                             text=True, check=False)
        self.assertEqual(run.returncode, 2)
        self.assertIn("isostat.column.run(", run.stderr)

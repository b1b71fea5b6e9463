# SPDX-License-Identifier: BSD-3-Clause
"""Damping that does not depend on the frequency, and curves of modulus and damping, in the soil column."""
import signal

import numpy as np

from column_support import SCENES, ColumnTest, history, settings
from studies import column_cases as cases
from studies.column_layers import equivalent_linear
from studies.small_strain import published

HEIGHT, VELOCITY, DAMPING = 20.0, 200.0, 0.02
SCENE = """[mesh]
degree = 2
[water]
drainage = "dry"
[[layer]]
thickness = "20 m"
cells = 16
density = "1900 kg/m3"
k0 = 1.0
material = "{}"
shear_velocity = "200 m/s"
damping = 0.02
{}
[[motion]]
kind = "ricker"
amplitude = "0.001 m/s2"
frequency = "5 Hz"
interval = "1 ms"
[analysis]
viscosity = "0 ms"
duration = "36 s"
[output]
history_interval = "2 ms"
"""


def constant_q(frequency):
    """Transfer function of the layer on a rigid base, 1/cos(w H/V), with the modulus of a constant Q = 1/(2 D), whose
    velocity is given at 1 Hz: M = M_1 (i f)^(2 g)/|...|, g = atan(1/Q)/pi (Kjartansson 1979)."""
    exponent = np.arctan(2 * DAMPING) / np.pi
    velocity = VELOCITY * (1j * frequency) ** exponent
    return 1 / np.cos(2 * np.pi * frequency * HEIGHT / velocity)


class Damping(ColumnTest):
    def test_transfer_function(self):
        """Elastic soil and sand at small strain: resonances of three modes, 2.5 to 13 Hz."""
        frequency = np.arange(1, 15, 0.01)
        exact = np.abs(constant_q(frequency))
        for material, keys in ("elastic", ""), ("iwan", "exponent = 0\ncontraction = 0\ndilation = 0"):
            rows, summary = self.rows_of(SCENE.format(material, keys), material)
            self.assert_below(summary["relative_energy_residual"], 1e-9, "round-off of 1e5 steps")
            self.assert_near(summary["layers"][0]["in_situ_shear_velocity"], VELOCITY, 1e-9, "round-off")
            mine = cases.amplification(rows, frequency)
            for mode in range(3):
                near = np.abs(frequency - (2.5 + 5 * mode) * (1 + 0.012 * mode)) < 1
                peak, peak_exact = mine[near].max(), exact[near].max()
                at, at_exact = (frequency[near][np.argmax(x[near])] for x in (mine, exact))
                self.assert_close(peak, peak_exact, 0.03, "a damping that ripples by 1.5 %, and waves at the end")
                self.assert_close(at, at_exact, 0.006, "steps of 0.01 Hz, dispersion")

    def test_resonances_without_a_word_on_viscosity(self):
        """Mass damping a_M in elastic soil, 1 % at the third mode, 12.5 Hz: |1/cos(kH)|, k = w sqrt(1 - i a_M/w)/V."""
        self.assert_done(self.run_column(SCENES / "uniform_layer.toml", "-o", "layer", "--quiet", *settings(
            output__profile_interval="10 s")))
        frequency = np.arange(1, 15, 0.005)
        w = 2 * np.pi * frequency
        exact = np.abs(1 / np.cos(w * np.sqrt(1 - 1j * (np.pi / 2) / w) * HEIGHT / VELOCITY))
        mine = cases.amplification(history(self.folder / "layer"), frequency)
        self.assert_close(mine, exact, 0.01, "dispersion in 40 elements, steps in time: 1e-4 of the frequency")
        self.assertEqual(self.summary_of("layer")["viscosity"], 0)

    def test_damping_comes_back_from_a_checkpoint(self):
        scene = self.write("curve.toml", SCENE.format("iwan", 'curve = "darendeli"\nunloading = "mrdf"\n'))
        self.assert_goes_on(scene, signal.SIGTERM, *settings(motion__0__amplitude="2 m/s2", analysis__duration="4 s"))

    def test_weak_motion_is_that_of_the_curve(self):
        """0.01 g on rock: the equivalent-linear method with the same curve."""
        text = cases.sand_scene(cases.RECORDED.format(0.0981), cells=40, elements=40, step=4e-4, rows=10, duration=15,
                                rock=cases.ROCK)
        pressure = cases.SURCHARGE + cases.DENSITY * cases.GRAVITY * cases.HEIGHT / 2
        text = text.replace("contraction = 0\ndilation = 0", 'curve = "darendeli"\nunloading = "mrdf"')
        rows, _ = self.rows_of(text)
        interval, n = rows["time"][1], 40
        layers, _ = cases.sand_layers(n, cases.ROCK)
        depth = (np.arange(n) + 0.5) * cases.HEIGHT / n
        p = cases.SURCHARGE + cases.DENSITY * cases.GRAVITY * depth
        scale = (p / pressure) ** 0.5  # of the strains of the curve: stress ~ p', stiffness ~ sqrt(p')

        def curve(strain):
            return published.darendeli(np.maximum(strain / scale, 1e-7), pressure)

        surface, _, _ = equivalent_linear(layers, curve, rows["input_ax"], interval)
        periods = np.geomspace(0.1, 2, 30)
        mine, other = (cases.response_spectrum(a, interval, periods) for a in (rows["surface_ax"], surface))
        self.assert_close(mine, other, 0.03, "one stiffness for all of a weak motion; V_s at 1 Hz, dispersion to 10 Hz")

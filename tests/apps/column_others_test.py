# SPDX-License-Identifier: BSD-3-Clause
"""The soil column against solutions that owe nothing to Isostat: studies/column_masing.py, studies/column_layers.py,
and the published example of the program nrattle (tests/reference/nrattle)."""
import numpy as np

from column_support import SCENES, ColumnTest, history, settings
from studies import column_cases as cases
from studies.column_layers import Layers, equivalent_linear, hyperbola
from studies.column_masing import Masing, ShearBeam


class Sand(ColumnTest):
    def test_rules_of_masing_by_hand(self):
        """The reference itself: a loop inside a loop inside the backbone."""
        law, f = Masing(1.0, 1.0), lambda x: x / (1 + abs(x))
        path = {2.0: f(2), -1.0: f(2) - 2 * f(1.5), 0.5: None, 0.0: None, 0.5001: None, -1.001: f(2) - 2 * f(1.5005),
                -2.5: f(-2.5)}
        path[0.5] = path[-1.0] + 2 * f(0.75)
        path[0.0] = path[0.5] - 2 * f(0.25)
        path[0.5001] = path[-1.0] + 2 * f(0.75005)  # the small loop is closed and forgotten
        for strain, stress in path.items():
            self.assert_near(law.to(np.array([strain]))[0], stress, 1e-14, "round-off of a few operations")

    def test_irregular_strain(self):
        """Stress of Gauss points under the strains that a record has given them, up to 0.8 %."""
        n = 128
        rows, summary = self.rows_of(cases.sand_scene(cases.RECORDED.format(8), cells=20, elements=n, step=8e-4,
                                                      duration=16))
        for k, depth in enumerate(summary["depths"]):
            strain, stress = rows[f"d{k}_gamma_xz"], rows[f"d{k}_tau_xz"]
            self.assertGreater(np.abs(strain).max(), 3e-3)
            exact, polygon = (Masing(*cases.sand(np.array([depth]))) for _ in range(2))
            modulus, strength = polygon.modulus[0], polygon.strength[0]
            nodes = cases.iwan_polygon(n)
            polygon.backbone = lambda x: np.sign(x) * strength * np.interp(np.abs(x) * modulus / strength, *nodes)
            for law, tolerance, reason in (
                    (exact, 0.004, "straight pieces instead of the hyperbola: 0.05 % of a backbone, more of loops"),
                    (polygon, 1e-10, "round-off: elements side by side obey Masing's rules (Iwan 1967)")):
                self.assert_close(stress, np.array([law.to(np.array([x]))[0] for x in strain]), tolerance, reason)

    def test_column(self):
        """Strains of 0.4 %, from the rest to the rest."""
        rows, _ = self.rows_of(cases.sand_scene(cases.HARMONIC.format(3), cells=40, step=4e-4))
        time, interval = rows["time"], rows["time"][1]
        at, surface, strain, _ = cases.sand_beam(120).run(time, rows["input_ax"], 2e-4, depths=(10.25, 19.75))
        self.assertGreater(np.abs(strain).max(), 4e-3)
        numerics = "a backbone in 128 pieces, 0.05 % off; waves as short as a cell, which nothing damps, are left out"
        pairs = [(rows["surface_ax"], surface), *((rows[f"d{k}_gamma_xz"], strain[k]) for k in range(2))]
        for mine, other in pairs:
            mine, other = (cases.low_passed(a, interval, 10) for a in (mine, np.interp(time, at, other)))
            self.assert_close(mine, other, 0.01, numerics)

    def test_hyperbola_of_equivalent_linear_soil(self):
        """Secant and damping against the loop that Masing's rules draw."""
        for strain in (1e-4, 0.02, 1.0, 30.0):
            law, path = Masing(1.0, 1.0), strain * np.cos(np.linspace(0, 2 * np.pi, 4001))
            stress = np.array([law.to(np.array([x]))[0] for x in path])
            work = np.sum((stress[1:] + stress[:-1]) / 2 * np.diff(path))
            secant, damping = hyperbola(strain)
            self.assert_close(secant, stress[0] / strain, 1e-12, "round-off")
            self.assert_close(damping, work / (2 * np.pi * strain * stress[0]), 1e-3, "a loop of 4,000 pieces")

    def test_small_strain(self):
        rows, _ = self.rows_of(cases.sand_scene(cases.RICKER, cells=40, elements=64, step=4e-4, rock=cases.ROCK))
        frequency = np.linspace(0.5, 10, 100)
        linear = np.abs(cases.sand_layers(40, cases.ROCK)[0].surface(frequency))
        self.assert_close(cases.amplification(rows, frequency), linear, 0.006, "dispersion in 40 linear elements")

    def test_equivalent_linear_limits(self):
        """Weak motion: the same. Strong motion: they part."""
        layers, reference = cases.sand_layers(40, cases.ROCK)
        periods, off = np.geomspace(0.1, 2, 30), []
        for peak in (0.001, 0.1, 3):
            rows, _ = self.rows_of(cases.sand_scene(cases.RECORDED.format(peak), cells=40, elements=64, step=4e-4,
                                                    rows=10, duration=15, rock=cases.ROCK), f"peak_{peak}")
            interval = rows["time"][1]
            surface, _, _ = equivalent_linear(layers, lambda x: hyperbola(x / reference), rows["input_ax"], interval)
            mine, other = (cases.response_spectrum(a, interval, periods) for a in (rows["surface_ax"], surface))
            off.append(np.abs(mine / other - 1).max())
        self.assert_below(off[0], 0.006, "dispersion in 40 linear elements")
        self.assert_below(off[1], 0.03, "strains of 3 % of the reference strain")
        self.assertGreater(off[2], 0.2, "one stiffness for all of a strong motion is another soil")


class Prenolin(ColumnTest):
    """Profile P1 of PRENOLIN (Regnier et al. 2016): the scene prenolin_p1."""
    HEIGHT, DENSITY, VELOCITY, REFERENCE_STRAIN = 20.0, 2000.0, 300.0, 3.65e-4
    ROCK = {"base__kind": "compliant", "base__density": "2000 kg/m3", "base__shear_velocity": "1000 m/s"}

    def rows_with(self, name, **changes):
        self.assert_done(self.run_column(SCENES / "prenolin_p1.toml", "-o", name, "--quiet", *settings(**changes)))
        return history(self.folder / name)

    def test_small_strain(self):
        """A weak pulse and damping of 1 %: 1/(cos kH + i a sin kH) of constant Q (Kjartansson 1979), a the ratio of
        impedances, 0 of a rigid base."""
        frequency = np.arange(1, 14, 0.005)
        velocity = self.VELOCITY * (1j * frequency) ** (np.arctan(0.02) / np.pi)
        angle = 2 * np.pi * frequency * self.HEIGHT / velocity
        weak = {"motion__0__amplitude": "1e-5 m/s2", "layer__0__damping": 0.01, "layer__0__elements": 12,
                "layer__0__cells": 20, "mesh__degree": 2, "output__history_interval": "2 ms", "output__depths": "[]"}
        rigid = cases.amplification(self.rows_with("rigid", **weak, analysis__duration="45 s"), frequency)
        exact = np.abs(1 / np.cos(angle))
        for mode in (3.8, 11.4):
            near = np.abs(frequency - mode) < 1
            self.assert_close(rigid[near].max(), exact[near].max(), 0.01, "a damping that ripples by 1.6 %")
            at, at_exact = (frequency[near][np.argmax(x[near])] for x in (rigid, exact))
            self.assert_close(at, at_exact, 0.001, "steps of 0.005 Hz, dispersion")
        elastic = cases.amplification(self.rows_with("elastic", **weak, **self.ROCK), frequency)
        exact = np.abs(1 / (np.cos(angle) + 1j * self.DENSITY * velocity / (2000 * 1000) * np.sin(angle)))
        self.assert_close(elastic, exact, 0.003, "dispersion; the radiation into the rock damps far more than the soil")

    def test_strong_motion(self):
        """1 m/s2 on a rigid base: strains of 0.043 %, above the reference strain, against the shear beam."""
        rows = self.rows_with("strong")
        time, interval = rows["time"], rows["time"][1]
        modulus = self.DENSITY * self.VELOCITY**2

        def soil(depth):
            return np.full(len(depth), modulus), np.full(len(depth), modulus * self.REFERENCE_STRAIN)
        at, surface, strain, _ = ShearBeam(self.HEIGHT, 80, self.DENSITY, soil).run(
            time, rows["input_ax"], 2e-4, (5.125, 15.125, 19.875))
        self.assertGreater(np.abs(strain).max(), 1.1 * self.REFERENCE_STRAIN)
        numerics = "a backbone in 128 pieces; waves as short as a cell, which nothing damps, are left out"
        pairs = [(rows["surface_ax"], surface), *((rows[f"d{k}_gamma_xz"], strain[k]) for k in range(3))]
        for mine, other in pairs:
            mine, other = (cases.low_passed(a, interval, 25) for a in (mine, np.interp(time, at, other)))
            self.assert_close(mine, other, 0.01, numerics)
        periods = np.geomspace(0.05, 2, 40)
        mine, other = (cases.response_spectrum(a, interval, periods) for a in (
            rows["surface_ax"], np.interp(time, at, surface)))
        self.assert_close(mine, other, 0.005, numerics)


class Published(ColumnTest):
    def test_layer_matrix(self):
        profile, frequency, amplification = cases.published()
        self.assertEqual(profile.shape, (400, 3))
        layers = Layers(*profile.T, rock=(3500.0, 2720.0))
        self.assert_near(np.abs(layers.surface(frequency)), amplification, 1e-4, "the five digits that are published")

    def test_column(self):
        """8 km of soil and rock in 206 layers, to 10 Hz; to 50 Hz in docs/results/column_others.md."""
        _, frequency, amplification = cases.published()
        cases.write_published(self.folder, 10)
        rows, _ = self.rows_of(cases.published_scene(self.folder, corner=10, per_wave=5, duration=9))
        low = (frequency > 0) & (frequency <= 10)
        off = np.abs(cases.amplification(rows, frequency[low]) / amplification[low] - 1)
        self.assert_below(off, 0.005, "five quadratic elements for the wave of 10 Hz")
        self.assert_below(np.median(off), 5e-4, "waves still in the ground after 9 s")

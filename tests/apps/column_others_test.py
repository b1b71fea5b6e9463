# SPDX-License-Identifier: BSD-3-Clause
"""The soil column against solutions that owe nothing to Isostat: studies/column_masing.py, studies/column_layers.py,
and the published example of the program nrattle (tests/reference/nrattle)."""
import numpy as np

from column_support import ColumnTest
from studies import column_cases as cases
from studies.column_layers import Layers, equivalent_linear, hyperbola
from studies.column_masing import Masing


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

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The soil column against solutions that owe nothing to Isostat (column_masing.py)."""
import json

import numpy as np

import column_cases as cases
from column_masing import Masing
from column_support import ColumnTest, history
from support import main


class OthersTest(ColumnTest):
    def rows_of(self, text, name="run"):
        result = self.run_column(self.write(f"{name}.toml", text), "-o", name, "--quiet")
        self.assert_done(result)
        folder = self.folder / name
        return history(folder), json.loads((folder / "summary.json").read_text(encoding="utf-8"))


class Sand(OthersTest):
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


if __name__ == "__main__":
    main()

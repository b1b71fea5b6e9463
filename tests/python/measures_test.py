# SPDX-License-Identifier: BSD-3-Clause
"""Measures of a packing from Python: they agree with each other and have a unit each."""

import numpy as np

from package import ToleranceTest, isostat, packing_in_cell


class MeasuresTest(ToleranceTest):
    @classmethod
    def setUpClass(cls):
        cls.packing = packing_in_cell()
        cls.measures = cls.packing.measures()

    def test_stress_and_fabric_are_those_of_the_history(self):
        self.assert_close(-np.trace(self.packing.stress()) / 3, self.measures["p_LW"], 1e-12, "round-off of three sums")
        fabric = self.packing.fabric()
        self.assert_near(np.trace(fabric), 1, 1e-12, "round-off")
        self.assert_near(np.diag(fabric), [self.measures[name] for name in ("Fxx", "Fyy", "Fzz")], 1e-12, "round-off")

    def test_the_network_is_counted_as_in_the_history(self):
        network = self.packing.network()
        for name, column in (("redundancy_index", "IR"), ("redundancy_index_eq2", "IR_eq2"),
                             ("constraints_of_a_contact", "IR_constraints"),
                             ("redundancy_index_without_twist", "IR_no_twist"),
                             ("redundancy_index_sliding", "IR_sliding"), ("coordination_number", "Z"),
                             ("neither", "f_NSR"), ("sliding", "f_S"), ("grains_without_contact", "N0")):
            self.assertEqual(network[name], self.measures[column], name)
        self.assertGreater(self.packing.anisotropies()["mean_normal_force"], 0)
        self.assertGreater(min(self.packing.stored_energy().values()), -1e-30)

    def test_the_redundancy_index_is_that_of_the_law(self):
        network = packing_in_cell(contact={"friction": "18 deg"}).network()
        self.assertEqual((network["constraints_of_a_contact"], network["isostatic_coordination_number"]), (3, 4))
        self.assertEqual(network["redundancy_index"], network["redundancy_index_sliding"])
        self.assertGreater(network["redundancy_index_eq2"], 1.9 * network["redundancy_index"], "moments count")
        self.assertEqual(self.packing.network()["redundancy_index"], self.packing.network()["redundancy_index_eq2"])
        sticking = [self.packing.network(yield_margin=margin)["neither"] for margin in (1e-9, 0.1, 0.5)]
        self.assertGreater(sticking[0], sticking[1])
        self.assertGreater(sticking[1], sticking[2])

    def test_every_measure_has_its_unit(self):
        self.assertEqual(set(isostat.measure_units()), set(self.measures))

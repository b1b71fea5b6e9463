# SPDX-License-Identifier: BSD-3-Clause
"""Solutions for collapse against published values, each other and their limits."""
import math

import numpy as np

import limit_loads as limit
from characteristics import Strip, bearing_capacity
from support import ToleranceTest

PRINTED = "the digits that are printed"


class Footing(ToleranceTest):
    def test_weightless(self):
        for degrees, n_q, n_c in ((10, 2.471, 8.345), (20, 6.399, 14.83), (30, 18.40, 30.14), (40, 64.20, 75.31)):
            phi = math.radians(degrees)
            self.assert_close(limit.surcharge_factor(phi), n_q, 5e-4, PRINTED)
            self.assert_close(limit.cohesion_factor(phi), n_c, 5e-4, PRINTED)
        self.assert_near(limit.cohesion_factor(1e-7), limit.cohesion_factor(0.0), 2e-6, "the limit, linear in phi")

    def test_characteristics_give_the_table(self):
        for degrees, (smooth, rough) in limit.WEIGHT_FACTORS.items():
            for is_rough, expected in ((False, smooth), (True, rough)):
                found = Strip(math.radians(degrees), is_rough).factor()
                self.assert_close(found, expected, 3e-3, "30 lines of the fan, and surcharge of 1e-5")

    def test_characteristics_converge_and_know_surcharge(self):
        coarse, fine = Strip(math.radians(30)), Strip(math.radians(30), fan=60, ratio=1.072, surcharge=1e-6)
        self.assert_close(fine.factor(), 7.653, 3e-4, "60 lines and the four digits of the table")
        self.assert_close(coarse.pressure(coarse.lines[0][-1])[0],
                          limit.surcharge_factor(math.radians(30)) * coarse.surcharge, 1e-12,
                          "at the edge there is surcharge alone: round-off")

    def test_cohesion_and_weight_together_bear_more_than_their_sum(self):
        phi, weight = math.radians(30), 16.677
        for rough in (False, True):
            found, fine = (bearing_capacity(phi, 1.0, weight, 2.0, rough, **lines)
                           for lines in ({}, {"fan": 90, "ratio": 1.047}))
            self.assert_close(found, fine, 1e-3, "three times as many lines")
            added = limit.cohesion_factor(phi) + weight * limit.weight_factor(phi, rough)
            self.assertTrue(1.1 < found / added < 1.2, (found, added))
            alone = bearing_capacity(phi, 1e-2, weight, 2.0, rough)
            self.assert_close(alone, weight * limit.weight_factor(phi, rough), 0.015, "cohesion of 1e-2 is not quite 0")

    def test_rough_strips_bear_more_but_not_twice(self):
        for smooth, rough in limit.WEIGHT_FACTORS.values():
            self.assertTrue(1.7 * smooth < rough < 2 * smooth)

    def test_between_the_angles(self):
        self.assert_close(limit.weight_factor(math.radians(30), True), 14.75, 1e-12, "an angle of the table")
        found = Strip(math.radians(27)).factor()
        self.assert_close(limit.weight_factor(math.radians(27), False), found, 0.01, "as documented")
        with self.assertRaisesRegex(ValueError, "must be in .20, 40. deg"):
            limit.weight_factor(math.radians(45), False)


class Trapdoor(ToleranceTest):
    def test_terzaghi(self):
        phi, weight = math.radians(35), 16e3
        shallow = limit.terzaghi_arching(phi, 2.0, 1e-4, weight)
        self.assert_close(shallow, weight * 1e-4, 1e-4, "shallow soil does not arch")
        deep = limit.terzaghi_arching(phi, 2.0, 100.0, weight)
        self.assert_close(deep, 2.0 * weight / (2 * math.tan(phi)), 1e-12, "deep soil arches all it can")
        self.assert_close(limit.terzaghi_arching(0.0, 2.0, 3.0, weight, cohesion=4e3, surcharge=5e3),
                          3 * weight - 2 * 4e3 * 3 / 2 + 5e3, 1e-12, "without friction the planes bear c: round-off")
        h = np.array([1.0, 1.0 + 1e-6])
        s = [limit.terzaghi_arching(phi, 2.0, x, weight, 0.7, 3e3, 9e3) for x in h]
        rate = weight - 2 * (3e3 + 0.7 * np.mean(s) * math.tan(phi)) / 2.0
        self.assert_close((s[1] - s[0]) / 1e-6, rate, 1e-7, "equilibrium of a slice: differences of 1e-6")

    def test_bounds_enclose(self):
        for degrees in (20, 30, 40):
            phi = math.radians(degrees)
            for height in (0.5, 1.0, 3.0, 10.0):
                low, high = limit.trapdoor_active_bounds(phi, 1.0, height, 16e3)
                for lateral in (limit.active_rankine(phi), limit.at_rest(phi), limit.krynine(phi), 1.0):
                    stress = limit.terzaghi_arching(phi, 1.0, height, 16e3, lateral)
                    self.assertTrue(low < stress < high, (degrees, height, lateral))
                self.assertLess(high, limit.trapdoor_passive_bound(phi, 1.0, height, 16e3))
        tall = 1 / (2 * math.tan(math.radians(30)))
        below, above = (limit.trapdoor_active_bounds(math.radians(30), 1.0, h, 1.0)[0] for h in (tall, tall + 1e-9))
        self.assert_near(below, above, 1e-12, "where the block closes, both forms agree")


class Wall(ToleranceTest):
    def test_smooth_walls_are_rankine_s(self):
        for degrees in (20, 30, 40):
            phi = math.radians(degrees)
            for passive, rankine in ((False, limit.active_rankine(phi)), (True, limit.passive_rankine(phi))):
                self.assert_close(limit.coulomb(phi, 0.0, passive), rankine, 1e-12, "round-off")
                self.assert_close(limit.stress_field(phi, 0.0, passive), rankine, 1e-12, "round-off")
            self.assertTrue(limit.active_rankine(phi) < limit.krynine(phi) < 1)

    def test_published(self):
        phi = math.radians(30)
        self.assert_close(limit.coulomb(phi, math.radians(20)) / math.cos(math.radians(20)), 0.297, 2e-3, PRINTED)
        self.assert_close(limit.coulomb(phi, math.radians(20), True) / math.cos(math.radians(20)), 6.105, 1e-3, PRINTED)
        self.assert_close(limit.stress_field(phi, phi, True), 5.03, 1e-3, "Lancellotta's table, " + PRINTED)

    def test_friction_of_the_wall_lowers_active_and_raises_passive_pressure(self):
        phi = math.radians(35)
        for passive, way in ((False, -1), (True, 1)):
            for solution in (limit.coulomb, limit.stress_field):
                values = [way * solution(phi, math.radians(d), passive) for d in (0, 10, 20, 30)]
                self.assertEqual(values, sorted(values), (solution, passive))
        self.assertGreater(limit.coulomb(phi, phi / 2, True), limit.stress_field(phi, phi / 2, True))

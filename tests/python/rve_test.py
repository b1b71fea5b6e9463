# SPDX-License-Identifier: BSD-3-Clause
"""The representative volume element from Python: strain in, stress out, there and back."""
import signal
import threading

import numpy as np

from package import ToleranceTest, isostat, packing_in_cell


class RveTest(ToleranceTest):
    @classmethod
    def setUpClass(cls):
        cls.packing, cls.other_packing = packing_in_cell(), packing_in_cell(200, "2.7 mm")

    def test_stress_follows_the_stiffness(self):
        rve = isostat.Rve(self.packing, min_steps=2000)
        before, stiffness = rve.stress, rve.stiffness()
        shear = np.zeros((3, 3))
        shear[0, 1] = 2e-6
        response = rve.undrained(shear)
        self.assertTrue(response)
        change = response.stress[0, 1] - before[0, 1]
        self.assert_near(change / (stiffness[5, 5] * 2e-6), 1, 0.2, "contacts that slide; the stiffness has none")
        np.testing.assert_array_equal(response.stress, rve.stress)

    def test_increments_are_taken_to_balance(self):
        shear = np.zeros((3, 3))
        shear[0, 1] = 2e-5
        still, moved = isostat.Rve(self.packing, increment=1e-5), isostat.Rve(self.packing)
        response = still.undrained(shear)
        self.assertTrue(response, response.reason)
        self.assertTrue(0 < response.balance <= 0.01)
        moved.undrained(shear)
        response = moved.relax(balance=1e-4, left_out=0)
        self.assertEqual(response.balance, response.worst_balance)
        self.assertTrue(0 < response.worst_balance <= 1e-4)
        target = 1.02 * still.stress
        response = still.mixed(np.zeros((3, 3)), target, np.ones((3, 3), bool))
        self.assertTrue(response, response.reason)
        self.assert_close(response.stress, target, 2e-3, "its tolerance, of p'")
        with self.assertRaisesRegex(isostat.InputError, "tolerance = 0"):
            moved.relax(balance=0)

    def test_a_saved_state_comes_back_bit_for_bit(self):
        rve = isostat.Rve(self.packing)
        strain = np.diag([5e-5, -1e-4, 5e-5])
        state = rve.save()
        first = rve.advance(strain).stress
        rve.restore(state)
        np.testing.assert_array_equal(rve.advance(strain).stress, first)
        with self.assertRaisesRegex(isostat.InputError, "the state is that of other grains"):
            isostat.Rve(self.other_packing).restore(state)
        other = isostat.Rve.unpack(rve.pack())
        np.testing.assert_array_equal(other.advance(strain).stress, rve.advance(strain).stress)

    def test_mixed_control_holds_its_stress(self):
        rve = isostat.Rve(self.packing)
        gradient, target = np.zeros((3, 3)), np.diag([rve.stress[k, k] for k in range(3)])
        gradient[1, 1] = -2e-4
        controlled = np.diag([True, False, True])
        response = rve.mixed(gradient, target, controlled)
        self.assertTrue(response, response.reason)
        self.assert_near(response.stress[0, 0] / target[0, 0], 1, 1.1e-3, "the tolerance of the control, of p'")
        self.assertLess(response.stress[1, 1], target[1, 1])  # more compression along y

    def test_what_stress_control_cannot_do_is_rejected_at_once(self):
        rve, none, every = isostat.Rve(self.packing), np.zeros((3, 3)), np.full((3, 3), True)
        before = rve.stress
        response = rve.mixed(none, np.diag([1e5, 0.0, 0.0]), np.diag([True, False, False]))
        self.assertRegex(response.reason, "1e[+]05 Pa for xx is tension.*neg")
        self.assertEqual((bool(response), response.steps), (False, 0))
        turned = np.array([[0, 1e-5, 0], [-1e-5, 0, 0], [0, 0, 0]])  # a rotation strains nothing
        self.assertTrue(rve.mixed(turned, before, every))

    def test_interrupt_takes_the_increment_back(self):
        rve = isostat.Rve(self.packing, min_steps=5_000_000)
        before = rve.stress
        timer = threading.Timer(0.5, signal.raise_signal, [signal.SIGINT])
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            rve.advance(np.diag([0.0, -1e-5, 0.0]))
        np.testing.assert_array_equal(rve.stress, before)
        self.assertTrue(rve.mixed(np.zeros((3, 3)), before, np.diag([True] * 3)))

    def test_one_thread_at_a_time(self):
        rve, refused = isostat.Rve(self.packing, min_steps=10000), []
        other = threading.Thread(target=rve.advance, args=(np.diag([0.0, -1e-5, 0.0]),))
        other.start()
        while other.is_alive():  # the stress alone until it is refused: what works without the GIL would come first
            for use in (lambda: rve.stress, rve.save, rve.stiffness, lambda: rve.undrained(np.zeros((3, 3))))[
                    :4 if refused else 1]:
                try:
                    use()
                except isostat.RunFailure as failure:
                    refused.append(str(failure))
        other.join()
        self.assertGreater(len(refused), 3)
        self.assertIn("in use by another thread", refused[0])
        alone = isostat.Rve(self.packing, min_steps=10000)
        alone.advance(np.diag([0.0, -1e-5, 0.0]))
        np.testing.assert_array_equal(rve.stress, alone.stress)

    def test_settings_out_of_range_are_refused(self):
        for setting in ({"damping": 1.5}, {"inertial_number": -1e-3}, {"strain_rate": float("nan")}, {"max_steps": 0}):
            with self.subTest(setting), self.assertRaisesRegex(isostat.InputError, next(iter(setting)) + ".*must"):
                isostat.Rve(self.packing, **setting)

    def test_too_large_an_increment_is_rejected(self):
        rve = isostat.Rve(self.packing)
        before = rve.stress
        response = rve.advance(np.diag([0.0, -0.5, 0.0]))
        self.assertFalse(response)
        self.assertIn("increment", response.reason)
        self.assertIn("rejected: ", repr(response))
        np.testing.assert_array_equal(rve.stress, before)

    def test_a_packing_in_a_box_is_refused(self):
        box = isostat.Snapshot.from_spheres([[1e-3] * 3], [1e-3], box=[[0, 0, 0], [2e-3] * 3])
        with self.assertRaises(isostat.InputError):
            isostat.Rve(box)

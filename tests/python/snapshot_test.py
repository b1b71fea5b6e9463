# SPDX-License-Identifier: BSD-3-Clause
"""Packings as arrays: views that keep their owner, the right numbers, files there and back; their measures."""
import gc
import pathlib
import tempfile
import warnings

import numpy as np

from package import ToleranceTest, isostat, packing_in_cell

R = 1e-3
CENTRES = np.array([[1, 1, 1], [2.9, 1, 1], [1, 3, 1]]) * R
BOX = np.array([[0, 0, 0], [4, 4, 2]]) * R


def three_spheres():
    return isostat.Snapshot.from_spheres(CENTRES, [R, R, R], box=BOX)


class SnapshotTest(ToleranceTest):
    def test_arrays_are_those_of_the_spheres(self):
        packing = three_spheres()
        self.assertEqual(len(packing), 3)
        np.testing.assert_array_equal(packing.positions, CENTRES)
        np.testing.assert_array_equal(packing.radii, [R, R, R])
        np.testing.assert_array_equal(packing.box, BOX)
        self.assertIsNone(packing.cell)
        mass = 2650 * 4 / 3 * np.pi * R**3
        self.assert_close(packing.masses, mass, 4e-16, "round-off of one product more than in C++")
        self.assert_close(packing.inertias, 0.4 * mass * R**2, 1e-15, "the same, of three products")

    def test_a_leaning_cell_keeps_its_shape(self):
        edges = np.array([[4, 0.4, 0], [0, 4, 0], [0, 0.2, 4]]) * R
        packing = isostat.Snapshot.from_spheres(CENTRES, [R, R, R], cell=edges)
        np.testing.assert_array_equal(packing.cell, edges)
        self.assertEqual(isostat.Snapshot.from_spheres(CENTRES, [R, R, R], cell=[4 * R] * 3).volume, (4 * R) ** 3)
        for wrong in ([4 * R, 4 * R], [4 * R, 4 * R, -R], -edges):
            with self.assertRaisesRegex(isostat.InputError, "cell: must be three lengths"):
                isostat.Snapshot.from_spheres(CENTRES, [R, R, R], cell=wrong)

    def test_arrays_are_read_only_views_that_keep_their_owner(self):
        packing = three_spheres()
        positions = packing.positions
        self.assertFalse(positions.flags.owndata or positions.flags.writeable)
        self.assertEqual(positions.__array_interface__["data"], packing.positions.__array_interface__["data"])
        del packing
        gc.collect()
        np.testing.assert_array_equal(positions, CENTRES)
        with self.assertRaises(ValueError):
            positions[0, 0] = 1

    def test_a_specimen_comes_back_bit_for_bit(self):
        with tempfile.TemporaryDirectory() as folder:
            path = str(pathlib.Path(folder) / "three.h5")
            isostat.write_specimen(path, isostat.Specimen(three_spheres()))
            with self.assertRaisesRegex(isostat.InputError, "three.h5: the file exists; give overwrite=True"):
                isostat.write_specimen(path, isostat.Specimen(three_spheres()))
            isostat.write_specimen(pathlib.Path(path), isostat.Specimen(three_spheres()), overwrite=True)
            again = isostat.read_specimen(path).snapshot
            np.testing.assert_array_equal(again.positions, CENTRES)
            np.testing.assert_array_equal(isostat.read_snapshot(path).radii, again.radii)
            text = pathlib.Path(folder) / "three.txt"
            text.write_text("\n".join(" ".join(f"{v!r}" for v in [*x, R]) for x in CENTRES.tolist()) + "\n")
            with self.assertWarnsRegex(UserWarning, "overlap by 10 %"):
                np.testing.assert_array_equal(isostat.import_tables(str(text)).positions, CENTRES)
            drawn = pathlib.Path(folder) / "three.vtp"
            for write in (isostat.write_vtp, isostat.write_force_chains_vtp):
                write(str(drawn), again, overwrite=True)
                self.assertIn("PolyData", drawn.read_text()[:200])
                with self.assertRaisesRegex(isostat.InputError, "three.vtp: the file exists"):
                    write(drawn, again)
            text.write_text("0 0 0 0.6\n2 0 0 0.6\n", encoding="utf-8")
            with self.assertRaisesRegex(isostat.InputError, "largest radius.*length_unit"):
                isostat.import_tables(text)

    def test_packings_of_other_programs(self):
        small = isostat.Snapshot.from_spheres(CENTRES, [R] * 3, cell=R * np.array([[5, 0.5, 0], [0, 5, 0], [0, 0, 5]]))
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            metres = isostat.Snapshot.from_spheres(1e3 * CENTRES, [1e3 * R] * 3, box=1e3 * BOX, anyway=True)
            source = f"{folder}/a.h5"
            isostat.write_packing(source, isostat.Specimen(small))
            target = f"{folder}/b.data"
            isostat.convert(pathlib.Path(source), target)
            with self.assertRaisesRegex(isostat.InputError, "the file exists"):
                isostat.convert(source, target)
            np.testing.assert_array_equal(isostat.read_packing(target).snapshot.positions, small.positions)
            isostat.write_packing(f"{folder}/c.csv", isostat.Specimen(metres))
            with self.assertRaisesRegex(isostat.InputError, "largest radius"):
                isostat.read_packing(f"{folder}/c.csv")
            self.assert_close(isostat.read_packing(f"{folder}/c.csv", length_unit="mm").snapshot.radii, R, 1e-15,
                              "one rounding")
            warnings.simplefilter("error")
            with self.assertRaisesRegex(UserWarning, "periodic cell"):
                isostat.write_packing(f"{folder}/d.txt", isostat.Specimen(small))

    def test_spheres_that_cannot_be_meant_are_refused(self):
        make = isostat.Snapshot.from_spheres
        for centres, radii, more, words in (
                (1e3 * CENTRES, [1.0] * 3, {"box": 1e3 * BOX},
                 "spheres: the largest radius is 1 m; expected at most 0.05 m.* in mm[?] If so, multiply centres, "
                 "radii and box or cell by 0.001. If they are in m, give anyway=True"),
                (1e-6 * CENTRES, [1e-9] * 3, {"cell": [5e-9] * 3}, "the largest radius is 1e-09 m; expected at least"),
                (CENTRES, [R] * 3, {"box": BOX, "density": 2.65}, "the grain density is 2.65 kg/m3; expected 30 to"),
                (0.5 * CENTRES, [R] * 3, {"box": 2 * BOX}, "grains 0 and 1 overlap by"),
                (CENTRES, [R] * 3, {"box": BOX - R / 2}, "reaches beyond a wall of the box by 50 %")):
            with self.subTest(words):
                with self.assertRaisesRegex(isostat.InputError, words):
                    make(centres, radii, **more)
                with self.assertWarnsRegex(UserWarning, words):
                    self.assertEqual(len(make(centres, radii, anyway=True, **more)), 3)

    def test_wrong_spheres_are_refused(self):
        make = isostat.Snapshot.from_spheres
        with self.assertRaisesRegex(isostat.InputError, "sphere 2"):
            make(CENTRES, [R, R, -R], box=BOX)
        for bad in ({"density": 0}, {"density": float("nan")}):
            with self.subTest(bad), self.assertRaisesRegex(isostat.InputError, "density"):
                make(CENTRES, [R] * 3, box=BOX, **bad)
        for bad in ({"ids": [1, 1, 2]}, {"ids": [0, 1]}, {"ids": [-1, 0, 1]}, {"velocities": CENTRES[:2]},
                    {"spins": CENTRES * float("nan")}, {"spins": [1, 2, 3]}):
            with self.subTest(bad), self.assertRaisesRegex(isostat.InputError, f"^{next(iter(bad))}: must be"):
                make(CENTRES, [R] * 3, box=BOX, **bad)
        for radius, words in ((float("inf"), "sphere 0"), (5.0, "smaller than the spheres")):
            with self.subTest(radius), self.assertRaisesRegex(isostat.InputError, words):
                make(CENTRES, [radius] * 3, box=BOX)
        with self.assertRaisesRegex(isostat.InputError, "cell"):
            make(CENTRES, [R] * 3, cell=[1, 1, float("inf")])
        with self.assertRaisesRegex(isostat.InputError, "either box"):
            make(CENTRES, [R, R, R])
        with self.assertRaisesRegex(isostat.InputError, "lower < upper"):
            make(CENTRES, [R, R, R], box=BOX[::-1])


class MeasuresTest(ToleranceTest):
    """They agree with each other and have a unit each."""
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

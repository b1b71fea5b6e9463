# SPDX-License-Identifier: BSD-3-Clause
"""Packings, runs, results and errors come back from other processes as they were."""
import concurrent.futures
import copy
import multiprocessing
import pickle

import numpy as np

from package import SMALL_SCENE, FolderTest, isostat

SCENE = SMALL_SCENE + "max_steps = 300\n"


def run(seed, output, cache):
    scene = isostat.Scene(SCENE, set={"grading.seed": seed})
    return isostat.run(scene, output, cache=cache, threads=1, quiet=True)


def refused(_):
    isostat.Scene(title="no specimen")


class PickleTest(FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.done = run(1, None, cls.cache)

    def assert_same_packing(self, one, other):
        for name in ("positions", "velocities", "spins", "radii", "ids", "contact_pairs", "normal_forces",
                     "shear_forces", "bending_moments", "cell", "strain"):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)
        self.assertEqual((one.time, one.step, one.law, one.density), (other.time, other.step, other.law, other.density))

    def test_packings(self):
        packing = self.done.snapshot
        for again in (pickle.loads(pickle.dumps(packing)), copy.deepcopy(packing)):
            self.assert_same_packing(again, packing)
        specimen = isostat.prepare(SCENE, cache=self.cache)
        again = pickle.loads(pickle.dumps(specimen))
        self.assertEqual((again.numbers, again.provenance), (specimen.numbers, specimen.provenance))
        self.assert_same_packing(again.snapshot, specimen.snapshot)

    def test_of_other_processes(self):
        with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as processes:
            in_memory = processes.submit(run, 1, None, self.cache)
            in_folder = processes.submit(run, 1, self.folder / "results", self.cache)
            wrong = processes.submit(refused, None)
            with self.assertRaisesRegex(isostat.InputError, "must have exactly one"):
                wrong.result()
            for other in (in_memory.result(), in_folder.result()):
                self.assert_same_packing(other.snapshot, self.done.snapshot)
                self.assertEqual(other.summary["ended"], self.done.summary["ended"])
                self.assertEqual(other.warnings, self.done.warnings)
                self.assertEqual(list(other.history), list(self.done.history))
                self.assertEqual(other.history.units, self.done.history.units)
        self.assertEqual(isostat.read(self.folder / "results").scene.title, "small")

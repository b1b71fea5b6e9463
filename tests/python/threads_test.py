# SPDX-License-Identifier: BSD-3-Clause
"""Several threads, and several processes, call the package at once: no crash, and the bits of one that is alone.

REPEATS in the environment makes it longer: REPEATS=20 in place of 3, with 2, 3 and 4 threads in place of 3."""
import concurrent.futures
import copy
import multiprocessing
import os
import pathlib
import pickle
import subprocess
import tempfile
import threading
import unittest

import numpy as np

from package import BINARIES, CONTACT, SMALL_SCENE, FolderTest, isostat

REPEATS = int(os.environ.get("REPEATS", "3"))
THREADS = (2, 3, 4) if REPEATS > 3 else (3,)
SCENE = isostat.Scene(grading={"grains": 100, "cloud_edge": "2.2 mm"}, contact={**CONTACT, "young": "100 MPa"},
                      specimen={"domain": "periodic-cell", "preparation_friction": "10 deg", "pressure": "50 kPa"},
                      stage=[{"kind": "drained", "strain": 1e-4}])
SMALL = SMALL_SCENE + "max_steps = 300\n"
SHEAR = np.array([[0, 1e-5, 0], [0, 0, 0], [0, 0, 0]])
COLUMN = """title = "a pulse"
[water]
drainage = "dry"
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
duration = "0.2 s"
"""


def run(folder):
    return isostat.run(SCENE, folder / "run", cache=folder / "cache", threads=1).history["p"]


def prepare(folder):
    return isostat.prepare(SCENE, cache=folder.parent / "shared_cache", threads=1).snapshot.positions.copy()


def read(folder):
    specimen = isostat.prepare(SCENE, cache=folder.parent / "shared_cache", threads=1)
    isostat.write_packing(folder / "packing.h5", specimen)
    return isostat.read_packing(folder / "packing.h5").snapshot.positions.copy()


def rve(folder):
    element = isostat.Rve(isostat.prepare(SCENE, cache=folder.parent / "shared_cache", threads=1).snapshot)
    element.undrained(SHEAR)
    return element.stress


def column(folder):
    from isostat import column as columns
    shaken = columns.run(columns.ColumnScene(COLUMN), folder / "column")
    return np.array([shaken.history[name] for name in sorted(shaken.history)])


TASKS = {task.__name__: task for task in (run, prepare, read, rve, column)}
if not list((BINARIES.parent / "python/isostat").glob("_column*.so")):  # built without finite elements
    del TASKS["column"]


def at_once(names, repeats):
    """Each name is a thread that does its task so often; all must find what the first of their kind found."""
    found, failures = [], []

    def work(number, name):
        try:
            for repeat in range(repeats):
                folder = top / f"{number}_{repeat}"
                folder.mkdir()
                found.append((name, TASKS[name](folder)))
        except BaseException as failure:  # pylint: disable=broad-exception-caught
            failures.append(f"{name}: {failure!r}")

    with tempfile.TemporaryDirectory() as path:
        top = pathlib.Path(path)
        threads = [threading.Thread(target=work, args=item) for item in enumerate(names)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    assert not failures, failures
    assert len(found) == repeats * len(names)
    for name in set(names):
        results = [result for other, result in found if other == name]
        for result in results:
            np.testing.assert_array_equal(result, results[0], strict=True)


class ThreadsTest(unittest.TestCase):
    def call(self, names):
        """In a process of its own: a crash is its exit code."""
        process = multiprocessing.get_context("spawn").Process(target=at_once, args=(names, REPEATS))
        process.start()
        process.join()
        self.assertEqual(process.exitcode, 0, names)

    def test_threads_of_one_kind(self):
        for name in TASKS:
            for n in THREADS:
                with self.subTest(name, threads=n):
                    self.call([name] * n)

    def test_threads_of_all_kinds(self):
        self.call(list(TASKS))

    def test_processes_that_need_the_same_new_specimen(self):
        for repeat in range(REPEATS):
            with self.subTest(repeat=repeat), tempfile.TemporaryDirectory() as path:
                folder = pathlib.Path(path)
                (folder / "scene.toml").write_text(str(SCENE), encoding="utf-8")
                command = [BINARIES / "element_test", "scene.toml", "--no-figures", "-q", "-o"]
                runs = [subprocess.Popen([*command, f"run{k}"], cwd=folder, stderr=subprocess.PIPE,
                                         stdout=subprocess.DEVNULL) for k in range(8)]
                said = [process.communicate()[1] for process in runs]
                self.assertEqual([process.returncode for process in runs], [0] * 8, said)
                first, *others = [(folder / f"run{k}/history.csv").read_bytes() for k in range(8)]
                self.assertTrue(all(other == first for other in others))
                self.assertEqual(list(folder.rglob("*.tmp")), [])


def run_small(seed, output, cache):
    scene = isostat.Scene(SMALL, set={"grading.seed": seed})
    return isostat.run(scene, output, cache=cache, threads=1, quiet=True)


def refused(_):
    isostat.Scene(title="no specimen")


class PickleTest(FolderTest):
    """Packings, runs, results and errors come back from other processes as they were."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.done = run_small(1, None, cls.cache)

    def assert_same_packing(self, one, other):
        for name in ("positions", "velocities", "spins", "radii", "ids", "contact_pairs", "normal_forces",
                     "shear_forces", "bending_moments", "cell", "strain"):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)
        self.assertEqual((one.time, one.step, one.law, one.density), (other.time, other.step, other.law, other.density))

    def test_packings(self):
        packing = self.done.snapshot
        for again in (pickle.loads(pickle.dumps(packing)), copy.deepcopy(packing)):
            self.assert_same_packing(again, packing)
        specimen = isostat.prepare(SMALL, cache=self.cache)
        again = pickle.loads(pickle.dumps(specimen))
        self.assertEqual((again.numbers, again.provenance), (specimen.numbers, specimen.provenance))
        self.assert_same_packing(again.snapshot, specimen.snapshot)

    def test_of_other_processes(self):
        with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as processes:
            in_memory = processes.submit(run_small, 1, None, self.cache)
            in_folder = processes.submit(run_small, 1, self.folder / "results", self.cache)
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

# SPDX-License-Identifier: BSD-3-Clause
"""Calls that fail (tests/support/failing_calls.cpp): whatever open, write, fsync, rename or mkdir of a run is refused,
once or from then on, the program says so and ends with 1 or 2, nothing is left half written, and the run continues to
the same files. Some calls of each kind here; with ISOSTAT_EVERY_CALL=1 all of them, and 500 of some 28,000
allocations."""
import collections
import errno
import signal

from biaxial_test import FRICTION
from failing_runs import COLUMN, EVERY, OUTPUT, SAVED, SHORT_TEST, FailingRuns
from grain_column_test import GrainColumnTest
from support import results
from void_ratio_limits_test import LIMITS, QUICK


class Failures(FailingRuns):
    def test_element_test(self):
        self.every_call("element_test", self.write("scene.toml", SHORT_TEST), *SAVED, most=3)

    def test_biaxial(self):
        self.every_call("soil_column", self.write("block.toml", FRICTION), *SAVED, most=2)

    def test_soil_column(self):
        self.every_call("soil_column", self.write("column.toml", COLUMN), *SAVED, most=2)

    def test_void_ratio_limits(self):
        scene = self.write("limits.toml", LIMITS)
        self.every_call("void_ratio_limits", scene, *QUICK, output=("-o", "out"), goes_on=FailingRuns.anew, most=1)

    def test_micromechanics(self):
        self.assert_done(self.run_test(self.write("scene.toml", SHORT_TEST), "-o", "run"))
        self.every_call("micromechanics", "run", output=("-o", "out", "--no-figures"), goes_on=FailingRuns.anew, most=1,
                        fewest=2)

    def test_memory(self):
        """Where it runs out within HDF5 1.10 that library may crash, or end the program with 255: files are whole even
        so, as nothing of HDF5 writes to them."""
        arguments = (self.write("scene.toml", SHORT_TEST), *SAVED)
        self.assert_done(self.run_app("element_test", *arguments, *OUTPUT))
        whole = results(self.folder / "out")
        command = self.command("element_test", *arguments, *OUTPUT)
        self.empty()
        result, n = self.run_failing(command, "malloc")
        self.assert_done(result)
        codes = collections.Counter()
        for calls in (1, 0):
            for at in range(1, n + 1, n // (500 if EVERY else 5)):
                with self.subTest(at=at, calls=calls):
                    self.empty()
                    result, _ = self.run_failing(command, "malloc", at, calls, errno.ENOMEM)
                    codes[result.returncode] += 1
                    self.assertIn(result.returncode, (0, 1, 255, -signal.SIGSEGV, -signal.SIGABRT), result.stderr)
                    if result.returncode == 1:
                        self.assertRegex(result.stderr, "not enough memory|cannot write|bad_alloc|Cannot allocate")
                    if result.returncode != 0:
                        self.resumed("element_test", arguments, OUTPUT)
                    self.assertEqual(results(self.folder / "out"), whole)
        print(f"  element_test: {sum(codes.values())} of {n} allocations failed, exit codes {dict(codes)}", flush=True)

    def test_without_locks(self):
        """On a file system that has none: one run continues, many in one folder would not be safe."""
        scene = self.write("scene.toml", SHORT_TEST)
        arguments = (scene, *SAVED, "--set", "stage.0.max_steps=20000")
        command = self.command("element_test", *arguments, *OUTPUT)
        result, n = self.run_failing(command, "flock", 1, code=errno.ENOLCK)
        self.assert_done(result)
        self.assertGreater(n, 0)
        whole = results(self.folder / "out")
        for reason in (errno.ENOLCK, errno.EOPNOTSUPP):
            self.empty()
            code = self.run_and_stop(0.02, signal.SIGTERM, (self.folder / "out/checkpoint/last.h5", False), *arguments,
                                     "-o", "out")
            self.assertEqual(code, 130)
            result, _ = self.run_failing([*command, "--resume"], "flock", 1, code=reason)
            self.assert_done(result)
            self.assertEqual(results(self.folder / "out"), whole)


class Replays(FailingRuns, GrainColumnTest):
    def test_rve_replay(self):
        self.whole()
        self.every_call("rve_replay", "whole/paths/d0", goes_on=FailingRuns.anew, most=1)

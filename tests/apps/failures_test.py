#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Calls that fail (tests/support/failing_calls.cpp): whatever open, write, fsync, rename or mkdir of a run is refused,
once or from then on, the program says so and ends with 1 or 2, nothing is left half written, and the run goes on to the
same files. Some calls of each kind here; all of them with ISOSTAT_EVERY_CALL=1."""
import collections
import errno
import os
import pathlib
import shutil
import signal
import subprocess

from biaxial_test import CELL, FEW, FRICTION
from support import BIN, CYCLIC, PATIENCE, AppTest, main, results, tiny_scene

KINDS = ("open", "write", "fsync", "rename", "mkdir")
LIBRARY = BIN.parent / "tests/libfailing_calls.so"
SAVED = ("--set", "output.checkpoint=1e-9 min")
OUTPUT = ("-o", "out", "--no-figures", "-q")
EVERY = bool(os.environ.get("ISOSTAT_EVERY_CALL"))
SHORT_TEST = tiny_scene(stages=CYCLIC.format(steps=600))
COLUMN = """[[layer]]
thickness = "4 m"
cells = 4
density = "1900 kg/m3"
permeability = "1e-4 m/s"
material = "iwan"
shear_velocity = "140 m/s"
[[motion]]
axis = "x"
kind = "harmonic"
amplitude = "0.1 g"
frequency = "2 Hz"
duration = "1 s"
[analysis]
duration = "0.6 s"
[output]
depths = ["1 m"]
profile_interval = "0.2 s"
paraview_interval = "0.3 s"
"""


class Failures(AppTest):
    def run_failing(self, command, kind="none", at=0, calls=0, code=errno.ENOSPC):
        count = self.folder / "calls.txt"
        count.unlink(missing_ok=True)
        plan = {"LD_PRELOAD": LIBRARY, "FAILING_KIND": kind, "FAILING_PROGRAM": pathlib.Path(command[0]).name,
                "FAILING_UNDER": self.folder / "out", "FAILING_AT": at,
                "FAILING_CALLS": calls, "FAILING_CODE": code, "FAILING_COUNT": count}
        result = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=120 * PATIENCE,
                                check=False, env=os.environ | {name: str(value) for name, value in plan.items()})
        return result, int(count.read_text(encoding="utf-8")) if count.exists() else None

    def empty(self):
        shutil.rmtree(self.folder / "out", ignore_errors=True)

    def resumed(self, program, arguments, output):
        """As the messages say: from the checkpoint, or anew."""
        checkpoints = self.folder / "out/checkpoint"
        resumable = checkpoints.is_dir() and any(checkpoints.glob("*.h5"))
        result = self.run_app(program, *arguments, *output, "--resume" if resumable else "--overwrite")
        if not resumable and "holds no scene.toml" in result.stderr:
            self.empty()
            result = self.run_app(program, *arguments, *output)
        self.assert_done(result)
        self.assertTrue((self.folder / "out/summary.txt").is_file())

    def repeated(self, program, arguments, output):
        """By the same command, as a campaign or a library goes on."""
        append = ["--append"] if (self.folder / "out/library.h5").exists() else []
        self.assert_done(self.run_app(program, *arguments, *output, *append))

    def every_call(self, program, *arguments, output=OUTPUT, goes_on=resumed, most=6, fewest=3):
        """@param most  calls of a kind and a way of failing that are tried, unless all are   @param fewest  files"""
        self.assert_done(self.run_app(program, *arguments, *output))
        whole = results(self.folder / "out")
        self.assertGreaterEqual(len(whole), fewest)
        command = self.command(program, *arguments, *output)
        tried = collections.Counter()
        for kind in KINDS:
            self.empty()
            result, n = self.run_failing(command, kind)
            self.assert_done(result)
            self.assertEqual(results(self.folder / "out"), whole, "a run that is watched is the same")
            self.assertGreater(n, 0, kind)
            for calls in (1, 0):  # one call; all from then on
                for at in range(1, n + 1, 1 if EVERY else max(1, -(-n // most))):
                    with self.subTest(program=program, kind=kind, at=at, calls=calls):
                        self.empty()
                        result, _ = self.run_failing(command, kind, at, calls)
                        tried[kind] += 1
                        self.assertIn(result.returncode, (1, 2), result.stderr)
                        self.assertIn(os.strerror(errno.ENOSPC), result.stderr)
                        self.assertRegex(result.stderr, "check free space|Give (a path|another one)")
                        out = self.folder / "out"
                        if calls == 1 and out.is_dir():
                            self.assertEqual(list(out.rglob("*.tmp")), [], "what was written aside is gone")
                        goes_on(self, program, arguments, output)
                        self.assertEqual(results(self.folder / "out"), whole)
        print(f"  {program}: {dict(tried)} failures", flush=True)

    def test_element_test(self):
        self.every_call("element_test", self.write("scene.toml", SHORT_TEST), *SAVED)

    def test_biaxial(self):
        self.every_call("biaxial", self.write("block.toml", FRICTION), *SAVED, most=3)

    def test_soil_column(self):
        self.every_call("soil_column", self.write("column.toml", COLUMN), *SAVED, most=3)

    def test_specimen_library(self):
        scene = self.write("scene.toml", tiny_scene(specimen=CELL, stages="# none"))
        self.every_call("specimen_library", scene, *FEW, output=("-o", "out/library.h5", "-q"),
                        goes_on=Failures.repeated, most=3, fewest=1)

    def test_liquefaction_resistance(self):
        scene = self.write("scene.toml", SHORT_TEST)
        self.every_call("liquefaction_resistance", scene, "--ratios", "0.2,0.3", "-n", 1, goes_on=Failures.repeated,
                        most=2)

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
            for at in range(1, n + 1, 1 if EVERY else n // 8):
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
        """On a file system that has none: one run goes on, many in one folder would not be safe."""
        scene = self.write("scene.toml", SHORT_TEST)
        command = self.command("element_test", scene, *OUTPUT)
        result, n = self.run_failing(command, "flock", 1, code=errno.ENOLCK)
        self.assert_done(result)
        self.assertGreater(n, 0)
        self.empty()
        command = self.command("liquefaction_resistance", scene, "--ratios", "0.2,0.3", "-o", "out", "-q")
        result, _ = self.run_failing(command, "flock", 1, code=errno.ENOLCK)
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("cannot be locked: No locks available. Work on a file system that has locks", result.stderr)


if __name__ == "__main__":
    main()

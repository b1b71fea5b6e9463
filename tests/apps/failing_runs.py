# SPDX-License-Identifier: BSD-3-Clause
"""Runs in which calls fail (tests/support/failing_calls.cpp)."""
import collections
import errno
import os
import pathlib
import shutil

from support import BIN, CYCLIC, AppTest, results, tiny_scene

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
reference_pressure = "100 kPa"
k0 = 0.5
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


class FailingRuns(AppTest):
    def run_failing(self, command, kind="none", at=0, calls=0, code=errno.ENOSPC):
        count = self.folder / "calls.txt"
        count.unlink(missing_ok=True)
        plan = {"LD_PRELOAD": LIBRARY, "FAILING_KIND": kind, "FAILING_PROGRAM": pathlib.Path(command[0]).name,
                "FAILING_UNDER": self.folder / "out", "FAILING_AT": at,
                "FAILING_CALLS": calls, "FAILING_CODE": code, "FAILING_COUNT": count}
        result = self.run_command(command, env=os.environ | {name: str(value) for name, value in plan.items()})
        return result, int(count.read_text(encoding="utf-8")) if count.exists() else None

    def empty(self):
        shutil.rmtree(self.folder / "out", ignore_errors=True)

    def resumed(self, program, arguments, output):
        """As the messages say: from the checkpoint, or again."""
        checkpoints = self.folder / "out/checkpoint"
        resumable = checkpoints.is_dir() and any(checkpoints.glob("*.h5"))
        result = self.run_app(program, *arguments, *output, "--resume" if resumable else "--overwrite")
        if not resumable and "holds no scene.toml" in result.stderr:
            self.empty()
            result = self.run_app(program, *arguments, *output)
        self.assert_done(result)
        self.assertTrue((self.folder / "out/summary.txt").is_file())

    def repeated(self, program, arguments, output):
        """By the same command, as a campaign or a library continues."""
        append = ["--append"] if (self.folder / "out/library.h5").exists() else []
        self.assert_done(self.run_app(program, *arguments, *output, *append))

    def anew(self, program, arguments, output):
        self.empty()
        self.assert_done(self.run_app(program, *arguments, *output))

    def every_call(self, program, *arguments, output=OUTPUT, goes_on=resumed, most=6, fewest=3, harmless=None):
        """@param most  calls of a kind that are tried, unless all are   @param fewest  files
        @param harmless  how many calls of a kind may fail without harm: the run ends with 0 and the same files"""
        self.assert_done(self.run_app(program, *arguments, *output))
        whole = results(self.folder / "out")
        self.assertGreaterEqual(len(whole), fewest)
        command = self.command(program, *arguments, *output)
        tried, passed_over = collections.Counter(), set()
        for k, kind in enumerate(KINDS):
            self.empty()
            result, n = self.run_failing(command, kind)
            self.assert_done(result)
            self.assertEqual(results(self.folder / "out"), whole, "a run that is watched is the same")
            self.assertGreater(n, 0, kind)
            numbers = range(1, n + 1, 1 if EVERY else max(1, -(-n // most)))
            for i, at in enumerate(numbers):
                for calls in (1, 0) if EVERY else ((i + k) % 2,):  # this call, or all from then on
                    with self.subTest(program=program, kind=kind, at=at, calls=calls):
                        self.empty()
                        result, n_in_all = self.run_failing(command, kind, at, calls)
                        tried[kind] += 1
                        if harmless and result.returncode == 0:
                            left = results(self.folder / "out")
                            if "the specimen is not kept" in result.stderr:  # the cache alone is not written
                                left |= {name: content for name, content in whole.items() if "specimens/" in name}
                            elif n_in_all >= at:  # how often a leader looks at the files of the queue depends on time
                                passed_over.add((kind, n_in_all - at))
                            self.assertEqual(left, whole)
                            continue
                        self.assertIn(result.returncode, (1, 2), result.stderr)
                        self.assertIn(os.strerror(errno.ENOSPC), result.stderr)
                        self.assertRegex(result.stderr, "check free space|Give (a path|another one)")
                        out = self.folder / "out"
                        if calls == 1 and out.is_dir():
                            self.assertEqual(list(out.rglob("*.tmp")), [], "what was written aside is gone")
                        goes_on(self, program, arguments, output)
                        self.assertEqual(results(self.folder / "out"), whole)
        for kind, n in collections.Counter(kind for kind, _ in passed_over).items():
            self.assertLessEqual(n, harmless.get(kind, 0), passed_over)
        print(f"  {program}: {dict(tried)} failures, {len(passed_over)} without harm", flush=True)

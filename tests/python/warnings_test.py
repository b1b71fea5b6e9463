# SPDX-License-Identifier: BSD-3-Clause
"""Warnings of runs are those of Python, with the name of the run; signals that end a process leave a checkpoint."""
import os
import signal
import subprocess
import sys
import warnings

import numpy as np

from package import BINARIES, SMALL_SCENE, TIME_LIMIT, FolderTest, isostat

SCENE = SMALL_SCENE + "max_steps = 600\n"
TEXT = "stage 0 (undrained-monotonic): ended by max_steps = 600 before any of its conditions was met: strain = 0.1 %"


class WarningsTest(FolderTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.scene = isostat.Scene(SCENE)
        isostat.prepare(cls.scene, cache=cls.cache)

    def run_scene(self, *arguments, **keywords):
        return isostat.run(self.scene, *arguments, cache=self.cache, **keywords)

    def test_they_name_the_run_and_the_line_of_the_caller(self):
        for output, name in ((None, "small"), (self.folder / "named", str(self.folder / "named"))):
            with self.assertWarns(isostat.IsostatWarning) as caught:
                run = self.run_scene(output)
            self.assertTrue(str(caught.warning).startswith(f"{name}: {TEXT}"), caught.warning)
            self.assertEqual(caught.filename, __file__)
            self.assertEqual(len(run.warnings), 1)
            self.assertTrue(run.warnings[0].startswith(TEXT))
            self.assertEqual(len(run.summary["ended_early"]), 1)

    def test_quiet_keeps_them_only(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.assertEqual(len(self.run_scene(quiet=True).warnings), 1)
            with self.assertRaises(isostat.IsostatWarning):
                self.run_scene()

    def test_nothing_is_on_stderr(self):
        program = (f"import sys; sys.path.insert(0, {str(BINARIES.parent / 'python')!r})\n"
                   f"import isostat, warnings\nwarnings.simplefilter('ignore')\n"
                   f"isostat.run(isostat.Scene({SCENE!r}), cache={str(self.cache)!r})\n")
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=TIME_LIMIT)
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, "", ""))

    def test_of_a_preparation(self):
        scene = isostat.Scene(SCENE, set={"contact.friction": "5 deg"})
        with self.assertWarnsRegex(isostat.IsostatWarning, "^small: the packing is prepared with a friction of 12 deg"):
            isostat.prepare(scene, cache=self.cache)

    def stopped(self, number, output):
        """What a program prints that is sent a signal after 300 steps."""
        program = (f"import sys; sys.path.insert(0, {str(BINARIES.parent / 'python')!r})\n"
                   f"import isostat, os, signal\nbefore = signal.getsignal({int(number)})\n"
                   f"def once(moment):\n    os.kill(os.getpid(), {int(number)})\n    return True\n"
                   f"try:\n"
                   f"    isostat.run(isostat.Scene({SCENE!r}), {str(output)!r},\n"
                   f"                cache={str(self.cache)!r}, on_step=once, every=300, quiet=True)\n"
                   f"except KeyboardInterrupt:\n"
                   f"    print('stopped', signal.getsignal({int(number)}) is before)\n")
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=TIME_LIMIT)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.strip()

    def test_signals_leave_a_checkpoint(self):
        whole = self.run_scene(quiet=True)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGUSR1):
            folder = self.folder / number.name
            self.assertEqual(self.stopped(number, folder), "stopped True")
            self.assertFalse(isostat.read(folder).finished)
            resumed = self.run_scene(folder, resume=True, quiet=True)
            np.testing.assert_array_equal(resumed.snapshot.positions, whole.snapshot.positions)

    def test_handlers_of_the_program_stay(self):
        seen = []
        before = signal.signal(signal.SIGTERM, lambda number, frame: seen.append(number))
        self.addCleanup(signal.signal, signal.SIGTERM, before)
        run = self.run_scene(quiet=True, on_step=lambda moment: os.kill(os.getpid(), signal.SIGTERM), every=500)
        self.assertTrue(run.finished)
        self.assertEqual(seen, [signal.SIGTERM])

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Two runs in one folder: the second is refused whether it would start anew or go on, the first does not notice, and
its folder is free as soon as it has ended, however it has."""
import contextlib
import os
import shutil
import signal
import subprocess

from biaxial_test import FRICTION
from failing_runs import COLUMN, SAVED
from support import ATTEMPTS, CYCLIC, TIME_LIMIT, AppTest, main, results, tiny_scene, wait_until


def is_stopped(process):
    """Or has it ended? Waits for either."""
    ended_or_stopped = os.waitid(os.P_PID, process.pid, os.WEXITED | os.WSTOPPED | os.WNOWAIT)
    return ended_or_stopped.si_code == os.CLD_STOPPED


class SharedFolder(AppTest):
    @contextlib.contextmanager
    def halted(self, command):
        """A run that has a checkpoint and stands still. One that ends first, as on a busy machine, is repeated."""
        last = self.folder / "out/checkpoint/last.h5"
        for _ in range(ATTEMPTS):
            with self.started([*command, "-o", "out", "-q", "--no-figures"]) as process:
                wait_until(last.exists, last, process)
                process.send_signal(signal.SIGSTOP)
                if process.poll() is None and is_stopped(process):
                    try:
                        yield process
                    finally:
                        process.send_signal(signal.SIGCONT)
                    return
                said = process.communicate(timeout=TIME_LIMIT)[1]
            self.assertEqual(process.returncode, 0, said)
            shutil.rmtree(self.folder / "out", ignore_errors=True)
        self.fail("each run ended before it was stopped")

    def share(self, program, *arguments):
        self.assert_done(self.run_app(program, *arguments, "-o", "whole", "-q", "--no-figures"))
        command = self.command(program, *arguments)
        with self.halted(command) as first:
            for use in ("--overwrite", "--resume"):
                self.assert_refused(self.run_app(program, *arguments, "-o", "out", "-q", use),
                                    "out: another program is at work in it", "--output")
            first.send_signal(signal.SIGCONT)
            self.assertEqual(first.wait(timeout=TIME_LIMIT), 0)
        self.assertEqual(results(self.folder / "out"), results(self.folder / "whole"))
        (self.folder / "out").rename(self.folder / "done")
        with self.halted(command) as killed:
            killed.kill()
        self.assert_done(self.run_app(program, *arguments, "-o", "out", "-q", "--no-figures", "--resume"))
        self.assertEqual(results(self.folder / "out"), results(self.folder / "whole"))

    def test_a_folder_that_vanishes(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=6000)))
        for program, arguments in (("element_test", (scene,)), ("soil_column", (self.write("column.toml", COLUMN),)),
                                   ("soil_column", (self.write("block.toml", FRICTION),))):
            with self.subTest(program), self.halted(self.command(program, *arguments, *SAVED)) as run:
                shutil.rmtree(self.folder / "out")
                run.send_signal(signal.SIGCONT)
                said = run.communicate(timeout=TIME_LIMIT)[1]
                self.assertEqual(run.returncode, 1, said)
                self.assertRegex(said, "No such file or directory|there is no such file")
                self.assertIn("last good checkpoint: there is none", said)

    def test_element_test(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=6000)))
        self.share("element_test", scene, *SAVED)

    def test_soil_column(self):
        self.share("soil_column", self.write("column.toml", COLUMN), *SAVED)

    def test_programs_that_start_at_once_share_no_session_of_mpi(self):
        """Open MPI 4 removes the folder that they share, now and then while another starts in it; 5 leaves it."""
        temporary, column = self.folder / "temporary", self.write("column.toml", COLUMN.replace("0.6 s", "6 s"))
        temporary.mkdir()
        seen, environment = set(), {**os.environ, "TMPDIR": str(temporary)}
        runs = [subprocess.Popen(self.command("soil_column", column, "-o", out, "--no-figures", "-q"), cwd=self.folder,
                                 stdout=subprocess.DEVNULL, env=environment)
                for out in ("one", "other")]

        def all_have_ended():
            seen.update(path.name for path in temporary.iterdir())
            return all(run.poll() is not None for run in runs)

        wait_until(all_have_ended, "the end of both", interval=0.002)
        self.assertEqual([run.wait() for run in runs], [0, 0])
        self.assertEqual(len([name for name in seen if name.startswith("isostat-mpi-")]), 2, seen)
        self.assertFalse([name for name in seen if name.startswith("ompi.")], seen)
        self.assertEqual(list(temporary.iterdir()), [], "what was temporary is gone")

    def test_a_folder_with_nothing_but_a_lock_is_free(self):
        scene = self.write("scene.toml", tiny_scene(stages="# none"))
        (self.folder / "out").mkdir()
        (self.folder / "out/.lock").touch()
        self.assert_done(self.run_app("element_test", scene, "-o", "out", "-q", "--no-figures"))


if __name__ == "__main__":
    main()

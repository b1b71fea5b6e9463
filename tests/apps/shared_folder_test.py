# SPDX-License-Identifier: BSD-3-Clause
"""Two runs in one folder: the second is refused whether it would start again or continue, the first does not notice,
and its folder is free as soon as it has ended, however it has."""
import concurrent.futures
import contextlib
import os
import shutil
import signal
import subprocess

from failing_runs import COLUMN, SAVED
from support import ATTEMPTS, CYCLIC, TIME_LIMIT, AppTest, tiny_scene, wait_until


def is_stopped(process):
    """Or has it ended? Waits for either."""
    ended_or_stopped = os.waitid(os.P_PID, process.pid, os.WEXITED | os.WSTOPPED | os.WNOWAIT)
    return ended_or_stopped.si_code == os.CLD_STOPPED


class SharedFolder(AppTest):
    @contextlib.contextmanager
    def halted(self, command, out="out"):
        """A run that has a checkpoint and stands still. One that ends first, as on a busy machine, is repeated."""
        last = self.folder / out / "checkpoint/last.h5"
        for _ in range(ATTEMPTS):
            with self.started([*command, "-o", out, "-q", "--no-figures"]) as process:
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
            shutil.rmtree(self.folder / out, ignore_errors=True)
        self.fail("each run ended before it was stopped")

    def setUp(self):
        super().setUp()
        self.scenes = {"element_test": self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=6000))),
                       "soil_column": self.write("column.toml", COLUMN)}

    def test_two_runs(self):
        """Of all programs at once: what is refused waits for five seconds first."""
        with concurrent.futures.ThreadPoolExecutor() as pool:
            list(pool.map(self.share, self.scenes, self.scenes.values()))

    def share(self, program, scene):
        out, whole = f"{program}_out", f"{program}_whole"
        self.assert_done(self.run_app(program, scene, *SAVED, "-o", whole, "-q", "--no-figures"))
        command = self.command(program, scene, *SAVED)
        with self.halted(command, out) as first, concurrent.futures.ThreadPoolExecutor() as pool:
            for refused in pool.map(lambda use: self.run_command([*command, "-o", out, "-q", use]),
                                    ("--overwrite", "--resume")):
                self.assert_refused(refused, f"{out}: another program is using it", "--output")
            first.send_signal(signal.SIGCONT)
            self.assertEqual(first.wait(timeout=TIME_LIMIT), 0)
        self.assert_same_results(out, whole)
        (self.folder / out).rename(self.folder / f"{program}_done")
        with self.halted(command, out) as killed:
            killed.kill()
        self.assert_done(self.run_app(program, scene, *SAVED, "-o", out, "-q", "--no-figures", "--resume"))
        self.assert_same_results(out, whole)

    def test_a_folder_that_vanishes(self):
        for program, scene in self.scenes.items():
            with self.subTest(program), self.halted(self.command(program, scene, *SAVED)) as run:
                shutil.rmtree(self.folder / "out")
                run.send_signal(signal.SIGCONT)
                said = run.communicate(timeout=TIME_LIMIT)[1]
                self.assertEqual(run.returncode, 1, said)
                self.assertRegex(said, "No such file or directory|there is no such file")
                self.assertIn("last good checkpoint: there is none", said)

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

# SPDX-License-Identifier: BSD-3-Clause
"""Campaigns on every engine: processes of this machine, ranks of mpirun, a Dask cluster of two workers. Workers, runs
and the leading process are killed, and the same command continues; the tables are those of one process."""
import contextlib
import importlib.util
import os
import pathlib
import re
import signal
import subprocess
import sys
import unittest

from resistance_test import SHEAR
from support import BIN, TIME_LIMIT, AppTest, children, table, wait_until

RATIOS = ("--ratios", "0.16,0.25", "-n", "2", "--cycles", "15", "--no-figures")


def all_children(process):
    """Processes below this one that run element_test."""
    found = []
    for child in children(process):
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            if "element_test" in pathlib.Path(f"/proc/{child}/cmdline").read_text(encoding="utf-8"):
                found.append(child)
    return found


class Engines(AppTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("shear.toml", SHEAR)

    def campaign(self, folder, *more):
        return self.command("isostat", "resistance", self.scene, *RATIOS, "-o", folder, *more)

    def start(self, command, **options):
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   **options)
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def ended(self, process):
        """Exit code, and what it said."""
        out, err = process.communicate(timeout=TIME_LIMIT)
        return process.returncode, out + err

    def alone(self):
        """The table of one process."""
        kept = self.cache / "alone.csv"
        if not kept.exists():
            self.assert_done(self.run_command(self.campaign("alone")))
            kept.write_bytes((self.folder / "alone/resistance.csv").read_bytes())
        return table(kept)

    def assert_alone(self, folder):
        self.assertEqual(table(self.folder / folder / "resistance.csv"), self.alone())

    def test_jobs(self):
        self.assert_done(self.run_command(self.campaign("out", "--jobs", 2)))
        self.assert_alone("out")

    def test_ranks(self):
        for ranks, what in ((3, "all"), (2, "nothing is left to do")):
            code, said = self.ended(self.start(["mpirun", "--oversubscribe", "-n", str(ranks), *self.campaign("out")]))
            self.assertEqual(code, 0, f"{what}: {said}")
            self.assertEqual(said.count("seed by seed"), 1, "one report")
        self.assert_alone("out")

    def test_a_refusal_ends_all_ranks(self):
        code, said = self.ended(self.start(["mpirun", "--oversubscribe", "-n", "2", *self.campaign("out"),
                                            "--set", "motion.damping=7"]))
        self.assertEqual(code, 2, said)
        self.assertEqual(said.count("error: "), 1, said)

    @unittest.skipUnless(importlib.util.find_spec("distributed"), "Dask is not installed")
    def test_dask(self):
        """One of two workers is killed in the middle of a run."""
        environment = os.environ | {"PYTHONPATH": str(BIN.parent / "python")}
        scheduler = self.start([sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard",
                                "--scheduler-file", "cluster.json"], env=environment)
        wait_until((self.folder / "cluster.json").exists, "the scheduler", scheduler)
        workers = [self.start([sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", "cluster.json",
                               "--nthreads", "1", "--no-nanny", "--no-dashboard"], env=environment) for _ in range(2)]
        leader = self.start(self.campaign("out", "--engine", "cluster.json"))
        wait_until(lambda: all_children(workers[0]) or leader.poll() is not None, "a run of the worker", workers[0])
        workers[0].kill()
        code, said = self.ended(leader)
        self.assertEqual(code, 0, said)
        self.assert_alone("out")

    def test_no_scheduler(self):
        self.assert_refused(self.run_command(self.campaign("out", "--engine", "pigeons")), "--engine pigeons",
                            "local, ", "mpi, ", "Dask")
        self.assertFalse((self.folder / "out").exists())

    def test_leader_ends(self):
        """Its runs end, too, with a checkpoint, and the same command continues."""
        for with_signal, expected in ((signal.SIGTERM, 130), (signal.SIGUSR1, 130), (signal.SIGKILL, -signal.SIGKILL)):
            folder = with_signal.name
            leader = self.start(self.campaign(folder, "--jobs", 2))
            wait_until(lambda: all_children(leader), "a run", leader)
            runs = all_children(leader)
            leader.send_signal(with_signal)
            self.assertEqual(self.ended(leader)[0], expected)
            wait_until(lambda: not any(os.path.exists(f"/proc/{run}") for run in runs), "the end of its runs")
            self.assert_done(self.run_command(self.campaign(folder)))
            self.assert_alone(folder)

    def test_killed_run(self):
        """It fails, the others do not, and the same command does it again."""
        leader = self.start(self.campaign("out"))
        wait_until(lambda: (self.folder / "out/runs/csr0.25_seed1").exists(), "the first test", leader)
        wait_until(lambda: all_children(leader), "a run", leader)
        for run in all_children(leader):
            with contextlib.suppress(ProcessLookupError):
                os.kill(run, signal.SIGKILL)
        code, said = self.ended(leader)
        if code != 0:  # or the run had ended by itself
            self.assertEqual(code, 1, said)
            self.assertRegex(said, re.compile("failed: .*exit code 137", re.S))
        self.assert_done(self.run_command(self.campaign("out")))
        self.assert_alone("out")

    def test_second_leader(self):
        leader = self.start(self.campaign("out"))
        wait_until(lambda: all_children(leader), "a run", leader)
        leader.send_signal(signal.SIGSTOP)
        self.assert_refused(self.run_command(self.campaign("out")), "another program is using it", "out")
        leader.send_signal(signal.SIGCONT)
        self.assertEqual(self.ended(leader)[0], 0)

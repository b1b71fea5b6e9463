#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Campaigns whose runs are shared by several processes, as on several nodes: ranks of mpirun, helpers that come later,
helpers that are killed, a leader that is stopped or killed. The tables are those of one process."""
import contextlib
import os
import signal
import subprocess

from calibrate_test import LABORATORY, SCENE as DRAINED, plan_text
from resistance_test import SHEAR
from support import TIME_LIMIT, AppTest, children, main, table, wait_until

os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
RATIOS = ("--ratios", "0.12,0.16,0.25", "-n", "2", "--cycles", "15", "--no-figures")


class CampaignRanks(AppTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("shear.toml", SHEAR)
        self.write("scene.toml", DRAINED)
        self.write("lab.csv", LABORATORY)
        self.plan = self.write("plan.toml", plan_text())

    def campaign(self, folder, *more):
        return self.command("liquefaction_resistance", self.scene, *RATIOS, "-o", folder, *more)

    def start(self, command):
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
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
            self.assert_done(self.run_app("liquefaction_resistance", self.scene, *RATIOS, "-o", "alone"))
            kept.write_bytes((self.folder / "alone/resistance.csv").read_bytes())
        return table(kept)

    def wait_for_a_run(self, process):
        wait_until(lambda: children(process), "a run of its own", process)
        self.assertTrue(children(process))

    def test_ranks(self):
        code, said = self.ended(self.start(["mpirun", "--oversubscribe", "-n", "3", *self.campaign("out")]))
        self.assertEqual(code, 0, said)
        self.assertEqual(table(self.folder / "out/resistance.csv"), self.alone())
        self.assertEqual(said.count("by this helper"), 2, said)
        self.assertNotIn("\nout: 0 runs done by this helper\nout: 0 runs", said)
        self.assertEqual(said.count("seed by seed"), 1, "one report")
        code, said = self.ended(self.start(["mpirun", "--oversubscribe", "-n", "2", *self.campaign("out")]))
        self.assertEqual(code, 0, "nothing is left to do: " + said)

    def test_calibration(self):
        self.assert_done(self.run_app("calibrate", self.plan, "--no-figures", "-o", "one"))
        code, said = self.ended(self.start(["mpirun", "--oversubscribe", "-n", "2", *self.command(
            "calibrate", self.plan, "--no-figures", "-o", "two")]))
        self.assertEqual(code, 0, said)
        self.assertEqual(table(self.folder / "two/trials.csv"), table(self.folder / "one/trials.csv"))

    def test_killed_helpers(self):
        """Each is killed, with the run it does or without, as soon as it does one; its runs are done by others. The
        leader does one run at a time: a busy machine starts helpers late, and some runs must remain for them."""
        leader, killed = self.start(self.campaign("out", "--jobs", 1)), 0
        while leader.poll() is None and killed < 4:
            helper = self.start(self.campaign("out", "--helper"))
            wait_until(lambda: children(helper) or leader.poll() is not None, "a run of the helper", helper)
            run = children(helper)
            helper.kill()
            if run:
                killed += 1
                if killed % 2:
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(run[0], signal.SIGKILL)
        self.assertGreaterEqual(killed, 2)
        code, said = self.ended(leader)
        self.assertEqual(code, 0, said)
        self.assertEqual(table(self.folder / "out/resistance.csv"), self.alone())

    def test_leader_ends(self):
        """Its helpers end, too, and the same command goes on."""
        for with_signal, expected in ((signal.SIGUSR1, 130), (signal.SIGKILL, -signal.SIGKILL)):
            leader, helper = self.start(self.campaign("out")), self.start(self.campaign("out", "--helper"))
            self.wait_for_a_run(helper)
            leader.send_signal(with_signal)
            self.assertEqual(self.ended(leader)[0], expected)
            code, said = self.ended(helper)
            self.assertEqual(code, 0, said)
        self.assert_done(self.run_app("liquefaction_resistance", self.scene, *RATIOS, "-o", "out"))
        self.assertEqual(table(self.folder / "out/resistance.csv"), self.alone())

    def test_helper_alone(self):
        result = self.run_app("liquefaction_resistance", self.scene, *RATIOS, "-o", "out", "--helper")
        self.assert_refused(result, "out/queue", "nobody leads", "without --helper")
        self.assertFalse((self.folder / "out").exists())

    def test_second_leader(self):
        leader = self.start(self.campaign("out"))
        self.wait_for_a_run(leader)
        leader.send_signal(signal.SIGSTOP)
        self.assert_refused(self.run_app("liquefaction_resistance", self.scene, *RATIOS, "-o", "out"), "at work", "out")
        leader.send_signal(signal.SIGCONT)
        self.assertEqual(self.ended(leader)[0], 0)


if __name__ == "__main__":
    main()

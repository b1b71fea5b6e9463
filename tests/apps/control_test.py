# SPDX-License-Identifier: BSD-3-Clause
"""A drained test whose sides cannot follow says so in summary, on stderr and in summary.json, or fails if it is
told to; a resumed run says the same."""
import signal

from support import AppTest, tiny_scene

DRAINED = '[[stage]]\nkind = "drained"\nstrain = 0.02\nstrain_rate = "{rate} 1/s"\n'
LOSS = "stage 0: sigma_x off its target by more than 1 %"


class Control(AppTest):
    def scene(self, rate):
        return self.write(f"scene_{rate}.toml", tiny_scene(stages=DRAINED.format(rate=rate)))

    def losses(self, folder):
        return self.summary_of(folder)["control_lost"]

    def test_a_test_that_keeps_its_stresses_says_nothing(self):
        result = self.run_test(self.scene(0.5), "-o", "slow")
        self.assert_done(result)
        self.assertNotIn("control lost", result.stderr + result.stdout)
        self.assertEqual(self.losses("slow"), [])

    def test_lost_control_is_told(self):
        result = self.run_test(self.scene(60), "-o", "fast")
        self.assert_done(result)
        self.assertIn("warning: control lost: " + LOSS, result.stderr)
        self.assertIn("control lost             " + LOSS, result.stdout)
        lost = [loss for loss in self.losses("fast") if loss["quantity"] == "sigma_x"]
        self.assertEqual(len(lost), 1)
        self.assertEqual(lost[0]["stage"], 0)
        self.assert_close(lost[0]["target"], 200e3, 0.01, "the pressure of the preparation, within the servo's 0.2 %")
        self.assertGreater(abs(lost[0]["worst"] / lost[0]["target"] - 1), 0.01)
        self.assertGreater(lost[0]["share"], 0.05)

    def test_lost_control_may_be_an_error(self):
        result = self.run_test(self.scene(60), "-o", "error", "--set", "control.on_loss=error")
        self.assertEqual(result.returncode, 1, result.stdout)
        for part in ("failed: step ", "control lost: " + LOSS, "control.on_loss", "checkpoint"):
            self.assertIn(part, result.stderr)

    def test_a_resumed_run_says_the_same(self):
        scene, often = self.scene(60), ("--set", "output.checkpoint=1e-9 min")
        self.assert_done(self.run_test(scene, "-o", "whole", *often))
        self.run_and_stop(0.05, signal.SIGKILL, (self.folder / "parts/checkpoint/last.h5", True), scene, "-o", "parts",
                          *often)
        self.assert_done(self.run_test(scene, "-o", "parts", "--resume", *often))
        self.assertEqual(self.losses("parts"), self.losses("whole"))

# SPDX-License-Identifier: BSD-3-Clause
"""A stage that its limit of steps ends says so in summary, on stderr, in summary.json and in the report; a resumed run
says the same; cycles are counted. Conditions that are met at once or never: tests/verification/path_ends_test.cpp."""
import signal

from report_support import page
from support import AppTest, columns, tiny_scene

PATH = '[[stage]]\nkind = "path"\nx.keep = "stress"\nz.keep = "stress"\n'
LIMITED = PATH + 'max_steps = 400\nuntil = { strain = 0.05, q = "150 kPa" }\n'
TEXT = ("stage 0 (path): ended by max_steps = 400 before any of its conditions was met: until.strain = 5 % (")
REST = '[[stage]]\nkind = "hold"\nbalance = 0.05\n'
CYCLIC_PATH = """[[stage]]
kind = "path"
x.keep = "volume"
z.keep = "volume"
turn = { low = "-30 kPa", high = "30 kPa" }
until = { cycles = 2, strain = 0.1 }
"""


class EarlyEnd(AppTest):
    def scene(self, name, stages):
        return self.write(f"{name}.toml", tiny_scene(stages=stages))

    def test_a_stage_that_its_limit_ended_says_so(self):
        result = self.run_test(self.scene("limited", LIMITED + REST), "-o", "limited")
        self.assert_done(result)
        self.assertIn("warning: " + TEXT, result.stderr)
        self.assertIn("ended early              " + TEXT, result.stdout)
        (end,) = self.summary_of("limited")["ended_early"]
        self.assertEqual((end["stage"], end["times"], end["at_once"]), (0, 1, False))
        self.assertIn("until.q = 150 kPa (", end["text"])

    def test_what_ended_a_stage_is_said(self):
        stages = PATH + 'max_steps = 400\nuntil.strain = 1e-4\n' + PATH + "max_steps = 50\n"
        result = self.run_test(self.scene("whole", stages), "-o", "whole")
        self.assert_done(result)
        self.assertNotIn("warning", result.stderr)
        self.assertNotIn("ended early", result.stdout)
        self.assertIn("ended                    stage 0 (path): ended by until.strain = 0.01 % (", result.stdout)
        self.assertIn("ended                    stage 1 (path): ended by max_steps = 50\n", result.stdout)
        numbers = self.summary_of("whole")
        self.assertEqual(numbers["ended_early"], [])
        self.assertEqual([(end["stage"], end["by"], end["early"]) for end in numbers["ended"]],
                         [(0, "strain", False), (1, "max_steps", False)])

    def test_a_default_that_comes_before_what_was_asked_for_is_named(self):
        stage = '[[stage]]\nkind = "undrained-cyclic"\ndeviator_amplitude = "40 kPa"\nuntil.cycles = 60\n'
        result = self.run_test(self.scene("default", stage), "-o", "default", "--set", "stage.0.until.strain=1e-4")
        self.assert_done(result)
        self.assertRegex(result.stdout, r"ended by until.strain = 0.01 % \(0.01\d* %\), before until.cycles = 60 "
                         r"\([\d.]+ reached\), until.reversals_after_liquefaction = 10 \(not liquefied\)")

    def test_a_resumed_run_says_the_same(self):
        stages, often = LIMITED + PATH + "until.strain = 0.005\n", ("--set", "output.checkpoint=0.0005 min")
        scene = self.scene("resumed", stages)
        self.assert_done(self.run_test(scene, "-o", "whole", *often))
        self.run_and_stop(0.05, signal.SIGKILL, (self.folder / "parts/checkpoint/last.h5", True), scene, "-o", "parts",
                          *often)
        self.assert_done(self.run_test(scene, "-o", "parts", "--resume", *often))
        self.assertEqual(self.summary_of("parts")["ended_early"], self.summary_of("whole")["ended_early"])
        self.assertEqual(len(self.summary_of("parts")["ended_early"]), 1)

    def test_cycles_of_a_path_have_a_response(self):
        result = self.run_test(self.scene("cyclic", CYCLIC_PATH), "-o", "cyclic")
        self.assert_done(result)
        self.assertIn("  cyclic response          ", result.stdout)
        response = self.summary_of("cyclic")["cyclic_response"]
        self.assertIn(response["name"],
                      ("flow", "limited flow", "cyclic mobility", "plastic strain accumulation", "no failure"))
        self.assertTrue(response["stress_reversal"])
        self.assert_near(response["load_max"], 30e3, 3e3, "what a step of 200 grains adds at a turn")

    def test_a_bias_that_cannot_hold_is_refused_when_the_scene_is_read(self):
        scene = self.scene("bias", CYCLIC_PATH.replace("-30 kPa", "10 kPa"))
        self.assert_refused(self.run_app("element_test", scene, "--validate"), "bias.toml:",
                            "stage.0.turn.low = 10 kPa", "isotropic consolidation to 200 kPa", "turn.high = 30 kPa")

    def test_cycles_of_stages_are_counted(self):
        stages = (PATH + "until.strain = 2e-4\n" + PATH +
                  'direction = "extension"\nuntil.strain = 2e-4\nmax_steps = 5\n'
                  '[[stage]]\nkind = "repeat"\nstages = 2\ntimes = 3\n')
        result = self.run_test(self.scene("cycles", stages), "-o", "cycles")
        self.assert_done(result)
        for part in ("stage 0 (path), cycle 2 of 3 of stages 0 to 1", "repeated                 stages 0 to 1, 3 times",
                     "stage 1 (path), cycle 1 of 3 of stages 0 to 1: ended by max_steps = 5", "3 times in all"):
            self.assertIn(part, result.stderr + result.stdout)
        rows = columns(self.folder / "cycles/history.csv")
        self.assertEqual(sorted(set(zip(rows["done"], rows["stage"]))),
                         [(0, 0), (1, 1), (2, 0), (3, 1), (4, 0), (5, 1)])
        report = page(self.folder / "cycles")
        self.assertIn("Stage 0, path, the last of 3 times:", report)
        self.assertIn("ended by max_steps = 5 before any of its conditions was met", report)

    def test_a_condition_that_is_met_when_it_begins_is_told(self):
        result = self.run_test(self.scene("met", PATH + 'until.p = "200 kPa"\n' + REST), "-o", "met")
        self.assert_done(result)
        self.assertIn("warning: stage 0 (path): ended in its first step, because one of its conditions was met when it "
                      "began: until.p = 200 kPa (", result.stderr)
        self.assertTrue(self.summary_of("met")["ended_early"][0]["at_once"])

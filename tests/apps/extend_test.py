# SPDX-License-Identifier: BSD-3-Clause
"""A test that has finished or was stopped continues to a later end, to the bits of one long run; what else differs in
its scene is refused, and what is there stays."""
import signal

from support import AppTest, contents, tiny_scene

STAGES = """[[stage]]
kind = "rebalance"
max_steps = 2500
[[stage]]
kind = "undrained-cyclic"
deviator_amplitude = "40 kPa"
until = { cycles = 2, reversals_after_liquefaction = 30 }
"""
CYCLES = "stage.1.until.cycles"


class Extend(AppTest):
    def setUp(self):
        super().setUp()
        self.scene = self.write("scene.toml", tiny_scene(stages=STAGES, output="energy = true"))

    def run_to(self, folder, cycles, *arguments):
        return self.run_test(self.scene, "-o", folder, "--set", f"{CYCLES}={cycles}", "--set", "output.folder=x",
                             *arguments)

    def test_a_finished_run_continues_to_the_same_bits(self):
        self.assert_done(self.run_to("whole", 4))
        self.assert_done(self.run_to("parts", 2))
        self.assertEqual(self.summary_of("parts")["reversals"], 4)
        stale = [self.folder / "parts" / name for name in ("figures/fig_fabric.png", "report.html")]
        own = self.folder / "parts/figures/mine.png"
        own.parent.mkdir()
        for path in (*stale, own):
            path.touch()
        result = self.run_to("parts", 4, "--resume")
        self.assert_done(result)
        self.assertIn("until.cycles = 4 (4 reached)", result.stdout)
        self.assertEqual([path.exists() for path in (*stale, own)], [False, False, True])
        own.unlink()
        self.assert_same_results("whole", "parts", but=("scene.toml",))
        one, other = self.summary_of("whole"), self.summary_of("parts")
        self.assertLess(other.pop("steps_since_resumed"), one.pop("steps_since_resumed"))
        for summary in (one, other):
            del summary["seconds"]
            summary["rows"] = [row for row in summary["rows"] if row[0] != "run"]
        self.assertEqual(one, other)
        self.assertEqual([(end["stage"], end["by"], end["early"]) for end in one["ended"]],
                         [(0, "balance", False), (1, "cycles", False)])

    def test_a_stopped_run_continues_to_a_later_end(self):
        self.assert_done(self.run_to("whole", 4))
        code = self.run_and_stop(0.05, signal.SIGTERM, (self.folder / "parts/provenance.txt", False), self.scene, "-o",
                                 "parts", "--set", f"{CYCLES}=3", "--set", "output.folder=x")
        self.assertEqual(code, 130, "it is still at work")
        self.assert_done(self.run_to("parts", 4, "--resume"))
        self.assert_same_results("whole", "parts", but=("scene.toml",))

    def test_repeats_continue(self):
        stages = """[[stage]]
kind = "path"
x.keep = "stress"
z.keep = "stress"
until.strain = 2e-4
[[stage]]
kind = "repeat"
times = 2
"""
        self.scene = self.write("repeats.toml", tiny_scene(stages=stages))

        def run(folder, *arguments):
            self.assert_done(self.run_test(self.scene, "-o", folder, "--set", "output.folder=x", *arguments))

        run("whole", "--set", "stage.1.times=4")
        run("parts")
        run("parts", "--set", "stage.1.times=4", "--resume")
        self.assert_same_results("whole", "parts", but=("scene.toml",))
        self.assert_refused(self.run_test(self.scene, "-o", "parts", "--set", "output.folder=x", "--set",
                                          "stage.1.times=3", "--resume"),
                            "stage.1.times = 3, but the checkpoint has 4: only a later end is possible")

    def test_all_else_is_refused_and_leaves_what_is_there(self):
        self.assert_done(self.run_to("out", 2))
        before = contents(self.folder / "out")
        self.assert_refused(self.run_to("out", 1, "--resume"),
                            "out: stage.1.until.cycles = 1, but the checkpoint has 2: only a later end is possible")
        self.assert_refused(self.run_to("out", 3, "--resume", "--set", "stage.0.max_steps=3000"),
                            "stage.0.max_steps = 3000, but the checkpoint has 2500: this stage is over")
        for key, value in (("stage.1.deviator_amplitude", "50 kPa"), ("motion.damping", "0.3"),
                           ("stage.1.liquefaction_ratio", "0.02"), ("output.record_steps", "70")):
            self.assert_refused(self.run_to("out", 3, "--resume", "--set", f"{key}={value}"),
                                "belongs to another scene", key.rpartition(".")[2])
        self.assertEqual(before, contents(self.folder / "out"))
        result = self.run_to("out", 2, "--resume")
        self.assert_done(result)
        self.assertIn("this run has finished", result.stdout)
        self.assertIn("a later end", result.stdout)

# SPDX-License-Identifier: BSD-3-Clause
"""Runs of element_test that are stopped, killed, resumed, or watched more or less closely continue to the same bits.
One machine as another that has fewer instructions: each set has its own bits, all the same test, and a run that
continues with another set than its checkpoint was written with says so."""
import os
import pathlib
import random
import re
import signal
import time

import h5py
import numpy as np

from column_support import history
from support import CYCLIC, MONOTONIC, REBALANCE, AppTest, contents, results, tiny_scene

STAGES = REBALANCE.format(steps=1500) + MONOTONIC.format(steps=4000) + CYCLIC.format(steps=6000)
EVERY_256_STEPS = ("--set", "output.checkpoint=1e-9 min")
OFTEN = ("--set", "output.checkpoint=0.001 min")  # each is waited for until it is on the disk


class Interrupted(AppTest):
    def use(self, text):
        self.scene = self.write("scene.toml", text)
        self.assert_done(self.run_test(self.scene, "-o", "prepare", "--set", "stage.0.max_steps=1", "--set",
                                       "stage.1.max_steps=1", "--set", "stage.2.max_steps=1"))  # fills the cache

    def whole(self, *more):
        begin = time.monotonic()
        self.assert_done(self.run_test(self.scene, "-o", "whole", *more))
        return time.monotonic() - begin

    def interrupt(self, with_signal, wanted_code, started_file, seconds, *more):
        """Three stops at random moments, then the rest; the first must have hit a running test."""
        moments = random.Random(20240229)
        arguments, codes = [self.scene, "-o", "parts", *more], []
        for _ in range(3):
            wait = moments.uniform(0.02, 0.25) * seconds
            codes.append(self.run_and_stop(wait, with_signal, started_file, *arguments))
            if codes[-1] == 0:
                break
            # a signal may come before a resumed program has begun: then nothing was lost either
            self.assertIn(codes[-1], {wanted_code, -with_signal})
            arguments = [self.scene, "-o", "parts", *more, "--resume"]
        self.assertEqual(codes[0], wanted_code)
        if codes[-1] != 0:
            result = self.run_test(*arguments)
            self.assert_done(result)
            if "--resume" in arguments:
                self.check_speed(result.stdout)
        self.assert_same_results("whole", "parts")

    def check_speed(self, text):
        """Steps/s of a resumed run count the steps of this run, not those before."""
        said = re.search(r"run +(\d+) steps, the last (\d+) in ([\d.]+) s \((\d+) steps/s\)", text)
        self.assertIsNotNone(said, text)
        steps, last, seconds, speed = map(float, said.groups())
        self.assertLess(last, steps)
        if seconds > 0.5:
            self.assert_near(speed * seconds, last, 0.2 * last, "seconds printed with one decimal")

    def kill(self):
        started = (self.folder / "parts/checkpoint/last.h5", True)
        self.interrupt(signal.SIGKILL, -signal.SIGKILL, started, self.whole(*OFTEN), *OFTEN)


class Resume(Interrupted):
    def setUp(self):
        super().setUp()
        self.use(tiny_scene(stages=STAGES, output="energy = true", motion="inertial_number = 1e-4"))

    def test_sigterm(self):
        started = (self.folder / "parts/provenance.txt", False)
        self.interrupt(signal.SIGTERM, 130, started, self.whole())

    def test_sigkill(self):
        self.kill()

    def test_sigkill_with_damaged_last_checkpoint(self):
        seconds = self.whole(*OFTEN)
        checkpoints = self.folder / "parts/checkpoint"
        self.run_and_stop(0.2 * seconds, signal.SIGKILL, (checkpoints / "previous.h5", True), self.scene, "-o", "parts",
                          *OFTEN)
        for name in ("fresh.h5", "last.h5"):
            if (checkpoints / name).exists():
                (checkpoints / name).write_bytes((checkpoints / name).read_bytes()[:5000])
        self.assert_done(self.run_test(self.scene, "-o", "parts", "--resume", *OFTEN))
        self.assert_same_results("whole", "parts")

    def test_resume_of_a_finished_run_changes_nothing(self):
        # the last step of every stage is one of the 256th, so the last checkpoint is one of a stage that has ended
        steps = [argument for stage, n in ((0, 512), (1, 1024), (2, 2048))
                 for argument in ("--set", f"stage.{stage}.max_steps={n}")]
        self.assert_done(self.run_test(self.scene, "-o", "out", *EVERY_256_STEPS, *steps))
        before = contents(self.folder / "out")
        self.assert_done(self.run_test(self.scene, "-o", "out", "--resume", *EVERY_256_STEPS, *steps))
        after = contents(self.folder / "out")
        self.assertEqual(before["history.csv"], after["history.csv"])
        self.assertEqual(sorted(n for n in before if n.startswith("snapshots")),
                         sorted(n for n in after if n.startswith("snapshots")))


class ResumeInACell(Interrupted):
    def test_sigkill_in_simple_shear(self):
        stage = '[[stage]]\nkind = "{}"\nmax_steps = 5000\n'
        stages = (REBALANCE.format(steps=1500) + stage.format("undrained-simple-shear") + "strain = 0.02\n" +
                  stage.format("undrained-cyclic-simple-shear") + "stress_ratio = 0.1\n")
        self.use(tiny_scene(specimen='domain = "periodic-cell"\npreparation_friction = "8 deg"', stages=stages,
                            output="energy = true", motion="inertial_number = 1e-4"))
        self.kill()

    def test_sigkill_of_a_cell_that_is_exchanged(self):
        """A cell of few grains is sheared by 120 %, exchanged for others of its lattice on the way."""
        stages = (REBALANCE.format(steps=2500) + '[[stage]]\nkind = "undrained-simple-shear"\nstrain = 1.2\n'
                  'strain_rate = "60 1/s"\n' + '[[stage]]\nkind = "undrained-cyclic-simple-shear"\n'
                  'stress_ratio = 0.1\nmax_steps = 4000\n')
        text = tiny_scene(specimen='domain = "periodic-cell"\npreparation_friction = "18 deg"', stages=stages,
                          output="energy = true", motion="inertial_number = 1e-4")
        self.use(text.replace("grains = 200", "grains = 70").replace("2.7 mm", "1.9129 mm"))
        self.kill()


class Output(AppTest):
    """Output never changes a trajectory."""

    def history(self, name, *options):
        scene = self.write("scene.toml", tiny_scene(stages=STAGES))
        arguments = [argument for option in options for argument in ("--set", option)]
        self.assert_done(self.run_test(scene, "-o", name, *arguments))
        with h5py.File(self.folder / name / "history.h5") as file:
            return {column: np.asarray(values) for column, values in file["history"].items()}

    def assert_same_trajectory(self, one, other):
        """All rows that both histories hold, by step: the recording itself may differ."""
        shared, rows, twins = np.intersect1d(one["step"], other["step"], return_indices=True)
        self.assertGreater(len(shared), 20)
        for column in one.keys() & other.keys():
            self.assertEqual(one[column][rows].tobytes(), other[column][twins].tobytes(), column)

    def test_on_or_off(self):
        full = self.history("full", "output.energy=true", "output.record_steps=10", "output.checkpoint=1e-9 min",
                            "output.snapshots=strain", "output.snapshot_strain=3e-5")
        self.assertIn("residual", full)
        bare = self.history("bare", "output.snapshots=none", "output.paraview=false", "output.checkpoint=24 h")
        self.assertEqual(sorted(p.name for p in (self.folder / "bare").iterdir()),
                         [".lock", "checkpoint", "history.csv", "history.h5", "provenance.txt", "scene.toml",
                          "summary.json", "summary.txt"])
        self.assertGreater(len(list(pathlib.Path(self.folder / "full/snapshots").iterdir())), 10)
        self.assert_same_trajectory(full, bare)


class InstructionSets(AppTest):
    def setUp(self):
        super().setUp()
        self.addCleanup(os.environ.pop, "ISOSTAT_INSTRUCTION_SET", None)
        self.scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=2000)))
        refused = self.run_on("MMX", "none")
        self.assert_refused(refused, "ISOSTAT_INSTRUCTION_SET = MMX; this machine has ", "unset it")
        self.sets = re.search(r"this machine has ([A-Z0-9_, ]+)\.", refused.stderr).group(1).split(", ")
        self.assertGreater(len(self.sets), 1)

    def run_on(self, instruction_set, folder, *arguments):
        os.environ["ISOSTAT_INSTRUCTION_SET"] = instruction_set
        return self.run_test(self.scene, *EVERY_256_STEPS, "-q", "-o", folder, *arguments)

    def test_one_test(self):
        """Round-off is all that differs; contacts that open and close make it grow."""
        rows = {}
        for name in self.sets:
            self.assert_done(self.run_on(name, name))
            self.assertIn(f"instruction set   {name}\n", (self.folder / name / "provenance.txt").read_text())
            rows[name] = history(self.folder / name)
        widest = rows[self.sets[0]]
        for name in self.sets[1:]:
            self.assertEqual(rows[name].keys(), widest.keys())
            for column in ("p", "q", "e"):
                off = np.abs(rows[name][column] - widest[column]).max() / np.abs(widest[column]).max()
                print(f"  {name:8} {column:10} {off:.1e}", flush=True)
                self.assert_below(off, 2e-4, "round-off that grows through 2,000 steps, to 2e-5 here")

    def test_continues(self):
        widest, other = self.sets[0], self.sets[-1]
        self.assert_done(self.run_on(other, "whole"))
        whole = results(self.folder / "whole")
        for folder, goes_on, noted in (("same", other, False), ("changed", widest, True)):
            os.environ["ISOSTAT_INSTRUCTION_SET"] = other
            code = self.run_and_stop(0, signal.SIGTERM, (self.folder / folder / "checkpoint/last.h5", True),
                                     self.scene, *EVERY_256_STEPS, "-o", folder)
            self.assertEqual(code, 130, "it is still at work")
            result = self.run_on(goes_on, folder, "--resume")
            self.assert_done(result)
            self.assertEqual(f"warning: the checkpoint was written with the instruction set {other}, this machine "
                             f"continues with {widest}: " in result.stderr, noted, result.stderr)
            self.assertEqual(results(self.folder / folder) == whole, not noted)

    def test_other_programs(self):
        os.environ["ISOSTAT_INSTRUCTION_SET"] = "MMX"
        self.assert_refused(self.run_app("isostat", "convert", "a", "b"), "MMX", *self.sets)

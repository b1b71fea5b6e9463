# SPDX-License-Identifier: BSD-3-Clause
"""Command lines drawn at random from the options of each program, with values that do and do not fit: a program ends
with 0, 1, 2 or 130 and says why, and leaves alone what is not its own.

ISOSTAT_COMMANDS  of each program (10)        ISOSTAT_SEED  draws others (1)
"""
import os
import random
import re
import signal
import subprocess

from failing_runs import COLUMN
from support import BIN, CYCLIC, TIME_LIMIT, AppTest, contents, tiny_scene

COMMANDS = int(os.environ.get("ISOSTAT_COMMANDS", "10"))
SEED = int(os.environ.get("ISOSTAT_SEED", "1"))
PROGRAMS = ("element_test", "soil_column", "library", "calibrate", "resistance",
            "ensemble", "micromechanics", "void_ratio_limits", "rve_replay", "isostat")
VALUES = ("", " ", "0", "1", "-1", "2", "1e300", "nan", "1e-300", "99999999999999999999", "0.2,0.3", "100 kPa", "0 kPa",
          "-5 kPa", "motion.damping=0.3", "motion.damping=", "=", "a.b.c=1", "stage.0.strain=nan", "stage.9.strain=1",
          "scene.toml", "column.toml", "done", "mine", "precious.txt", "new", "new/deeper", "..", ".", "/dev/null",
          "/proc/version", "done/history.h5", "broken.h5", "é\u202e$(touch pwned)", "`touch pwned`", "; touch pwned",
          "-h", "--", "x" * 300, "%s%n", "title=\"'\\\"\"", "undrained", "convert", "report", "yield", "s0001")
PATIENCE_OF_ONE = 1  # seconds; what runs longer is stopped


class RandomCommands(AppTest):
    def setUp(self):
        super().setUp()
        self.draw = random.Random(SEED)
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=200)))
        self.write("column.toml", COLUMN.replace('duration = "0.6 s"', 'duration = "0.05 s"'))
        self.assert_done(self.run_test(scene, "-o", "done", "-q"))
        (self.folder / "mine").mkdir()
        self.write("mine/thesis.txt", "of years")
        self.write("precious.txt", "as well")
        (self.folder / "broken.h5").write_bytes((self.folder / "done/history.h5").read_bytes()[:3000])

    def options(self, program):
        text = self.run_app(*program.split(), "--help").stdout
        return [*re.findall(r"(?<![\w-])--[a-z][\w-]+", text), "-o", "-q", "-n", "-j"]

    def call(self, program, words):
        """Exit code and what it said."""
        with self.started(self.command(*program.split(), *words), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          errors="replace") as process:
            try:
                said = process.communicate(timeout=PATIENCE_OF_ONE)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGTERM)
                said = process.communicate(timeout=TIME_LIMIT)
                if process.returncode == -signal.SIGTERM:
                    return 130, "stopped before it had begun"
        return process.returncode, said[0] + said[1]

    def test_each_program(self):
        guarded = {name: contents(self.folder)[name] for name in ("mine/thesis.txt", "precious.txt", "scene.toml",
                                                                  "column.toml", "broken.h5")}
        for program in PROGRAMS:
            if not (BIN / program.split()[0]).exists():
                continue
            options, codes = self.options(program), {}
            for _ in range(COMMANDS):
                words = [self.draw.choice(("scene.toml", "column.toml", "done"))] if self.draw.random() < 0.7 else []
                for _ in range(self.draw.randrange(5)):
                    words += [self.draw.choice(options)] if self.draw.random() < 0.7 else []
                    words += [self.draw.choice(VALUES)] if self.draw.random() < 0.7 else []
                if self.draw.random() < 0.8 and program != "isostat":
                    words += ["--no-figures"] if "--no-figures" in options else []
                with self.subTest(f"ISOSTAT_SEED={SEED}: {program} {words}"):
                    code, said = self.call(program, words)
                    codes[code] = codes.get(code, 0) + 1
                    self.assertIn(code, (0, 1, 2, 130), said)
                    self.assertGreater(len(said), 10)
                    self.assertNotRegex(said, "terminate called|what\\(\\)|Assertion|Traceback")
                    now = contents(self.folder)
                    self.assertEqual({name: now.get(name) for name in guarded}, guarded)
                    self.assertNotIn("pwned", {name.split("/")[-1] for name in now})
            print(f"  {program}: exit codes {codes}", flush=True)

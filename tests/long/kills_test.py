# SPDX-License-Identifier: BSD-3-Clause
"""Runs that are killed (SIGKILL) at random moments, again and again, and continue with another number of threads, jobs
or ranks: the final bytes are those of an undisturbed run. Not part of the usual tests: ctest --preset
long.

ISOSTAT_KILLS   of each program (20)          ISOSTAT_SEED    draws the same moments again
"""
import contextlib
import os
import random
import shutil
import signal
import subprocess
import time

from biaxial_test import CELL, FEW, FRICTION, GRAINS as BLOCK
from calibrate_test import LABORATORY, SCENE, plan_text
from column_support import settings
from failing_runs import COLUMN, SAVED
from grain_column_test import GRAINS as COLUMN_OF_GRAINS
from support import CYCLIC, ROOT, AppTest, children, results, tiny_scene

KILLS = int(os.environ.get("ISOSTAT_KILLS", "20"))
SEED = int(os.environ.get("ISOSTAT_SEED", time.time_ns() % 1000000))
ROW = 5  # kills until a run is left to its end
RANKS = ("mpirun", "--oversubscribe", "-n")


class Kills(AppTest):
    def setUp(self):
        super().setUp()
        self.draw = random.Random(SEED)

    def run_to(self, command, wait):
        """Whether it was killed, after `wait` s; 0: it is left alone, and must not fail."""
        with subprocess.Popen([str(word) for word in command], cwd=self.folder, start_new_session=True, text=True,
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as process:
            try:
                said = process.communicate(timeout=wait or None)[1]
            except subprocess.TimeoutExpired:
                ranks = children(process) if command[0] == "mpirun" else []  # which gives each a group of its own
                os.killpg(process.pid, signal.SIGKILL)
                for rank in ranks:
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(rank, signal.SIGKILL)
                process.communicate()
                return True
        self.assertEqual(process.returncode, 0, f"ISOSTAT_SEED={SEED}\n{said}")
        return False

    def kill(self, program, arguments, goes_on, others=(("--threads", (1, 2)),), ranks=(), ending=""):
        """@param goes_on   options of a call, from what is there
        @param others    options and their values, one of which each call has"""
        begin = time.monotonic()
        self.run_to([*self.command(program, *arguments), "-o", "whole" + ending], 0)
        whole, seconds = results(self.folder / ("whole" + ending)), time.monotonic() - begin
        killed = rows = at_work = 0
        parts = self.folder / ("parts" + ending)
        while killed < KILLS:
            shutil.rmtree(parts, ignore_errors=True)
            parts.unlink(missing_ok=True)
            for k in range(ROW + 1):
                command = [*self.command(program, *arguments), "-o", parts.name]
                for option, values in others:
                    command += [option, self.draw.choice(values)]
                command += goes_on(parts)
                if ranks:
                    command = [*RANKS, self.draw.choice(ranks), *command]
                if not self.run_to(command, self.draw.uniform(0.02, seconds) if k < ROW else 0):
                    break
                killed += 1
                at_work += parts.is_file() or any(parts.glob("**/checkpoint/*.h5"))
            found = results(parts)
            self.assertEqual(sorted(found), sorted(whole), f"ISOSTAT_SEED={SEED}")
            for name, data in found.items():
                self.assertEqual(data == whole[name], True, f"ISOSTAT_SEED={SEED}: {name} has changed")
            rows += 1
        print(f"  {program}: {killed} kills, {at_work} of them after a checkpoint, in {rows} runs, "
              f"{time.monotonic() - begin:.0f} s", flush=True)

    @staticmethod
    def folder_of_run(parts):
        """As a user does: from the checkpoint, or again."""
        if any(parts.glob("checkpoint/*.h5")):
            return ["--resume"]
        return ["--overwrite"] if parts.exists() else []

    def test_element_test(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=4000)))
        self.kill("element_test", (scene, *SAVED, "-q", "--no-figures"), self.folder_of_run)

    def test_library(self):
        scene = self.write("scene.toml", tiny_scene(specimen=CELL, stages="# none"))
        self.kill("isostat", ("library", scene, *FEW, "-n", 3, "-q"),
                  lambda parts: ["--append"] if parts.exists() else [], others=(("--jobs", (1, 2)),), ending=".h5")

    def test_resistance(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=2000)))
        self.kill("isostat", ("resistance", scene, "--ratios", "0.2,0.3", "-n", 2, *SAVED, "-q", "--no-figures"),
                  lambda parts: [], others=(("--jobs", (1, 2)),))

    def test_calibrate(self):
        for name, text in (("scene.toml", SCENE), ("lab.csv", LABORATORY)):
            self.write(name, text)
        self.kill("isostat", ("calibrate", self.write("plan.toml", plan_text(trials=4)), "-q", "--no-figures"),
                  lambda parts: [], others=(("--jobs", (1, 2)),))

    def test_soil_column(self):
        scene = self.write("column.toml", COLUMN.replace("0.6 s", "6 s"))  # else most kills come before a checkpoint
        self.kill("soil_column", (scene, *SAVED, "-q", "--no-figures"), self.folder_of_run, ranks=(1, 2, 3))

    def test_column_of_grains(self):
        scene = self.write("grains.toml", COLUMN_OF_GRAINS.format(cache=self.folder))
        library = ROOT / "apps/scenes/rve_library.toml"
        self.assert_done(self.run_app(
            "isostat", "library", library, "-o", "library.h5", "--pressures", "30 kPa", "-q",
            *settings(grading__grains=250, grading__cloud_edge="2.924 mm", specimen__density_tolerance=0.04)))
        self.run_to([*self.command("soil_column", scene), "-o", "first", "-q", "--no-figures"], 0)  # fills the cache
        self.kill("soil_column", (scene, "-q", "--no-figures"), self.folder_of_run, ranks=(1, 2, 3))

    def test_biaxial(self):
        self.kill("soil_column", (self.write("block.toml", FRICTION), *SAVED, "-q", "--no-figures"), self.folder_of_run)

    def test_block_of_grains(self):
        scene = self.write("rve.toml", tiny_scene(specimen=CELL, stages="# none"))
        self.assert_done(self.run_app("isostat", "library", scene, *FEW, "-n", "2", "-o", "library.h5", "-q"))
        self.kill("soil_column", (self.write("block.toml", BLOCK), *SAVED, "-q", "--no-figures"), self.folder_of_run)

# SPDX-License-Identifier: BSD-3-Clause
"""The program biaxial, stopped and started again: the same files, whatever stopped it."""
import shutil
import signal

from biaxial_test import CELL, FEW, GRAINS
from column_support import SCENES, ColumnTest, settings
from support import tiny_scene

SAVED = settings(output__checkpoint="1e-9 min")
SOFTENING = SCENES.parent / "biaxial/mohr_coulomb.toml"
SMALL = settings(mesh__cells_across=4, mesh__cells_up=8, weak__cells=1, nonlocal__length="0.08 m", test__steps=15,
                 output__map_every=2)


class Resume(ColumnTest):
    def whole(self, scene, *options):
        self.assert_done(self.run_app("biaxial", scene, "-o", "whole", "--no-figures", "-q", *options))

    def goes_on(self, scene, *options):
        self.assert_done(self.run_app("biaxial", scene, "-o", "parts", "--no-figures", "-q", "--resume", *options))
        self.assert_same_files("whole", "parts")

    def test_a_softening_block_with_a_length(self):
        options = (*SMALL, *SAVED)
        self.whole(SOFTENING, *options)
        for how in (signal.SIGKILL, signal.SIGTERM):
            shutil.rmtree(self.folder / "parts", ignore_errors=True)
            said = self.stop_when_saved(SOFTENING, how, "-q", *options, program="biaxial")
            if how == signal.SIGTERM:
                self.assertIn("continue with --resume", said)
            self.assertFalse((self.folder / "parts/summary.json").exists())
            self.goes_on(SOFTENING, *options)
        again = self.run_app("biaxial", SOFTENING, "-o", "parts", "--no-figures", "--resume", *options)
        self.assertIn("has finished", again.stdout)
        other = self.run_app("biaxial", SOFTENING, "-o", "parts", "--resume", *options, *settings(weak__row=1))
        self.assert_refused(other, "another scene", "row")

    def test_an_undrained_block(self):
        options = (*SMALL, *SAVED, *settings(water__drainage="undrained", mesh__points=3,
                                             water__permeability="1e-9 m/s"))
        self.whole(SOFTENING, *options)
        self.stop_when_saved(SOFTENING, signal.SIGKILL, "-q", *options, program="biaxial")
        self.goes_on(SOFTENING, *options)
        calls = (self.folder / "parts/provenance.txt").read_text(encoding="utf-8").split("\n\n")
        self.assertEqual(["--resume" in call for call in calls], [False, True], "each call is recorded")

    def test_a_failed_run_has_not_finished(self):
        options = (*SMALL, *SAVED, *settings(newton__relaxation_iterations=1))
        for more in ((), ("--resume",)):
            result = self.run_app("biaxial", SOFTENING, "-o", "out", "--no-figures", "-q", *options, *more)
            self.assertEqual(result.returncode, 1, result.stderr)
            self.assertIn("relaxation has not come to rest", result.stderr)

    def test_packings_on_other_threads(self):
        scene = self.write("rve.toml", tiny_scene(specimen=CELL, stages="# none"))
        self.assert_done(self.run_app("isostat", "library", scene, *FEW, "-o", "library.h5"))
        block = self.write("block.toml", GRAINS.replace("steps = 2", "steps = 6"))
        options = (*SAVED, *settings(nonlocal__length="0.5 m", newton__max_iterations=0,
                                     newton__relaxation_iterations=300))
        self.whole(block, *options)
        self.stop_when_saved(block, signal.SIGKILL, "-q", *options, program="biaxial")
        self.assertFalse((self.folder / "parts/summary.json").exists())
        self.goes_on(block, "--threads", "2", *options)
        summary = self.summary_of("parts")
        self.assertTrue(summary["complete"])

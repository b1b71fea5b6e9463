# SPDX-License-Identifier: BSD-3-Clause
"""One machine as another that has fewer instructions: each set its own bits, all the same test, and a run that goes on
with another set than its checkpoint was written with says so."""
import os
import re
import signal

import numpy as np

from column_support import history
from support import CYCLIC, AppTest, results, tiny_scene

SAVED = ("--set", "output.checkpoint=1e-9 min", "--no-figures", "-q")


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
        return self.run_app("element_test", self.scene, *SAVED, "-o", folder, *arguments)

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

    def test_goes_on(self):
        widest, other = self.sets[0], self.sets[-1]
        self.assert_done(self.run_on(other, "whole"))
        whole = results(self.folder / "whole")
        for folder, goes_on, noted in (("same", other, False), ("changed", widest, True)):
            os.environ["ISOSTAT_INSTRUCTION_SET"] = other
            code = self.run_and_stop(0, signal.SIGTERM, (self.folder / folder / "checkpoint/last.h5", True),
                                     self.scene, *SAVED[:2], "-o", folder)
            self.assertEqual(code, 130, "it is still at work")
            result = self.run_on(goes_on, folder, "--resume")
            self.assert_done(result)
            self.assertEqual(f"warning: the checkpoint was written with the instruction set {other}, this machine goes "
                             f"on with {widest}: " in result.stderr, noted, result.stderr)
            self.assertEqual(results(self.folder / folder) == whole, not noted)

    def test_other_programs(self):
        os.environ["ISOSTAT_INSTRUCTION_SET"] = "MMX"
        self.assert_refused(self.run_app("isostat", "convert", "a", "b"), "MMX", *self.sets)

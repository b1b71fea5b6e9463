#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""A number in a checkpoint that is none, or infinite, each of them in turn, and members that are wrong: the run does
not go on from it, says where it is, and takes the checkpoint before where that is whole. ISOSTAT_EVERY_CALL=1 tries
both with each number; otherwise the one and the other take turns."""
import shutil
import signal

import h5py
import numpy as np

from biaxial_test import FRICTION
from failing_runs import COLUMN, EVERY, SAVED
from support import CYCLIC, AppTest, contents, main, results, tiny_scene

QUIET = ("-q", "--no-figures")
FOR_OTHERS = ("state/grains/mass", "state/grains/inertia")  # their inverses stand beside velocities


def numbers_of(path):
    """Items that hold numbers with a point: (object, attribute or None)."""
    found = []

    def visit(name, item):
        if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" and item.size > 0:
            found.append((name, None))
        found.extend((name, key) for key, value in item.attrs.items() if np.asarray(value).dtype.kind == "f")

    with h5py.File(path) as file:
        file.visititems(visit)
        visit("/", file)
    return found


def damage(path, item, attribute, value):
    with h5py.File(path, "r+") as file:
        if attribute:
            file[item].attrs.modify(attribute, np.float64(value))
        else:
            values = file[item][()]
            values.flat[values.size // 2] = value
            file[item][...] = values


class DamagedCheckpoints(AppTest):
    def stopped(self, program, arguments):
        """The folder of a run that was stopped."""
        code = self.run_and_stop(0.05, signal.SIGTERM, (self.folder / "parts/checkpoint/previous.h5", True), *arguments,
                                 "-o", "parts", program=program)
        self.assertEqual(code, 130, "it is still at work")
        return self.folder / "parts"

    def damage_each(self, program, *arguments):
        arguments = (*arguments, *SAVED, *QUIET)
        parts = self.stopped(program, arguments)
        items = [item for item in numbers_of(parts / "checkpoint/last.h5") if item[0] not in FOR_OTHERS]
        self.assertGreater(len(items), 5)
        out = self.folder / "out"
        counts = {}
        for i, (item, attribute) in enumerate(items):
            for value in (np.nan, np.inf) if EVERY else ((np.nan, np.inf)[i % 2],):
                with self.subTest(program=program, item=item, attribute=attribute, value=value):
                    shutil.rmtree(out, ignore_errors=True)
                    shutil.copytree(parts, out)
                    (out / "checkpoint/previous.h5").unlink()
                    damage(out / "checkpoint/last.h5", item, attribute, value)
                    before = contents(out)
                    result = self.run_app(program, *arguments, "-o", "out", "--resume")
                    counts[value, result.returncode] = counts.get((value, result.returncode), 0) + 1
                    self.assert_refused(result, "last.h5")
                    self.assertEqual(contents(out), before)
        print(f"  {program}: {len(items)} items, (value, exit code): {counts}", flush=True)
        return parts

    def refuse_each(self, program, arguments, parts, changes):
        """@param changes   function of the open checkpoint -> what is said"""
        out = self.folder / "out"
        for change, said in changes.items():
            with self.subTest(program=program, said=said):
                shutil.rmtree(out, ignore_errors=True)
                shutil.copytree(parts, out)
                (out / "checkpoint/previous.h5").unlink()
                with h5py.File(out / "checkpoint/last.h5", "r+") as file:
                    change(file)
                before = contents(out)
                result = self.run_app(program, *arguments, *SAVED, *QUIET, "-o", "out", "--resume")
                self.assert_refused(result, said)
                self.assertEqual(contents(out), before)

    def test_members_of_an_element_test(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=2000)))
        parts = self.stopped("element_test", (scene, *SAVED, *QUIET))

        def ends_at(file, stage):
            end = file["drive/early_ends"].create_group("0")
            end.attrs.update({name: np.uint64(0) for name in ("stage", "done", "step", "times", "at_once")})
            end.attrs["stage"] = np.uint64(stage)
            figures = end.create_group("figures")
            names = ("driven", "strain", "volumetric", "p", "q", "unbalanced", "stress_error", "place")
            figures.attrs.update({name: 1.0 for name in names})
            figures.attrs.update({name: np.uint64(0) for name in ("reversals", "own_reversals")})

        def lost(file, quantity):
            loss = file["drive/control/losses"].create_group("0")
            loss.attrs.update({"stage": np.uint64(0), "done": np.uint64(0), "quantity": np.uint64(quantity),
                               "share": 1.0})
            deviation = loss.create_group("deviation")
            deviation.attrs.update({name: 1.0 for name in ("strain", "worst", "value", "target", "began")})
            deviation.attrs.update({"step": np.uint64(0), "told": np.uint64(1)})

        def number(item, name, value):
            return lambda file: file[item].attrs.modify(name, np.uint64(value))

        self.refuse_each("element_test", (scene,), parts, {
            lambda file: ends_at(file, 1): "speaks of stages beyond the 1 of the scene",
            number("drive/place", "stage", 2): "speaks of stages beyond the 1 of the scene",
            lambda file: lost(file, 5): "@quantity = 5, expected at most 4",
            number("drive/loading", "direction", 2): "@direction = 2, expected at most 1",
            lambda file: file["assembly"].attrs.__delitem__("energy_sliding"): "holds no assembly/@energy_sliding"})

    def test_members_of_a_soil_column(self):
        scene = self.write("column.toml", COLUMN.replace("0.6 s", "6 s"))
        parts = self.stopped("soil_column", (scene, *SAVED, *QUIET))

        def longer(name):
            def change(file):
                values = file[f"vectors/{name}"][()]
                del file[f"vectors/{name}"]
                file[f"vectors/{name}"] = np.append(values, 0.)
            return change

        self.refuse_each("soil_column", (scene,), parts, {
            longer(name): f"{name} are " for name in ("peak_gamma", "peak_line_ru", "peak_acceleration",
                                                      "waiting_rows")})

    def test_element_test(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=2000)))
        parts = self.damage_each("element_test", scene)
        damage(parts / "checkpoint/last.h5", "state/grains/velocity", None, np.nan)
        result = self.run_app("element_test", scene, *SAVED, *QUIET, "-o", "parts", "--resume")
        self.assert_done(result)
        self.assertRegex(result.stderr, r"warning:\n.*last.h5: grain \d+ \(id \d+\) has a value of nan in its velocity")
        self.assertIn("goes on from the checkpoint before", result.stderr)
        self.assert_done(self.run_app("element_test", scene, *SAVED, *QUIET, "-o", "whole"))
        self.assertEqual(results(parts), results(self.folder / "whole"))

    def test_soil_column(self):
        self.damage_each("soil_column", self.write("column.toml", COLUMN.replace("0.6 s", "6 s")))

    def test_biaxial(self):
        self.damage_each("biaxial", self.write("block.toml", FRICTION), "--set", "test.steps=2000")


if __name__ == "__main__":
    main()

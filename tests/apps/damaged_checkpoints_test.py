# SPDX-License-Identifier: BSD-3-Clause
"""A number in a checkpoint that is none, or infinite, and members that are wrong: the run does not continue from it,
says where it is, and takes the checkpoint before where that is whole. Here some of the numbers, alternately the one and
the other; ISOSTAT_EVERY_CALL=1 tries both with each number."""
import functools
import shutil
import signal

import h5py
import numpy as np

from biaxial_test import FRICTION
from failing_runs import COLUMN, EVERY, SAVED
from support import CYCLIC, AppTest, contents, tiny_scene

QUIET = ("-q", "--no-figures")
FOR_OTHERS = ("state/grains/mass", "state/grains/inertia")  # their inverses are next to velocities


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


def damage(file, item, attribute, value):
    if attribute:
        file[item].attrs.modify(attribute, np.float64(value))
    else:
        values = file[item][()]
        values.flat[values.size // 2] = value
        file[item][...] = values


class DamagedCheckpoints(AppTest):
    def stopped(self, program, arguments):
        """The folder of a run that was stopped."""
        code = self.run_and_stop(0.02, signal.SIGTERM, (self.folder / "parts/checkpoint/previous.h5", True), *arguments,
                                 "-o", "parts", program=program)
        self.assertEqual(code, 130, "it is still at work")
        return self.folder / "parts"

    def refuse(self, program, arguments, parts, change, said):
        """@param change   of the last checkpoint of the run in `parts`, which is open, the only one"""
        out = self.folder / "out"
        shutil.rmtree(out, ignore_errors=True)
        shutil.copytree(parts, out)
        (out / "checkpoint/previous.h5").unlink()
        with h5py.File(out / "checkpoint/last.h5", "r+") as file:
            change(file)
        before = contents(out)
        self.assert_refused(self.run_app(program, *arguments, "-o", "out", "--resume"), said)
        self.assertEqual(contents(out), before)

    def damage_each(self, program, *arguments):
        arguments = (*arguments, *SAVED, *QUIET)
        parts = self.stopped(program, arguments)
        items = [item for item in numbers_of(parts / "checkpoint/last.h5") if item[0] not in FOR_OTHERS]
        self.assertGreater(len(items), 5)
        tried = items if EVERY else items[::-(-len(items) // 9)]
        for i, item in enumerate(tried):
            for value in (np.nan, np.inf) if EVERY else ((np.nan, np.inf)[i % 2],):
                with self.subTest(program=program, item=item, value=value):
                    self.refuse(program, arguments, parts, lambda file, x=(*item, value): damage(file, *x), "last.h5")
        print(f"  {program}: {len(tried)} of {len(items)} items", flush=True)
        return parts

    def test_members_of_an_element_test(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=6000)))
        arguments = (scene, *SAVED, *QUIET)
        parts = self.stopped("element_test", arguments)

        def ends_at(file, stage):
            end = file["drive/ends"].create_group("0")
            end.attrs.update({name: np.uint64(0) for name in ("stage", "done", "step", "times", "at_once", "by")})
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

        beyond = "names stages beyond the 1 of the scene"
        for change, said in ((lambda file: ends_at(file, 1), beyond), (number("drive/place", "stage", 2), beyond),
                             (lambda file: lost(file, 5), "@quantity = 5, expected at most 4"),
                             (number("drive/loading", "direction", 2), "@direction = 2, expected at most 1"),
                             (lambda file: file["assembly"].attrs.__delitem__("energy_sliding"),
                              "holds no assembly/@energy_sliding")):
            with self.subTest(said):
                self.refuse("element_test", arguments, parts, change, said)

    def test_a_folder_in_place_of_the_last_checkpoint(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=6000)))
        arguments = (scene, *SAVED, *QUIET)
        last = self.stopped("element_test", arguments) / "checkpoint/last.h5"
        last.unlink()
        last.mkdir()
        self.assert_refused(self.run_app("element_test", *arguments, "-o", "parts", "--resume"),
                            "last.h5: is a folder, in place of a checkpoint. Move it away.")

    def test_an_edge_without_length(self):
        """Finite, and so taken: its logarithm is not."""
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=6000)))
        arguments = (scene, *SAVED, *QUIET)
        checkpoint = self.stopped("element_test", arguments) / "checkpoint"
        (checkpoint / "previous.h5").unlink()
        with h5py.File(checkpoint / "last.h5", "r+") as file:
            file["drive/path/start"].attrs["edges_x"] = 0.0
        result = self.run_app("element_test", *arguments, "-o", "parts", "--resume")
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertRegex(result.stderr, r"history.csv: eps_x = -?inf in row \d+; the run has gone wrong, or continued")

    def test_members_of_a_soil_column(self):
        scene = self.write("column.toml", COLUMN.replace("0.6 s", "6 s"))
        arguments = (scene, *SAVED, *QUIET)
        parts = self.stopped("soil_column", arguments)

        def lengthen(name, file):
            values = file[f"vectors/{name}"][()]
            del file[f"vectors/{name}"]
            file[f"vectors/{name}"] = np.append(values, 0.)

        for name in ("peak_gamma", "peak_line_ru", "peak_acceleration", "peak_velocity", "waiting_rows",
                     "motion_bands"):
            with self.subTest(name):
                self.refuse("soil_column", arguments, parts, functools.partial(lengthen, name), f"{name} are ")

        def soil(place, file):
            """A number of the soil, which is kept as bytes."""
            words = file["material"][()]
            data = bytearray(words.tobytes())
            begin = data.rindex(b"iwan") + len("iwan") + 8 * place
            data[begin:begin + 8] = np.float64(np.nan).tobytes()
            file["material"][...] = np.frombuffer(data, words.dtype)

        for place in (40, 520):
            with self.subTest(place):
                self.refuse("soil_column", arguments, parts, functools.partial(soil, place), "is not finite")

    def test_element_test(self):
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=6000)))
        parts = self.damage_each("element_test", scene)
        with h5py.File(parts / "checkpoint/last.h5", "r+") as last:
            damage(last, "state/grains/velocity", None, np.nan)
        result = self.run_app("element_test", scene, *SAVED, *QUIET, "-o", "parts", "--resume")
        self.assert_done(result)
        self.assertRegex(result.stderr, r"warning: damaged checkpoint:\n.*last.h5: grain \d+ \(id \d+\) has a value of "
                                        "nan in its velocity")
        self.assertIn("continues from the checkpoint before", result.stderr)
        self.assert_done(self.run_app("element_test", scene, *SAVED, *QUIET, "-o", "whole"))
        self.assert_same_results("parts", "whole")

    def test_soil_column(self):
        self.damage_each("soil_column", self.write("column.toml", COLUMN.replace("0.6 s", "6 s")))

    def test_a_link_in_a_history(self):
        """It is left out: what it leads to may be of others."""
        scene = self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=6000)))
        parts = self.stopped("element_test", (scene, *SAVED, *QUIET))
        with h5py.File(self.folder / "others.h5", "w") as others:
            others["secret"] = np.arange(3.)
        links = {"soft": h5py.SoftLink("/history/p"),
                 "out": h5py.ExternalLink(str(self.folder / "others.h5"), "/secret")}
        with h5py.File(parts / "history.h5", "r+") as history:
            for name, link in links.items():
                history[name] = link
        self.assert_done(self.run_app("element_test", scene, *SAVED, *QUIET, "-o", "parts", "--resume"))
        self.assertNotIn(b"secret", (parts / "history.h5").read_bytes())
        checkpoint = parts / "checkpoint/last.h5"
        with h5py.File(checkpoint, "r+") as file:
            file["written"].attrs["snapshots"] = np.uint64(2**33)
        (parts / "summary.txt").unlink()
        self.assert_refused(self.run_app("element_test", scene, *SAVED, *QUIET, "-o", "parts", "--resume"),
                            "counts 8589934592 snapshots and ")

    def test_files_that_a_loss_of_power_leaves(self):
        """Zeros at the end of the last checkpoint, and no more than a part of the table: the run continues."""
        for program, scene, more in (
                ("element_test", self.write("scene.toml", tiny_scene(stages=CYCLIC.format(steps=6000))), ()),
                ("soil_column", self.write("column.toml", COLUMN.replace("0.6 s", "6 s")), ())):
            arguments = (scene, *more, *SAVED, *QUIET)
            with self.subTest(program):
                self.assert_done(self.run_app(program, *arguments, "-o", "whole"))
                parts = self.stopped(program, arguments)
                last, table = parts / "checkpoint/last.h5", parts / "history.csv"
                last.write_bytes(last.read_bytes()[:-500] + bytes(500))
                table.write_bytes(table.read_bytes()[:200] + bytes(100))
                result = self.run_app(program, *arguments, "-o", "parts", "--resume")
                self.assert_done(result)
                self.assertRegex(result.stderr, "last.h5: damaged: .* its check sum is lost")
                self.assert_same_results("parts", "whole")
            shutil.rmtree(self.folder / "parts")
            shutil.rmtree(self.folder / "whole")

    def test_biaxial(self):
        self.damage_each("soil_column", self.write("block.toml", FRICTION), "--set", "analysis.load_steps=2000")

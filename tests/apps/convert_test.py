#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""isostat convert: packings of other programs in and out, what is refused, and the same guard in scenes."""
import os
import shutil

import h5py
import numpy as np

from support import AppTest, REBALANCE, main, tiny_scene

ENDINGS = ("dump", "data", "txt", "csv", "vtp", "h5")
LATTICE = [(x, y, z) for x in (0.3, 0.9, 1.5) for y in (0.3, 0.9, 1.5) for z in (0.3, 0.9, 1.5)]  # mm, touching


class Convert(AppTest):
    def convert(self, *arguments):
        return self.run_app("isostat", "convert", *arguments)

    def lattice(self, name, unit=1e-3, radius=0.3, box=1.8):
        rows = [" ".join(repr(unit * v) for v in (*centre, radius)) for centre in LATTICE]
        return self.write(name, f"# box 0 {unit * box!r} 0 {unit * box!r} 0 {unit * box!r}\n" + "\n".join(rows) + "\n")

    def positions(self, name):
        with h5py.File(self.folder / name) as file:
            return np.array(file["snapshot/grains/position"])

    def refuse(self, source, *parts, options=()):
        self.assert_refused(self.convert(source, "out.h5", *options), *parts)
        self.assertFalse((self.folder / "out.h5").exists())

    def test_values_of_another_file(self):
        """External storage, links and virtual datasets: a file of a stranger would name any file of the reader's."""
        self.assert_done(self.convert(self.lattice("a.txt"), "other.h5"))
        (self.folder / "secret").write_bytes(bytes(8 * 27))
        os.mkfifo(self.folder / "fifo")

        def external(group, name):
            group.create_dataset("id", (27,), "<u8", external=[(name, 0, 8 * 27)])

        def virtual(group):
            layout = h5py.VirtualLayout((27,), "<u8")
            layout[:] = h5py.VirtualSource("other.h5", "snapshot/grains/id", (27,))
            group.create_virtual_dataset("id", layout)

        def link(group, name):
            group["id"] = h5py.ExternalLink(name, "/snapshot/grains/id")

        for put, said in ((lambda group: external(group, "secret"), "in another file, which is not read"),
                          (lambda group: external(group, "fifo"), "in another file, which is not read"),
                          (virtual, "in another file, which is not read"),
                          (lambda group: link(group, "other.h5"), "is a link to another file, which is not followed"),
                          (lambda group: link(group, "fifo"), "is a link to another file, which is not followed")):
            shutil.copy(self.folder / "other.h5", self.folder / "theirs.h5")
            with h5py.File(self.folder / "theirs.h5", "r+") as file:
                del file["snapshot/grains/id"]
                put(file["snapshot/grains"])
            self.refuse("theirs.h5", "theirs.h5", said)

    def test_there_and_back_to_the_bit(self):
        result = self.convert(self.lattice("a.txt"), "a.h5")
        self.assert_done(result)
        for part in ("grains           27", "d50              0.6 mm", "1.8 x 1.8 x 1.8 mm", "largest overlap"):
            self.assertIn(part, result.stdout)
        for ending in ENDINGS:
            self.assert_done(self.convert("a.h5", f"b.{ending}"))
            self.assert_done(self.convert(f"b.{ending}", "back.h5", "--overwrite"))
            np.testing.assert_array_equal(self.positions("back.h5"), self.positions("a.h5"), ending)

    def test_millimetres_read_as_metres(self):
        self.lattice("mm.txt", unit=1)
        self.refuse("mm.txt", "largest radius is 0.3 m", "in mm? If so, give --length-unit mm")
        self.assert_done(self.convert("mm.txt", "mm.h5", "--length-unit", "mm"))
        self.assert_done(self.convert("mm.txt", "scaled.h5", "--scale", "1e-3"))
        np.testing.assert_array_equal(self.positions("scaled.h5"), self.positions("mm.h5"))
        self.lattice("m.txt")
        self.assert_done(self.convert("m.txt", "m.h5"))
        self.assert_close(self.positions("mm.h5"), self.positions("m.h5"), 1e-15, "one rounding")
        self.refuse("m.txt", "clay", options=("--scale", "1e-6"))

    def test_what_is_no_packing(self):
        self.refuse(self.lattice("deep.txt", radius=0.4), "overlap by 50 %", "diameters")
        self.refuse(self.lattice("small_box.txt", box=1.2), "centre", "outside the box")
        self.refuse(self.lattice("narrow.txt", box=1.65), "beyond a wall", "50 %")
        self.refuse(self.lattice("um.txt", unit=1000), "--length-unit um")
        self.refuse(self.write("history.csv", "step (-),time (s),p (Pa),q (Pa),e (-)\n1,0.1,2e5,0,0.7\n"),
                    "history.csv:2", "has not a column x", "Is it a packing?")
        self.refuse("nowhere.txt", "nowhere.txt")
        self.refuse(self.write("empty.dump", ""), "empty.dump", "no spheres")
        self.assert_done(self.convert("deep.txt", "deep.h5", "--anyway"))

    def test_command_line(self):
        self.lattice("a.txt")
        self.assert_refused(self.convert("a.txt", "out.pdb"), "out.pdb", "lammps-dump")
        self.assert_refused(self.convert("a.txt", "a.txt"), "exists", "--overwrite")
        self.assert_refused(self.convert("a.txt", "out.h5", "--length-unit", "inch"), "--length-unit", "inch")
        self.assert_done(self.convert("a.txt", "out", "--to", "csv"))
        result = self.convert("a.txt", "cell.txt", "--domain", "periodic-cell")
        self.assert_done(result)
        self.assertIn("# cell 0.0018", (self.folder / "cell.txt").read_text(encoding="utf-8"))
        self.assertIn("warning: YADE", result.stderr)
        self.assert_refused(self.convert("cell.txt", "out.h5", "--domain", "rigid-box"), "domain rigid-box")

    def test_scenes_have_the_same_guard(self):
        self.lattice("mm.txt", unit=1)
        self.lattice("deep.txt", radius=0.4)
        for name, words in (("mm.txt", ("largest radius", "isostat convert", "--length-unit mm")),
                            ("deep.txt", ("overlap by 50 %",))):
            scene = self.write("scene.toml", tiny_scene(specimen=f'file = "{name}"',
                                                        stages=REBALANCE.format(steps=100)))
            result = self.run_test(scene, "-o", "out", "--overwrite", "--quiet")
            self.assertEqual(result.returncode, 2, result.stderr)
            for word in words:
                self.assertIn(word, result.stderr)


class Snapshots(AppTest):
    def test_a_snapshot_starts_a_run(self):
        scene = self.write("first.toml", tiny_scene(stages='[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.001\n'))
        self.assert_done(self.run_test(scene, "-o", "first", "--quiet"))
        snapshot = "first/snapshots/snapshot_0001.h5"
        again = self.write("again.toml", tiny_scene(specimen=f'file = "{snapshot}"', motion='strain_rate = "2 1/s"',
                                                    stages='[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.001\n'))
        self.assert_done(self.run_test(again, "-o", "again", "--quiet"))
        one, other = (np.genfromtxt(self.folder / run / "history.csv", delimiter=",", names=True)
                      for run in ("first", "again"))
        self.assert_close(other["p_Pa"][0], one["p_Pa"][-1], 0.02, "a step of the second run lies between them")
        self.assert_near(other["eps_y_"][0], 0, 1e-5, "strain counts from the start of the run: one step")
        self.assert_near(other["time_s"][0], 0, 1e-4, "so does time")
        self.assert_done(self.run_app("isostat", "convert", snapshot, "snapshot.csv"))


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: BSD-3-Clause
"""isostat convert: packings of other programs in and out, what is refused, and scenes, which refuse such files."""
import math
import os
import shutil

import h5py
import numpy as np

from support import AppTest, columns, tiny_scene

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
        """External storage, links and virtual datasets: an untrusted file could name any file of the reader's."""
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

    def test_millimetres_read_as_metres(self):
        self.lattice("mm.txt", unit=1)
        self.refuse("mm.txt", "largest radius is 0.3 m", "in mm? If so, give --length-unit mm")
        self.assert_done(self.convert("mm.txt", "mm.h5", "--length-unit", "mm"))
        self.assert_done(self.convert("mm.txt", "scaled.h5", "--scale", "1e-3"))
        np.testing.assert_array_equal(self.positions("scaled.h5"), self.positions("mm.h5"))
        self.lattice("m.txt")
        result = self.convert("m.txt", "m.h5")
        self.assert_done(result)
        for part in ("grains           27", "d50              0.6 mm", "1.8 x 1.8 x 1.8 mm", "largest overlap"):
            self.assertIn(part, result.stdout)
        self.assert_close(self.positions("mm.h5"), self.positions("m.h5"), 1e-15, "one rounding")
        self.refuse("m.txt", "clay", options=("--scale", "1e-6"))

    def fcc(self, n=3, radius=1e-4, gap=1.998):
        """Positions in mm of n^3 cubes of a face-centred packing, and the edge of them; spheres overlap a little."""
        edge = gap * radius * math.sqrt(2)
        corners = [(x, y, z) for x in range(n) for y in range(n) for z in range(n)]
        places = [tuple(edge * (c + o) for c, o in zip(corner, offset)) for corner in corners
                  for offset in ((0, 0, 0), (0.5, 0.5, 0), (0.5, 0, 0.5), (0, 0.5, 0.5))]
        return places, n * edge

    def test_the_user_says_what_bounds_a_data_file(self):
        places, edge = self.fcc()
        rows = "".join(f"{i + 1} 1 0.0002 2650 {x!r} {y!r} {z!r} 0 0 0\n" for i, (x, y, z) in enumerate(places))
        self.write("p.data", f"via write_data, units = si\n\n{len(places)} atoms\n1 atom types\n\n"
                   + "".join(f"0 {edge!r} {a}lo {a}hi\n" for a in "xyz") + f"\nAtoms # sphere\n\n{rows}")
        self.assert_done(self.convert("p.data", "p.h5", "--domain", "periodic-cell"))
        scene = self.write("scene.toml", """[contact]
young = "1 GPa"
friction = "45 deg"
[specimen]
domain = "periodic-cell"
file = "p.h5"
pressure = "100 kPa"
[[stage]]
kind = "rebalance"
""")
        self.assert_done(self.run_test(scene, "-o", "out", "--quiet"))

    def test_large_grains_and_any_density_of_a_scene(self):
        self.lattice("stones.txt", unit=0.2, box=1.8)  # radii of 60 mm
        self.refuse("stones.txt", "largest radius is 0.06 m", "0.05 m", "in m, give --length-unit m: radii up to 0.15")
        self.assert_done(self.convert("stones.txt", "stones.h5", "--length-unit", "m"))
        self.lattice("a.txt")
        self.assert_done(self.convert("a.txt", "heavy.data", "--density", "1e6 kg/m3"))
        result = self.convert("heavy.data", "heavy.h5")
        self.assert_done(result)
        self.assertIn("grain density    1e+06 kg/m3", result.stdout)
        self.refuse("a.txt", "2.65 kg/m3", "30 to", options=("--density", "2.65 kg/m3"))

    def test_what_is_no_packing(self):
        self.refuse(self.lattice("deep.txt", radius=0.4), "overlap by 50 %", "diameters")
        self.refuse(self.lattice("small_box.txt", box=1.2), "centre", "outside the box")
        self.refuse(self.lattice("narrow.txt", box=1.65), "beyond a wall", "50 %")
        self.refuse(self.lattice("um.txt", unit=1000), "--length-unit um")
        self.refuse(self.write("history.csv", "step (-),time (s),p (Pa),q (Pa),e (-)\n1,0.1,2e5,0,0.7\n"),
                    "history.csv:2", "does not have a column x", "Is it a packing?")
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

    def test_grains_of_another_program_are_stored_along_a_curve(self):
        """Neighbours in space are neighbours in memory; ids say where they were in the file."""
        mixed = [LATTICE[7 * k % len(LATTICE)] for k in range(len(LATTICE))]
        rows = "".join(" ".join(repr(1e-3 * v) for v in (*centre, 0.3)) + "\n" for centre in mixed)
        self.assert_done(self.convert(self.write("mixed.txt", rows), "mixed.h5"))
        with h5py.File(self.folder / "mixed.h5") as file:
            ids = np.array(file["snapshot/grains/id"])
        places = self.positions("mixed.h5")[:, :3]
        np.testing.assert_array_equal(places, 1e-3 * np.array(mixed)[ids])

        def way(stored):
            return np.linalg.norm(np.diff(stored, axis=0), axis=1).sum()
        in_file = way(places[np.argsort(ids)])
        self.assertLess(4 * way(places), 3 * in_file)


class Snapshots(AppTest):
    def test_a_snapshot_starts_a_run(self):
        scene = self.write("first.toml", tiny_scene(stages='[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.001\n'))
        self.assert_done(self.run_test(scene, "-o", "first", "--quiet"))
        snapshot = "first/snapshots/snapshot_0001.h5"
        again = self.write("again.toml", tiny_scene(specimen=f'file = "{snapshot}"', motion='strain_rate = "2 1/s"',
                                                    stages='[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.001\n'))
        self.assert_done(self.run_test(again, "-o", "again", "--quiet"))
        one, other = (columns(self.folder / run / "history.csv") for run in ("first", "again"))
        self.assert_close(other["p"][0], one["p"][-1], 0.02, "a step of the second run lies between them")
        self.assert_near(other["eps_y"][0], 0, 1e-5, "strain counts from the start of the run: one step")
        self.assert_near(other["time"][0], 0, 1e-4, "so does time")
        self.assert_done(self.run_app("isostat", "convert", snapshot, "snapshot.csv"))

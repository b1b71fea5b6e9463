# SPDX-License-Identifier: BSD-3-Clause
"""Files of other programs: what is read of LAMMPS, YADE, CSV and VTP, what is refused and where, and damaged files."""
import gzip
import math
import pathlib
import random
import tempfile
import warnings

import numpy as np

from package import ToleranceTest, isostat

R = 1e-3
CENTRES = np.array([[1, 1, 1], [3.1, 1, 1], [1, 3, 1 / 3 + 0.7]]) * R
BOX = np.array([[0, 0, 0], [4.1, 4, 2.3]]) * R
LEANING = np.array([[6.2, 0.2, -0.1 / 3], [0, 6.1, 0.3], [0, 0, 6.1 / 3 + 4]]) * R
TILTED = np.array([[6.2, 0.1, 0], [0.05, 6.1, 0.02], [-0.01, 0.3, 6.3]]) * R
MOVING = {"ids": [7, 3, 5], "velocities": CENTRES[::-1] / 3, "spins": CENTRES * 7 / 3}
UNREAL = ("expected", "The box is more", "overlap")  # notes on spheres of 1 m, which are no soil
UNIT_BOX = "\n0 1\n0 1\n0 1\n"


def packing(**domain):
    return isostat.Snapshot.from_spheres(CENTRES, [R, R, 0.9 * R], **domain, **MOVING)


class PackingsTest(ToleranceTest):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()  # pylint: disable=consider-using-with
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def read(self, name, text, notes=None, **how):
        """The snapshot of a file, whose spheres may be of any size; notes: how many warnings there are."""
        path = self.folder / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        with warnings.catch_warnings(record=True) as warned:
            warnings.simplefilter("always")
            found = isostat.read_packing(path, anyway=True, **how).snapshot
        said = [text for w in warned if not any(word in (text := str(w.message)) for word in UNREAL)]
        if notes is not None:
            self.assertEqual(len(said), notes, said)
        return found

    def refuse(self, words, name, text, **how):
        with self.subTest(words), self.assertRaisesRegex(isostat.InputError, words):
            self.read(name, text, **how)

    def through(self, name, written):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            isostat.write_packing(self.folder / name, isostat.Specimen(written), overwrite=True)
            return isostat.read_packing(self.folder / name).snapshot

    def assert_same(self, one, other, names):
        for name in names.split():
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)

    def test_every_format_brings_back_the_bits(self):
        for domain in ({"box": BOX}, {"cell": LEANING}, {"cell": TILTED}):
            written = packing(**domain)
            for ending in ("txt", "csv", "vtp", "data", "dump", "h5"):
                with self.subTest(ending, domain=domain):
                    back = self.through(f"a.{ending}", written)
                    if ending in ("data", "dump") and domain.get("cell") is TILTED:
                        self.assert_turned(back, written)
                        continue
                    self.assert_same(back, written, "positions radii box")
                    if ending != "txt":
                        self.assert_same(back, written, "ids velocities spins")
                    if ending != "dump":
                        self.assert_same(back, written, "cell")
                    elif written.cell is not None:
                        self.assert_near(back.cell, written.cell, 1e-17, "a dump holds the bounds: round-off")
        heavy = isostat.Snapshot.from_spheres(CENTRES, [R] * 3, box=BOX, density=2717.3)
        self.assertEqual(self.through("a.data", heavy).density, 2717.3)

    def assert_turned(self, back, written):
        """All lengths and angles are kept: the products of edges and of positions, relative to the first."""
        self.assertFalse(np.tril(back.cell, -1).any())
        self.assert_close(back.cell.T @ back.cell, written.cell.T @ written.cell, 1e-14, "round-off of a rotation")
        for name in ("velocities", "spins"):
            one, other = getattr(back, name), getattr(written, name)
            self.assert_close(one @ one.T, other @ other.T, 1e-14, "round-off of a rotation")
        parts = [np.linalg.solve(s.cell, (s.positions - s.positions[0]).T) for s in (back, written)]
        moved = parts[0] - parts[1]
        self.assert_near(moved, np.round(moved), 1e-14, "whole edges, except for round-off")

    def test_a_message_says_what_a_format_cannot_hold(self):
        heavy = isostat.Specimen(isostat.Snapshot.from_spheres(CENTRES, [R] * 3, cell=TILTED, density=2717.3))
        for name, words in (("a.txt", ("grain density, 2717.3 kg/m3", "YADE's text")), ("a.data", ("LAMMPS wants",)),
                            ("a.dump", ("grain density", "LAMMPS wants")), ("a.h5", ())):
            with warnings.catch_warnings(record=True) as warned:
                warnings.simplefilter("always")
                isostat.write_packing(self.folder / name, heavy)
            self.assertEqual([word for w, word in zip(warned, words) if word in str(w.message)], list(words))
            self.assertEqual(len(warned), len(words))

    def test_a_grain_outside_the_cell_is_moved_by_whole_edges(self):
        moved = CENTRES + [[0] * 3, LEANING @ [1, 0, -2], [0] * 3]
        outside = isostat.Snapshot.from_spheres(moved, [R, R, R], cell=LEANING)
        part = np.linalg.solve(LEANING, self.through("a.data", outside).positions[1] - CENTRES[1])
        self.assert_near(part, np.round(part), 1e-14, "round-off of ten operations")

    def test_dumps(self):
        frame = f"ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp{UNIT_BOX}" \
                "ITEM: ATOMS id xu yu zu diameter\n4 0.25 0.5 0.5 0.5\n"
        found = self.read("two.dump", frame + frame, notes=1)
        self.assertEqual((found.radii[0], found.ids[0]), (0.25, 3))
        self.assertIsNone(found.box)
        self.refuse("It was cut off; `head -n 10 ", "cut.dump", frame + frame[:frame.index("ITEM: ATOMS")])
        head = "ITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS "
        atoms = "ITEM: ATOMS x y z radius\n"
        for words, text in (
                ("bad.dump:3: boundaries pp pp ff; expected pp pp pp", f"{head}pp pp ff{UNIT_BOX}"),
                ("column radius", f"{head}pp pp pp{UNIT_BOX}ITEM: ATOMS id x y z\n1 0 0 0\n"),
                ("cut off", f"{head}ff ff ff{UNIT_BOX}{atoms}"),
                ("bad.dump:8: centre x = 2 m lies outside the box", f"{head}ff ff ff{UNIT_BOX}{atoms}2 0 0 1\n"),
                ("bad.dump:8: \"x\" is no number", f"{head}ff ff ff{UNIT_BOX}{atoms}0 0 x 1\n"),
                ("bad.dump:6: the box has no volume", f"{head}pp pp pp\n0 1\n0 0\n0 1\n"),
                ("a leaning box with walls", f"{head}xy xz yz ff ff ff\n"),
                ("general triclinic", f"{head}abc origin pp pp pp\n"),
                ("bad.dump:2: units lj; expected si", "ITEM: UNITS\nlj\n"),
                *((f"bad.dump:2: {n} atoms; expected a whole number below 2.32", f"ITEM: NUMBER OF ATOMS\n{n}\n")
                  for n in ("-1", "1.5", "1e300", "nan", "1_0"))):
            self.refuse(words, "bad.dump", text)
        unsaid = f"ITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS{UNIT_BOX}{atoms}0 0.5 0.5 0.5\n"
        self.assertIsNone(self.read("p.dump", unsaid, notes=0, domain="periodic-cell").box)
        self.assertIsNone(self.read("p.dump", unsaid, notes=1).cell)

    def test_masses_and_densities_of_a_dump(self):
        def dump(column, one, other):
            return (f"ITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp{UNIT_BOX}ITEM: ATOMS x y z radius {column}\n"
                    f"0 0 0 0.1 {one}\n0.5 0.5 0.5 0.2 {other}\n")
        volume = 4 / 3 * math.pi * 1e-3
        found = self.read("m.dump", dump("mass", f"{2500 * volume:.6g}", f"{8 * 2500 * volume:.6g}"))
        self.assert_near(found.density, 2500, 0.02, "six digits")
        in_mm = dump("mass", f"{2.5e-6 * volume:.6g}", f"{8 * 2.5e-6 * volume:.6g}")
        found = self.read("m.dump", in_mm, length_unit="mm")
        self.assert_near(found.density, 2500, 0.02, "six digits; millimetres and kg")
        self.assertEqual(self.read("m.dump", dump("density", 2600, 2600)).density, 2600)
        self.assertEqual(self.read("m.dump", dump("density", 2600, 2600), density=2700.0, notes=1).density, 2600)
        for words, text in (("m.dump:9: density 2650", dump("density", 2600, 2650)), ("m.dump:8: density nan",
                            dump("density", "nan", "nan")), ("m.dump: grain density = -1", dump("density", -1, -1)),
                            ("m.dump:8: mass = ", dump("mass", 2500 * volume, 2700 * 8 * volume)),
                            ("m.dump:9: mass = -1 kg", dump("mass", 1, -1)),
                            ("m.dump:8: mass = ",
                             dump("mass density", f"{2500 * volume} 2600", f"{2500 * 8 * volume} 2600"))):
            self.refuse(words, "m.dump", text)

    def test_data_files_of_other_programs(self):
        box = "0 1 xlo xhi\n0 1 ylo yhi\n0 1 zlo zhi\n\n"
        text = f"title\n\n2 atoms # comment\n1 atom types\n{box}Masses\n\n1 1.0\n\nAtoms # sphere\n\n" \
               "2 1 0.5 2600 0.5 0.5 0.5 0 0 0\n1 1 0.25 2600 0.1 0.2 0.3\n\nVelocities\n\n1 1 2 3 4 5 6\n"
        found = self.read("b.data", text, notes=1)
        self.assertEqual((found.radii[0], found.ids.tolist(), found.density), (0.25, [1, 0], 2600))
        np.testing.assert_array_equal(np.hstack([found.velocities, found.spins]), [[0] * 6, [1, 2, 3, 4, 5, 6]])
        rest = f"1 atoms\n{box}Atoms # sphere\n\n1 1 0.5 2600 0 1.2 0\n"
        found = self.read("p.data", f"of write_data, units = si\n{rest}", notes=0, domain="periodic-cell")
        np.testing.assert_array_equal(found.cell, np.eye(3))
        for words, text in (("bad.data:9: centre y = 1.2", f"of write_data\n{rest}"),
                            ("bad.data:1: units lj; expected si", f"of write_data, units = lj\n{rest}"),
                            ("bad.data:7: atom_style bond", f"\n1 atoms\n{box}Atoms # bond\n"),
                            ("bad.data:3: the box has no volume", "\n1 atoms\n1 0 xlo xhi\n"),
                            ("bad.data: the box is not complete", "\n1 atoms\n0 1 xlo xhi\n"),
                            ("bad.data: 9 atoms are promised, 1 are there", f"\n9 atoms\n{rest[8:]}"),
                            ("bad.data:9: \"nan\"; expected a number", f"\n{rest}".replace("0.5", "nan")),
                            ("bad.data:12: velocity of atom 2", f"\n{rest}\nVelocities\n2 0 0 0 0 0 0\n"),
                            ("bad.data:9: id = 0; expected a whole number from 1",
                             f"\n{rest}".replace("1 1 0.5", "0 1 0.5"))):
            self.refuse(words, "bad.data", text)

    def test_text_of_yade(self):
        found = self.read("y.txt", "##PERIODIC:: 4 5 6\n0 0 0 1 -1\n4.5 2 2 0.5 -1\n", notes=0)
        np.testing.assert_array_equal(found.cell, np.diag([4, 5, 6]))
        self.assertEqual((found.volume, found.radii[1]), (120, 0.5))
        for text in ("#format x_y_z_r_matId\n# made up\n1\t2\t3\t0.5\t0\n", "# x y z diameter\n1 2 3 1\n",
                     "#format id_x_y_z_r_matId\n7\t1\t2\t3\t0.5\t0\n", "x y z r\n+1,2,\t3 , 5e-1\n\n",
                     "#format x_y_z_r_attrs\n1\t2\t3\t0.5\t9\t9\t9\n", '"","x","y","z","r"\n"1",1,1,1.5,0.5\n',
                     '"x" "y" "z" "r"\n"1" 1 1 1.5 0.5\n'):
            with self.subTest(text):
                found = self.read("y.txt", text, notes=1)  # bounding box
                self.assertEqual((found.positions[0, 0], found.radii[0]), (1, 0.5))
        form = "expected four numbers x y z r .m. in every line"
        for words, text in (("y.txt:2: clump id 7; expected -1", "0 0 0 1 -1\n2 2 2 0.5 7\n"),
                            (f"y.txt:2: \"2 2 2 0.5\"; {form}", "0 0 0 1 -1\n2 2 2 0.5\n"),
                            (f"y.txt:1: \"0 0\"; {form}", "0 0\n"),
                            ("y.txt:2: a second domain", "# box 0 4 0 4 0 4\n##PERIODIC:: 4 4 4\n1 1 1 1\n"),
                            ("y.txt:2: clump id 0", "#format x_y_z_r_clumpId\n1\t2\t3\t0.5\t0\n"),
                            ("y.txt:1: this format does not have a column x", "#format jointedPM\n1\t2\t3\t0.5\t0\n"),
                            ("y.txt:1: .*each pair rising", "# box 0 1 0 1 1 0\n0 0 0 1\n"),
                            ("y.txt:1: .*right-handed", "# cell 1 0 0 0 1 0 0 0\n0 0 0 1\n"),
                            ("y.txt:1: .*right-handed", "# cell 1e200 0 0 0 1e200 0 0 0 1e200\n0 0 0 1\n"),
                            *(("y.txt:1: .*above 0", f"##PERIODIC:: {edges}\n0 0 0 1\n") for edges in
                              ("4 4 0", "4 4", "4 -4 -4", "4 4 x", "4 4 inf")),
                            ("y.txt:3: centre x = 2 m lies outside the box", "# box 0 1 0 1 0 1\n\n2 0 0 1\n"),
                            ("y.txt:2: radius r = 1e-12 m; expected 1e-09", "0 0 0 1\n5 0 0 1e-12\n"),
                            ("y.txt:2: radius r = 1e-08 m is lost", "0 0 0 1\n0 0 1e9 1e-8\n"),
                            ("y.txt:1: centre y = -2000000000 m", "0 -2e9 0 1\n"), ("no spheres", "x y z r\n"),
                            ("y.txt:1: radius r = nan", "0 0 0 nan\n"), ("no spheres", ""),
                            ("y.txt:1: radius r = inf", "0 0 0 1e999\n"),
                            *(("y.txt:1: \".*\" is no number", f"0 0 {word} 1\n") for word in
                              ("1_0", "١", "0x1", "é", "\x00")),
                            ("y.txt:1: \".*\" is no number", b"0 0 \xff 1\n"),
                            ("y.txt:1: the text is UTF-16", "0 0 0 1".encode("utf-16"))):
            self.refuse(words, "y.txt", text)
        packed = gzip.compress("".join(f"{i * 7919 % 1000003} 0 0 1\n" for i in range(2000)).encode())
        self.assertEqual(len(self.read("y.txt.gz", packed)), 2000)
        self.refuse("gzip data are damaged or cut off", "y.txt.gz", packed[:len(packed) // 2])

    def test_columns_of_tables(self):
        for header in ("ID,X,Y,Z,RADIUS", '"id","x","y","z","r"', "Id, pos_x, pos_y, pos_z, Rad",
                       "ball.id ball.pos.x ball.pos.y ball.pos.z ball.radius", "type x (m) y (m) z (m) radius (m)"):
            found = self.read("p.csv", f"{header}\n3,1,2,4,0.5\n")
            self.assertEqual((*found.positions[0], found.radii[0]), (1, 2, 4, 0.5), header)
        for name in (200000 * "a", "a\rb", "a\x00"):
            self.assertEqual(self.read("p.csv", f"x,y,z,r,{name}\n1,2,4,0.5,7\n").radii[0], 0.5)
        found = self.read("p.csv", "radius,id,z,y,x,colour\n0.25,9,3,2,1,7\n", notes=1)
        self.assertEqual((*found.positions[0], found.ids[0]), (1, 2, 3, 9))
        in_mm = "X (mm),Y (mm),Z (mm),Diameter [mm]\n1,2,3,1\n"
        self.assertEqual(self.read("p.csv", in_mm, length_unit="mm").radii[0], 0.5e-3)
        self.assertEqual(self.read("p.csv", "x,y,z,r,Density (kg/m3)\n1,2,3,1,2700\n").density, 2700)
        for words, text in (("p.csv:1: the column diameter is in mm, .*length_unit=\"mm\"", in_mm),
                            ("is in g/cm3; expected kg/m3", "x,y,z,r,density (g/cm3)\n1,2,3,1,2.7\n"),
                            ("p.csv:3: its id is that of another", "id,x,y,z,r\n1,0,0,0,1\n1,5,0,0,1\n"),
                            ("p.csv:2: \"1,0,0,0\"; expected 5 columns", "id,x,y,z,r\n1,0,0,0\n"),
                            ("p.csv:2: id = -1", "id,x,y,z,r\n-1,0,0,0,1\n"),
                            ("p.csv:2: velocity or spin is not finite", "x,y,z,r,vx,vy,vz\n0,0,0,1,nan,0,0\n"),
                            *(("p.csv:2: the header above does not", f"{header}\n1,2,3,0.5\n") for header in
                              ("id,x,y,z", "x,y,z,size"))):
            self.refuse(words, "p.csv", text)

    def test_lengths_are_scaled_with_the_box(self):
        found = self.read("a.txt", "# box 0 4 0 4 0 4\n1 2 3 0.5\n", notes=0, length_unit="mm")
        np.testing.assert_array_equal(found.positions[0], 1e-3 * np.array([1, 2, 3]))
        np.testing.assert_array_equal(found.box[1], [4e-3] * 3)
        for words, how in (("density", {"density": 0.0}), ("density: must be a number", {"density": "heavy"}),
                           ("length_unit: must be a length", {"length_unit": "el"}),
                           ("domain: must be", {"domain": "sphere"})):
            self.refuse(words, "a.txt", "1 2 3 0.5\n", **how)
        for words, name, how in (("a.pdb: its ending .*lammps-dump .\\.dump, \\.lammpstrj", "a.pdb", {}),
                                 ("format pdb; expected one of", "a.txt", {"format": "pdb"}),
                                 ("no folder", "no/a.txt", {})):
            with self.assertRaisesRegex(isostat.InputError, words):
                isostat.write_packing(self.folder / name, isostat.Specimen(packing(box=BOX)), overwrite=True, **how)

    def test_vtp_of_another_program(self):
        """Ascii and 32 bits, as ParaView writes it."""
        text = """<?xml version="1.0"?><VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="2">
<PointData><DataArray type="Float32" Name="radius" format="ascii"> 1 0.5 </DataArray></PointData>
<Points><DataArray type="Float32" NumberOfComponents="3" format="ascii">0 0 0
 2 0 0</DataArray></Points></Piece></PolyData></VTKFile>"""

        def array(name, values, kind="ascii"):
            return f'<DataArray type="Float32" Name="{name}" format="{kind}"> {values} </DataArray>'

        def having(before, more):
            return text.replace(before, more + before, 1)
        found = self.read("a.vtp", text, notes=1)
        np.testing.assert_array_equal(found.positions[1], [2, 0, 0])
        np.testing.assert_array_equal(found.box[1], [2.5, 1, 1])
        self.assertEqual(self.read("a.vtp", having("</PointData>", array("density", "99 99"))).density, 99)
        def fields(name, values):
            return having("<Piece", f"<FieldData>{array(name, values)}</FieldData>")
        for words, bad in (("no VTK PolyData", "<VTKFile"), ("a.vtp: field data `box` of 4", fields("box", "0 9 0 9")),
                           ("no VTK PolyData", text.replace("PolyData><P", "Image><P", 1)),
                           ("several pieces", having("</PolyData>", '<Piece NumberOfPoints="0"/>')),
                           ("BigEndian", having('type="PolyData"', 'byte_order="BigEndian" ')),
                           ("compressed", having('type="PolyData"', 'compressor="vtkZLib" ')),
                           ("2 points with 3 radii", text.replace("1 0.5", "1 0.5 1")),
                           ("2 points, but 3 are", text.replace('"2"', '"3"')),
                           ("id = 1e.300; expected a whole number", having("</PointData>", array("id", "0 1e300"))),
                           ("\"x\" in the array radius", text.replace("1 0.5", "1 x")),
                           ("spans? no volume", fields("cell", "0 " * 9)),
                           ("stored as appended", having("</PointData>", array("id", "", "appended"))),
                           ("not base64", having("</PointData>", array("id", "%", "binary"))),
                           ("no content", having("</PointData>", array("id", "AAA=", "binary"))),
                           ("document type", having("<VTKFile", '<!DOCTYPE a [<!ENTITY b "bb">]>'))):
            self.refuse(words, "a.vtp", bad)

    def test_damaged_files_are_read_or_refused(self):
        """Random damage to valid files. What is taken has a size, and comes back from CSV with the same bits."""
        valid = {}
        for domain in ({"box": BOX}, {"cell": LEANING}):
            for ending in ("txt", "csv", "vtp", "data", "dump"):
                self.through(f"v.{ending}", packing(**domain))
                valid[f"{len(valid)}.{ending}"] = (self.folder / f"v.{ending}").read_bytes()
        valid["f.txt"] = b"#format id_x_y_z_r_matId\n7\t1\t2\t3\t0.5\t0\n8\t1\t2\t8\t0.5\t0\n"
        chance, taken = random.Random(20261130), 0
        words = [word.encode("latin-1") for word in
                 ("nan", "-1", "1e300", "1e-300", "inf", " ", "\n", "#", '"', ",", "\xff", "0", "(mm)", "<", "ITEM:")]
        for _ in range(800):
            data = bytearray(valid[name := chance.choice(sorted(valid))])
            for _ in range(chance.randint(1, 2)):
                at = chance.randrange(len(data) + 1)
                kind = chance.choice((0, 0, 0, 1, 1, 2, 3))
                if kind == 0:
                    data[at:at + 1] = bytes([chance.randrange(256)])
                elif kind == 1:
                    data[at:at + chance.randint(0, 12)] = chance.choice(words)
                elif kind == 2:
                    del data[at:at + chance.randint(1, 40)]
                else:
                    del data[at:]
            try:
                found = self.read(name, bytes(data))
            except isostat.InputError:
                continue
            taken += 1
            self.assertGreater(len(found), 0)
            self.assertGreater(found.radii.min(), 0)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                isostat.write_packing(self.folder / "again.csv", isostat.Specimen(found), overwrite=True)
                again = isostat.read_packing(self.folder / "again.csv", anyway=True).snapshot
            self.assert_same(again, found, "positions radii ids velocities spins box cell")
        self.assertGreater(taken, 50)

# SPDX-License-Identifier: BSD-3-Clause
"""Packings of LAMMPS in `units si`: dump custom, and data files of atom_style sphere.   tested: tests/python/packings_test.py

LAMMPS counts atoms from 1, Isostat grains from 0: ids are shifted by one. A periodic cell may lean as LAMMPS lets it: a along
x, b in the plane xy (xy, xz, yz). Any other cell is turned into this position before it is written, with all grains; that costs
the last bits. Grains outside the cell are moved into it by whole edges.
"""
import numpy as np

from isostat.packings.spheres import (Columns, FIRST_UNREAL, Found, finite, number, refuse, Spheres, split_words, text)


def edges_of(size, xy, xz, yz):
    return np.array([[size[0], xy, xz], [0, size[1], yz], [0, 0, size[2]]])


def reach(xy, xz, yz):
    """How far a leaning box reaches beyond its lower and upper corner: what a dump adds to them."""
    return np.array([[min(0, xy, xz, xy + xz), min(0, yz), 0], [max(0, xy, xz, xy + xz), max(0, yz), 0]])


def found_in(spheres, box, tilt, periodic, domain, kind):
    """Spheres in their domain. periodic: None where a file of this kind does not say it: a box that leans is then a cell, and
    any other what the caller names."""
    found = Found(spheres)
    if periodic is None:
        periodic = any(tilt) or domain == "periodic-cell"
        if any(tilt):
            found.notes.append(f"The {kind} leans: it is taken for a periodic cell.")
        elif not periodic:
            found.notes.append(f"A {kind} does not say what bounds it: the faces are taken for walls.")
    if periodic:
        found.cell = edges_of(box[1] - box[0], *tilt)
    else:
        found.box = box
    return found


class Dump:
    """The lines of a dump, and the last frame that was read of it."""

    def __init__(self, path, lines):
        self.path, self.lines, self.next, self.whole = path, lines, 0, 0  # line to be read; lines of whole frames

    def refuse(self, what):
        refuse(self.path, self.next, what)

    def done(self):
        return self.next >= len(self.lines) or (self.next + 1 == len(self.lines) and not self.lines[self.next])

    def take(self):
        if self.next >= len(self.lines):
            self.refuse("the dump ends within a frame; expected more lines. " + (
                f"It was cut off; `head -n {self.whole} {self.path}` has the whole frames before." if self.whole else
                "Is it cut off?"))
        self.next += 1
        return self.lines[self.next - 1]

    def read_bounds(self, item):
        """The three lines below `ITEM: BOX BOUNDS [xy xz yz] xx yy zz`."""
        if "abc" in item:
            self.refuse("a general triclinic box; expected one with xy xz yz. Write the dump with `dump_modify ... "
                        "triclinic/general no`")
        leans = "xy" in item
        if item.count("pp") not in (0, 3):
            self.refuse(f"boundaries {' '.join(item[-3:])}; expected pp pp pp (a periodic cell), or no pp (a box with walls): "
                        "Isostat has no packing that is periodic along some axes only")
        self.periodic = "pp" in item if len(item) >= (9 if leans else 6) else None
        if leans and self.periodic is False:
            self.refuse("a leaning box with walls; expected pp pp pp: the walls of Isostat are at right angles")
        rows, least = [], 3 if leans else 2
        for _ in range(3):
            words = split_words(self.take())
            if len(words) < least:
                self.refuse(f"{len(words)} numbers; expected {least} of the box")
            rows.append([finite(self.path, self.next, word) for word in words[:least]])
        self.tilt = [row[2] for row in rows] if leans else [0, 0, 0]
        self.box = np.array(rows)[:, :2].T - reach(*self.tilt)
        if not (self.box[1] > self.box[0]).all():
            self.refuse("the box has no volume; expected lo < hi")

    def read_atoms(self, item, n_atoms):
        columns = Columns(item[2:], 1)
        if missing := columns.missing():
            self.refuse(f"the dump does not have {missing}; write it with `dump ID all custom N FILE id type x y z radius`")
        first, rows = self.next + 1, []
        for _ in range(n_atoms):
            row = self.take()
            rows.append(columns.row(self.path, self.next, row))
        self.spheres = columns.spheres(self.path, rows, range(first, first + n_atoms))

    def read_frame(self):
        self.box, self.tilt, self.periodic = np.zeros((2, 3)), [0, 0, 0], None
        n_atoms = 0
        while True:
            item = split_words(self.take())
            if len(item) < 2 or item[0] != "ITEM:":
                self.refuse("expected a line `ITEM: ...` of a LAMMPS dump")
            if item[1] == "BOX":
                self.read_bounds(item)
            elif item[1] == "ATOMS":
                self.read_atoms(item, n_atoms)
                self.whole = self.next
                return
            elif item[1] == "NUMBER":
                word = self.take()
                n_atoms = number(word)
                if n_atoms is None or not (0 <= n_atoms < FIRST_UNREAL and n_atoms == int(n_atoms)):
                    self.refuse(f"{word} atoms; expected a whole number below 2^32")
                n_atoms = int(n_atoms)
            elif (value := self.take()) != "si" and item[1] == "UNITS":
                self.refuse(f"units {value}; expected si. Scale the dump, or write it in a run with `units si`")


def read_dump(path, lines, _scale, domain):
    """Of several frames the last."""
    dump, frames = Dump(path, lines), 0
    while frames == 0 or not dump.done():
        dump.read_frame()
        frames += 1
    found = found_in(dump.spheres, dump.box, dump.tilt, dump.periodic, domain, "dump without boundaries")
    if frames > 1:
        found.notes.insert(0, f"The dump has {frames} frames: the last one is taken.")
    return found


class Data:
    """What a data file holds, line by line; rows of atoms and velocities end with their lines."""

    def __init__(self, path):
        self.path, self.line, self.section = path, 1, ""
        self.box, self.tilt, self.n_atoms = np.full((2, 3), np.nan), [0, 0, 0], None
        self.rows = {"Atoms": [], "Velocities": []}  # id type diameter density x y z; id vx vy vz wx wy wz

    def refuse(self, what):
        refuse(self.path, self.line, what)

    def numbers(self, words):
        return [finite(self.path, self.line, word) for word in words]

    def header(self, words):
        """A line such as `0 1 xlo xhi`."""
        half = len(words) // 2
        names = words[half:] if len(words) % 2 == 0 else []
        if words[-1] in ("avec", "abc"):
            self.refuse("a general triclinic box; expected xlo xhi and xy xz yz")
        if words[1:] == ["atoms"]:
            self.n_atoms = self.numbers(words[:1])[0]
        elif words[-3:] == ["xy", "xz", "yz"] and len(words) != 6:
            self.refuse("tilts of the cell that are not three numbers; expected xy xz yz behind three")
        elif names == ["xy", "xz", "yz"]:
            self.tilt = self.numbers(words[:half])
        for k, axis in enumerate("xyz"):
            if names == [f"{axis}lo", f"{axis}hi"]:
                self.box[:, k] = self.numbers(words[:half])
                if not self.box[0, k] < self.box[1, k]:
                    self.refuse("the box has no volume; expected lo < hi")

    def read_line(self, row):
        before, _, comment = row.partition("#")
        words = split_words(before)
        if not words:
            return
        if "A" <= words[0][:1] <= "Z":
            self.section = words[0]
            style = split_words(comment)
            if self.section == "Atoms" and style and style[0] != "sphere":
                self.refuse(f"atom_style {style[0]}; expected sphere: no other has radii")
        elif not self.section:
            self.header(words)
        elif self.section in self.rows:
            values = self.numbers(words)
            if len(values) < 7:
                self.refuse(f"{len(values)} numbers; expected 7")
            self.rows[self.section].append([*values[:7], self.line])

    def spheres(self):
        atoms = np.array(self.rows["Atoms"], float).reshape(-1, 8)
        ids = atoms[:, 0]
        found = Spheres(self.path, atoms[:, 4:7], atoms[:, 2] / 2, ids, densities=atoms[:, 3], lines=atoms[:, 7].astype(int))
        found.check_ids(1)
        if self.rows["Velocities"]:
            place = {atom: i for i, atom in enumerate(ids)}
            found.velocities, found.spins = np.zeros((2, len(atoms), 3))
            for atom, *motion, line in self.rows["Velocities"]:
                if atom not in place:
                    refuse(self.path, line, f"velocity of atom {text(atom)}, which is not in the section Atoms; expected it "
                                            "there")
                found.velocities[place[atom]], found.spins[place[atom]] = motion[:3], motion[3:]
        return found


def read_data(path, lines, _scale, domain):
    """Only the title that Isostat writes says whether it is a cell or a box."""
    data, title = Data(path), lines[0]
    units = split_words(title.partition("units = ")[2])
    if units and units[0] != "si":
        refuse(path, 1, f"units {units[0]}; expected si. Write the file in a run with `units si`")
    for line, row in enumerate(lines[1:], 2):
        data.line = line
        data.read_line(row)
    n = len(data.rows["Atoms"])
    if np.isnan(data.box).any():
        refuse(path, 0, "the box is not complete; expected lines `lo hi xlo xhi`, ylo yhi and zlo zhi")
    if data.n_atoms is None:
        refuse(path, 0, "no line `N atoms`; expected one in the header")
    if data.n_atoms != n:
        refuse(path, 0, f"{text(data.n_atoms)} atoms are promised, {n} are there; is the file cut off?")
    periodic = True if "periodic cell" in title else False if "rigid box" in title else None
    return found_in(data.spheres(), data.box, data.tilt, periodic, domain, "data file")


def fits(packing):
    """Whether LAMMPS takes the edges as they are, upper triangular. A box has none."""
    e = packing.cell
    return e is None or (not np.tril(e, -1).any() and (e.diagonal() > 0).all())


class InBox:
    """A packing as LAMMPS has it: turned, and moved into the box by whole edges."""

    def __init__(self, packing):
        self.centres, self.velocities, self.spins = packing.positions.copy(), packing.velocities, packing.spins
        self.ids, self.radii = (packing.ids.astype(np.int64) + 1).tolist(), packing.radii
        self.periodic, self.box, self.tilt = packing.cell is not None, packing.box, [0, 0, 0]
        if not self.periodic:
            return
        edges = packing.cell
        if not fits(packing):
            q, r = np.linalg.qr(edges)
            q *= np.sign(r.diagonal())  # right-handed: so are the edges
            edges = np.triu(q.T @ edges)
            self.centres, self.velocities, self.spins = (v @ q for v in (self.centres, self.velocities, self.spins))
        inverse, size = np.linalg.inv(edges), edges.diagonal()
        self.tilt = [edges[0, 1], edges[0, 2], edges[1, 2]]
        part = self.centres @ inverse.T
        # A cell has no place in space: it begins at the origin if all grains are in it there, else it is centred on the origin.
        lower = np.zeros(3) if ((part >= 0) & (part < 1)).all() else -0.5 * size
        self.box = np.array([lower, size if not lower.any() else -lower])
        part = np.floor((self.centres - lower) @ inverse.T)
        out = part.any(axis=1)
        self.centres[out] -= part[out] @ edges.T


def dump_text(packing):
    """One frame. Comes back bit for bit; the edges of a cell that leans to round-off, because a dump holds its bounds."""
    s = InBox(packing)
    leans = any(s.tilt)
    rows = np.column_stack([(s.box + reach(*s.tilt)).T, s.tilt] if leans else [s.box.T]).tolist()
    return (f"ITEM: UNITS\nsi\nITEM: TIMESTEP\n{packing.step}\nITEM: NUMBER OF ATOMS\n{len(s.ids)}\nITEM: BOX BOUNDS "
            f"{'xy xz yz ' if leans else ''}{'pp pp pp' if s.periodic else 'ff ff ff'}\n"
            + "".join(" ".join(map(text, row)) + "\n" for row in rows)
            + "ITEM: ATOMS id type x y z radius vx vy vz omegax omegay omegaz\n"
            + rows_text(s.ids, " 1", s.centres, s.radii, s.velocities, s.spins))


def data_text(packing):
    """For read_data of LAMMPS; comes back bit for bit."""
    s = InBox(packing)
    density = np.full(len(s.ids), packing.density)
    return (f"LAMMPS data file of Isostat, atom_style sphere, units si, {'periodic cell' if s.periodic else 'rigid box'}\n\n"
            f"{len(s.ids)} atoms\n1 atom types\n\n"
            + "".join(f"{text(low)} {text(high)} {a}lo {a}hi\n" for a, low, high in zip("xyz", *s.box))
            + (f"{' '.join(map(text, s.tilt))} xy xz yz\n" if any(s.tilt) else "")
            + "\nAtoms # sphere\n\n" + rows_text(s.ids, " 1", 2 * s.radii, density, s.centres)
            + "\nVelocities\n\n" + rows_text(s.ids, "", s.velocities, s.spins))


def rows_text(ids, kind, *columns):
    return "".join(f"{atom}{kind} {' '.join(map(text, row))}\n" for atom, row in zip(ids, np.column_stack(columns).tolist()))

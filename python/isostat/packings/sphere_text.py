# SPDX-License-Identifier: BSD-3-Clause
"""Spheres as text: YADE's export.text, textExt and SpherePack, CSV, PFC.   tested: tests/python/packings_test.py

Lines `x y z r`, or five numbers with the clump id -1 for all; or columns in any order under a header that names them (see
spheres.Columns), separated by blanks, tabs or commas. Lines that begin with # are comments, except:

    # box xlo xhi ylo yhi zlo zhi             walls; without it the bounding box of the spheres
    # cell ax ay az bx by bz cx cy cz         edges of a periodic cell, right-handed
    ##PERIODIC:: x y z                        its edges along the axes (SpherePack)
    #format x_y_z_r_matId                     names of the columns (textExt); "attrs" is any number
    # x y z r type                            the same, if the rows have as many columns
"""
import csv

import numpy as np

from isostat.packings.spheres import Columns, Found, number, refuse, split_words, text

LEADING = {"box": (6, "# box xlo xhi ylo yhi zlo zhi, each pair rising (m)"),
           "cell": (9, "# cell ax ay az bx by bz cx cy cz, three edges of a right-handed cell (m)"),
           "#PERIODIC::": (3, "##PERIODIC:: x y z, three edges of a cell above 0 (m): Isostat has no packing that is periodic "
                              "along some axes only")}


def domain_of(path, line, words, row):
    """The (2, 3) corners of a box or the (3, 3) edges of a cell that a comment states."""
    count, form = LEADING[words[0]]
    values = np.array([np.nan if (value := number(word)) is None else value for word in words[1:]])
    with np.errstate(all="ignore"):
        if len(values) == count and words[0] == "box":
            domain = values.reshape(3, 2).T
            good = np.isfinite(domain).all() and (domain[0] < domain[1]).all()
        elif len(values) == count:
            domain = values.reshape(3, 3).T if count == 9 else np.diag(values)
            good = 0 < np.linalg.det(domain) < np.inf and (count == 9 or (values > 0).all())
        else:
            good = False
    if not good:
        refuse(path, line, f'"{row}"; expected {form}')
    return domain


def header_names(row):
    """Between commas if there are any, else between blanks, each with its unit, `x (m)`."""
    if "," in row:
        try:
            return [name.strip(" ") for name in next(csv.reader([row], skipinitialspace=True))]
        except csv.Error:  # a carriage return, a name of a hundred thousand letters
            return row.split(",")
    names = []
    for word in split_words(row):
        if names and word[:1] in ("(", "["):
            names[-1] += " " + word
        else:
            names.append(word)
    return names


class Rows:
    """Spheres line by line; their columns follow from a header, a comment, or how many there are."""

    def __init__(self, path, scale):
        self.path, self.scale = path, scale
        self.domain, self.rows, self.lines = None, [], []
        self.columns = self.of_comment = None
        self.missing = ""  # from a header that names other things
        self.named = self.unnamed = 0  # words of a header; columns where nothing names them

    def comment(self, line, row):
        said = row[row.index("#") + 1:]
        words = split_words(said)
        if words and words[0] in LEADING:
            found = domain_of(self.path, line, words, row)
            if self.domain is not None and self.domain.shape != found.shape:
                refuse(self.path, line, "a second domain: the file has a box and a periodic cell; expected one of them")
            self.domain = found
        elif words and not self.rows:
            if words[0] == "format" and len(words) == 2:
                names = words[1].split("_")
                any_more = names[-1] == "attrs"
                self.columns = Columns(names[:-1] if any_more else names, open_ended=any_more)
                if lacks := self.columns.missing():
                    refuse(self.path, line, f"this format does not have {lacks}; expected one such as x_y_z_r_matId")
            elif not (found := Columns(header_names(said))).missing():
                self.of_comment = found

    def header(self, line, row):
        found = Columns(header_names(row))
        self.missing, self.named = found.missing(), found.n
        self.columns = Columns("xyzr") if self.missing else found
        self.columns.check_units(self.path, line, self.scale)

    def row(self, line, row):
        n = len(split_words(row))
        if not self.rows and self.of_comment and self.of_comment.n == n:
            self.columns = self.of_comment
            self.columns.check_units(self.path, line, self.scale)
        if self.missing and (n != 4 or n == self.named):  # one that names other columns than these four
            refuse(self.path, line, f"the header above does not have {self.missing}; expected columns x, y, z and r or "
                                    "diameter (m). Is it a packing?")
        if self.columns is None and n in (4, 5):
            self.columns, self.unnamed = Columns([*"xyzr", "clumpId"][:n]), n
        if self.columns is None or self.unnamed not in (0, n):
            refuse(self.path, line, f'"{row}"; expected four numbers x y z r (m) in every line, or five with the clump id')
        self.rows.append(self.columns.row(self.path, line, row))
        self.lines.append(line)


def read(path, lines, scale, _domain):
    rows, header_seen = Rows(path, scale), False
    for line, row in enumerate(lines, 1):
        words = split_words(row)
        if not words:
            continue
        if words[0].startswith("#"):
            rows.comment(line, row)
        elif not rows.rows and not header_seen and all(number(word) is None for word in words):
            header_seen = True
            rows.header(line, row)
        else:
            rows.row(line, row)
    found = Found((rows.columns or Columns("xyzr")).spheres(path, rows.rows, rows.lines))
    if rows.domain is None:
        found.notes.append("The file has no line `# box xlo xhi ylo yhi zlo zhi`: the bounding box of the spheres is taken.")
    elif len(rows.domain) == 2:
        found.box = rows.domain
    else:
        found.cell = rows.domain
    return found


def domain_text(packing):
    if packing.cell is not None:
        return f"# cell {' '.join(map(text, packing.cell.T.ravel()))}\n"
    return f"# box {' '.join(map(text, packing.box.T.ravel()))}\n"


def yade(packing):
    """Lines `x y z r` with the comment of the domain, which yade.ymport.text skips."""
    return domain_text(packing) + "# x y z r in m\n" + "".join(
        "\t".join(map(text, row)) + "\n" for row in np.column_stack([packing.positions, packing.radii]).tolist())


def table(packing):
    """CSV, with ids and velocities too."""
    values = np.column_stack([packing.positions, packing.radii, packing.velocities, packing.spins]).tolist()
    return domain_text(packing) + "id,x,y,z,r,vx,vy,vz,wx,wy,wz\n" + "".join(
        f"{grain},{','.join(map(text, row))}\n" for grain, row in zip(packing.ids.tolist(), values))

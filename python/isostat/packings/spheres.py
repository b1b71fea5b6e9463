# SPDX-License-Identifier: BSD-3-Clause
"""Spheres as a file lists them, their columns, and what is refused.   tested: tests/python/packings_test.py"""
import dataclasses
import math
import re

import numpy as np

from isostat import _core

SMALLEST, LARGEST, FARTHEST = 1e-9, 1e6, 1e9  # of radii and coordinates, m
SAME_DENSITY = 0.01  # of itself: masses and radii are often written with three digits
FIRST_UNREAL = 2**32  # ids and counts are smaller
PLAIN_WORDS = re.compile(r"[^ \t,]+")
QUOTED_WORDS = re.compile(r'"(?:[^"]|"")*"(?=[ \t,]|$)|[^ \t,]+')


def refuse(path, line, what):
    raise _core.InputError(f"{path}:{line}: {what}" if line else f"{path}: {what}")


def split_words(line):
    """Words between blanks, tabs and commas; what is in quotes is one word, without them, and may be empty."""
    if '"' not in line:
        return PLAIN_WORDS.findall(line)
    return [word[1:-1] if len(word) > 1 and word[0] == word[-1] == '"' else word for word in QUOTED_WORDS.findall(line)]


def number(word):
    """The number that a word spells out, or None: nothing that only Python takes for one."""
    try:
        return float(word) if word.isascii() and "_" not in word else None
    except ValueError:
        return None


def finite(path, line, word):
    value = number(word)
    if value is None or not math.isfinite(value):
        refuse(path, line, f'"{word}"; expected a number')
    return value


def text(value):
    """The shortest digits that come back as the same number."""
    return repr(float(value)).removesuffix(".0")


@dataclasses.dataclass
class Spheres:
    """Arrays with a row for each sphere, in the unit of length of the file; None: the file does not have them."""
    path: str
    centres: np.ndarray
    radii: np.ndarray
    ids: np.ndarray | None = None  # as numbers, counted from 0
    velocities: np.ndarray | None = None
    spins: np.ndarray | None = None
    densities: np.ndarray | None = None  # kg/m3
    masses: np.ndarray | None = None  # kg
    lines: np.ndarray | None = None  # of the file, from 1

    def refuse(self, bad, what):
        """Refuses the first sphere that is bad; what(i): its fault."""
        if bad.any():
            i = int(bad.argmax())
            refuse(self.path, 0 if self.lines is None else self.lines[i],
                   ("" if self.lines is not None else f"sphere {i}: ") + what(i))

    def check(self):
        """Refuses what no spheres are, and repeated ids."""
        r = self.radii
        if not len(r):
            refuse(self.path, 0, "no spheres; expected lines x y z r (m)")
        self.refuse(~((r >= SMALLEST) & (r <= LARGEST)),
                    lambda i: f"radius r = {text(r[i])} m; expected {SMALLEST} to {LARGEST:.0f} (m)")
        for axis, x in zip("xyz", self.centres.T):
            self.refuse(~(abs(x) <= FARTHEST), lambda i: f"centre {axis} = {text(x[i])} m; expected a number within "
                                                         f"{FARTHEST:.0f} (m)")
            self.refuse(~((x - r < x) & (x < x + r)), lambda i:
                        f"radius r = {text(r[i])} m is lost in the rounding of its centre {axis} = {text(x[i])} m; expected "
                        "coordinates from an origin near the grains")
        for motion in (self.velocities, self.spins):
            if motion is not None:
                self.refuse(~np.isfinite(motion).all(axis=1),
                            lambda i: "velocity or spin is not finite; expected numbers (m/s, rad/s)")
        if self.ids is not None:
            again = np.ones(len(self.ids), bool)
            again[np.unique(self.ids, return_index=True)[1]] = False
            self.refuse(again, lambda i: "its id is that of another sphere; expected each once")

    def check_ids(self, first):
        """Counts the ids from 0.   first: number of the first grain in files of this kind"""
        if self.ids is not None:
            said, self.ids = self.ids, self.ids - first
            self.refuse(~((self.ids >= 0) & (self.ids < FIRST_UNREAL) & (self.ids == np.floor(self.ids))),
                        lambda i: f"id = {text(said[i])}; expected a whole number from {first}, below 2^32")

    def check_inside(self, box):
        for axis, x, low, high in zip("xyz", self.centres.T, *box):
            self.refuse(~((x >= low) & (x <= high)), lambda i:
                        f"centre {axis} = {text(x[i])} m lies outside the box, [{text(low)}, {text(high)}] m; are the units "
                        "m, and is it the box of this packing?")

    def bounding_box(self):
        radii = self.radii[:, None]
        return np.array([(self.centres - radii).min(axis=0), (self.centres + radii).max(axis=0)])

    def density(self, assumed, scale):
        """The one of all, kg/m3: as the file says it, by itself or with masses; else the assumed one."""
        d, m = self.densities, self.masses
        if d is not None:
            self.refuse(d != d[0], lambda i: f"density {text(d[i])} kg/m3, above it is {text(d[0])}; expected one density: "
                                             "Isostat has no packings of several")
        if m is None:
            return assumed if d is None else float(d[0])
        self.refuse(~((m > 0) & np.isfinite(m)), lambda i: f"mass = {text(m[i])} kg; expected > 0")
        with np.errstate(all="ignore"):
            volumes = 4 / 3 * math.pi * (scale * self.radii) ** 3
            own, one = m / volumes, m.sum() / volumes.sum() if d is None else d[0]
            differs = ~(abs(own / one - 1) <= SAME_DENSITY)
        self.refuse(differs, lambda i:
                    f"mass = {m[i]:g} kg of a sphere of r = {scale * self.radii[i]:g} m is a density of {own[i]:g} kg/m3, that "
                    f"of the packing is {one:g}; expected one density within {100 * SAME_DENSITY:g} %: Isostat has no packings "
                    "of several")
        return float(one)


@dataclasses.dataclass
class Found:
    """What a file holds: spheres, the box that its walls make or the edges of a periodic cell, and notes for the user."""
    spheres: Spheres
    box: np.ndarray | None = None  # (2, 3); None without a cell: the bounding box of the spheres
    cell: np.ndarray | None = None  # edges in columns
    notes: list[str] = dataclasses.field(default_factory=list)


def of_axis(a, k):
    """Names of the columns of one axis: centre, velocity, spin."""
    return {a: (a, f"{a}u", f"pos{a}", f"pos_{a}", f"{a}pos", f"{a}_pos", f"position{a}", f"position_{a}", f"ballpos{a}",
                f"ball_pos_{a}", f"points{k}", f"points_{k}"),
            f"v{a}": (f"v{a}", f"vel{a}", f"vel_{a}", f"velocity{a}", f"velocity_{a}", f"velocity{k}"),
            f"w{a}": (f"w{a}", f"omega{a}", f"omega_{a}", f"spin{a}", f"spin_{a}", f"spin{k}")}


NAMES = {"id": ("id", "ballid", "ball_id", "particleid", "particle_id"),
         "r": ("r", "radius", "rad", "radii", "ballradius", "ball_radius"), "d": ("diameter", "diam", "dia", "d"),
         "density": ("density", "rho"), "mass": ("mass",), "clump": ("clumpid", "clump_id", "clump"),
         **of_axis("x", 0), **of_axis("y", 1), **of_axis("z", 2)}
UNITS = {"r": "m", "d": "m", "density": "kg/m3", "mass": "kg", **{a: "m" for a in "xyz"}, **{f"v{a}": "m/s" for a in "xyz"},
         **{f"w{a}": "rad/s" for a in "xyz"}}


def metres_in(unit):
    try:
        return _core._quantity(f"1 {unit}", "length")
    except _core.InputError:
        return 0


class Columns:
    """Which words of a row are the numbers of a sphere, by the names of the columns; others are ignored.

    A name may have quotes, capitals and its unit in brackets: "X (mm)".
    first_id: number of the first grain in files of this kind. open_ended: rows may have more words than there are names
    """

    def __init__(self, names, first_id=0, open_ended=False):
        self.n, self.first_id, self.open_ended = len(names), first_id, open_ended
        parts = [re.match(r"([^(\[]*)(?:[(\[]([^)\]]*))?", name, re.S) for name in names]
        known = ["".join(c for c in part[1].lower() if c.isascii() and (c.isalnum() or c == "_")) for part in parts]
        self.at = {}
        for key, any_of in NAMES.items():
            if key != "d" or "r" not in self.at:
                self.at.update((key, c) for c in [c for c, name in enumerate(known) if name in any_of][:1])
        self.units = [(known[c], parts[c][2], UNITS.get(key)) for key, c in self.at.items() if parts[c][2]]
        self.keys = list(self.at)

    def missing(self):
        """What is missing of x y z radius, as text; empty if nothing."""
        axis = next((a for a in "xyz" if a not in self.at), None)
        return f"a column {axis}" if axis else "" if "r" in self.at or "d" in self.at else "a column radius, r or diameter"

    def check_units(self, path, line, scale):
        """Refuses a column in another unit than the one in which it is read.   scale: metres in the unit of the file"""
        for name, unit, expected in self.units:
            bare = unit.removesuffix("/s") if expected == "m/s" else unit
            if expected in ("m", "m/s"):
                if not abs(metres_in(bare) / scale - 1) < 1e-9:
                    refuse(path, line, _core._in_python(f"the column {name} is in {unit}, and is read in units of {scale:g} m; "
                                                        f"expected the same. Give isostat convert --length-unit {bare}"))
            elif expected and unit != expected:
                refuse(path, line, f"the column {name} is in {unit}; expected {expected}")

    def row(self, path, line, row):
        """Its numbers, in the order of `keys`."""
        words = split_words(row)
        if len(words) == self.n + 1 and row.startswith('"'):  # the name of the row, as R writes it
            del words[0]
        if len(words) < self.n or (len(words) > self.n and not self.open_ended):
            refuse(path, line, f'"{row}"; expected {self.n} columns, as many as have a name')
        values = [number(words[c]) for c in self.at.values()]
        if None in values:
            c = self.at[self.keys[values.index(None)]]
            refuse(path, line, f'"{words[c]}" is no number; expected one in column {c + 1}')
        return values

    def spheres(self, path, rows, lines):
        """Of the rows that row() has read."""
        table = dict(zip(self.keys, np.array(rows, float).reshape(len(rows), len(self.keys)).T))

        def vectors(*keys):
            return np.stack([table[key] for key in keys], axis=1) if all(key in table for key in keys) else None
        found = Spheres(path, vectors("x", "y", "z"), table["r"] if "r" in table else table["d"] / 2, table.get("id"),
                        vectors("vx", "vy", "vz"), vectors("wx", "wy", "wz"), table.get("density"), table.get("mass"),
                        np.array(lines, int))
        if "clump" in table:
            found.refuse(table["clump"] != -1, lambda i:
                         f"clump id {text(table['clump'][i])}; expected -1, no clump: Isostat has spheres only. If column "
                         f"{self.at['clump'] + 1} is something else, name the columns in a first line, such as x y z r type")
        found.check_ids(self.first_id)
        return found

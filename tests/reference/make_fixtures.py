#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Thins the reference runs of YADE to what the tests compare.

    make_fixtures.py <reference folder> [<output folder>]

The reference folder holds pair/*.csv.gz and n1000/{medium,vloose}/comp_*; see README.md here. Numbers are written with
the fewest digits that give the same double back, files without a date: the same input gives the same bytes.
"""
import csv
import gzip
import io
import pathlib
import sys

PAIR_PATHS = ("normal", "shear", "roll", "twist", "combined", "wall")
COMBINED_STEPS = 4200  # of 9000: all of shear, rolling and twisting at once under a turning normal
STEPS = (1, 10, 100)


def triples(*names):
    return [name + axis for name in names for axis in "xyz"]


PAIR_COLUMNS = (["step"] + triples("x1", "x2", "v1", "v2", "w1", "w2")
                + ["fn"] + triples("fs", "mb", "mt", "F2", "T1", "T2"))
START_COLUMNS = ["id1", "id2", "un"] + triples("n") + ["kn", "fn"] + triples("fs", "mb", "mt")
CONTACT_COLUMNS = ["id1", "id2", "fn"] + triples("fs", "mb", "mt")
PATH_COLUMNS = ["step", "eps_y", "p", "q"]


def shortest(text):
    """The same number in as few characters as possible."""
    try:
        return str(int(text))
    except ValueError:
        return repr(float(text)).removesuffix(".0")


def read(path):
    opener = gzip.open if path.suffix == ".gz" else open
    with opener(path, "rt", newline="") as lines:
        return list(csv.DictReader(lines))


def write(path, columns, rows):
    text = io.StringIO()
    text.write(",".join(columns) + "\n")
    for row in rows:
        text.write(",".join(shortest(row[c]) for c in columns) + "\n")
    path.parent.mkdir(parents=True, exist_ok=True)
    data = text.getvalue().encode()
    if path.suffix == ".gz":
        with open(path, "wb") as raw, gzip.GzipFile("", "wb", 9, raw, mtime=0) as packed:
            packed.write(data)
    else:
        path.write_bytes(data)


def pair_paths(source, target):
    for name in PAIR_PATHS:
        rows = read(source / "pair" / f"{name}.csv.gz")
        if name == "combined":
            rows = rows[:COMBINED_STEPS]
        write(target / "pair" / f"{name}.csv.gz", PAIR_COLUMNS, rows)


def packing(source, target):
    def table(what, step, ending):
        return source / f"comp_{what}_step{step}.csv{ending}"

    write(target / "comp_particles_step0.csv.gz", ["id"] + list("xyzr") + triples("v", "w"),
          read(table("particles", 0, ".gz")))
    write(target / "comp_contacts_step0.csv.gz", START_COLUMNS, read(table("contacts", 0, ".gz")))
    write(target / "comp_walls_step0.csv", ["wall", "pos"], read(table("walls", 0, "")))
    for step in STEPS:
        write(target / f"positions_step{step}.csv.gz", ["id"] + list("xyz"), read(table("particles", step, ".gz")))
        touching = [row for row in read(table("contacts", step, ".gz"))
                    if int(row["id1"]) >= 0 and int(row["id2"]) >= 0 and float(row["fn"]) > 0]
        write(target / f"contacts_step{step}.csv.gz", CONTACT_COLUMNS, touching)
        walls = read(table("walls", step, ""))
        for row in walls:
            row["force"] = row[{"x": "force_on_wall_x", "y": "force_y", "z": "force_z"}[row["axis"]]]
        write(target / f"walls_step{step}.csv", ["wall", "pos", "force"], walls)
    write(target / "comp_path.csv", PATH_COLUMNS, read(source / "comp_path.csv"))


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    source = pathlib.Path(sys.argv[1])
    target = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else pathlib.Path(__file__).parent
    pair_paths(source, target)
    for name in ("medium", "vloose"):
        packing(source / "n1000" / name, target / "n1000" / name)


if __name__ == "__main__":
    main()

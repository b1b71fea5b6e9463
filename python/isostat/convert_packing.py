# SPDX-License-Identifier: BSD-3-Clause
"""isostat convert: a packing from one format into another, checked on the way.   tested: tests/apps/convert_test.py"""
import sys

from isostat import _core, packings
from isostat.campaign import command


def main(words: list[str]) -> int:
    line = command.line_of("convert", "A packing from one format into another, checked on the way: units, overlaps, "
                           "box")
    line.add_argument("source", metavar="IN", help="specimen, snapshot (.h5) or library.h5#s0007 of Isostat; LAMMPS dump "
                      "or data file (units si, atom_style sphere); text `x y z r` of YADE; CSV; VTP; folder of tables")
    line.add_argument("target", metavar="OUT", help="the same packing in another format, by its ending: .h5 .dump .data "
                      ".txt .csv .vtp")
    line.add_argument("--to", default="", metavar="FORMAT", help="specimen, lammps-dump, lammps-data, yade, csv or vtp, "
                      "where the ending is another")
    unit = line.add_mutually_exclusive_group()
    unit.add_argument("--scale", type=float, help="metres in a unit of length of IN, such as 1e-3")
    unit.add_argument("--length-unit", metavar="UNIT", help="unit of length of IN: m, cm, mm or um")
    line.add_argument("--density", help="of the grains, where IN does not say it; default 2650 kg/m3")
    line.add_argument("--domain", choices=("rigid-box", "periodic-cell"), default="", help="where IN does not say it")
    line.add_argument("--anyway", action="store_true", help="writes what the checks refuse")
    line.add_argument("--overwrite", action="store_true", help="replaces OUT")
    asked = line.parse_args(words)

    def convert():
        unit, scale, density = asked.length_unit, asked.scale, asked.density
        if unit:
            scale = packings.quantity(f"--length-unit {unit}", f"1 {unit}", "length")
        how = packings.Reading(1 if scale is None else scale, scale == 1,
                               packings.quantity(f"--density {density}", density or "2650 kg/m3", "density"),
                               density is not None, asked.domain, anyway=asked.anyway)
        specimen, notes = packings.convert_any(asked.source, asked.target, how, asked.to, asked.overwrite)
        print(f"{asked.target}\n{_core._figures(specimen.snapshot)}", end="")
        for note in notes:
            print(f"warning: {note}", file=sys.stderr)
    return command.run(convert)

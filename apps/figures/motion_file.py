# SPDX-License-Identifier: BSD-3-Clause
"""Leaves a motion of a soil column as a record of PEER's format AT2, which motion.file of another scene reads.

    isostat motion RESULTS                                   along x at the surface, RESULTS/surface_x.at2
    isostat motion RESULTS --at "5 m" --axis y -o mine.at2   at one of output.depths

tested: tests/apps/site_response_test.py
"""
import pathlib
import sys

from .column_results import Column, quantity
from .command_line import CommandLine
from .files import BadInput, check_results, check_target
from .site_response import BEGINNING, write_at2

PLACES = ("surface", "input", "within")
LENGTHS = ("m", "cm", "mm")


def place(text):
    """One of PLACES or a depth, m.   Raises ValueError"""
    if text in PLACES:
        return text
    if text.partition(" ")[2].strip() not in LENGTHS:
        raise ValueError(text)
    return quantity(text)


def main():
    parser = CommandLine(prog="isostat motion", description=__doc__.splitlines()[0])
    parser.add_argument("results", type=pathlib.Path, help="results folder of a soil column that was shaken")
    parser.add_argument("--at", default="surface", metavar="PLACE",
                        help="surface (default), input, within (at the base), or one of output.depths: \"5 m\"")
    parser.add_argument("--axis", choices="xyz", default="x", help="default: x")
    parser.add_argument("-o", "--output", type=pathlib.Path, help="default: RESULTS/PLACE_AXIS.at2")
    words = parser.parse_args()
    try:
        check_results(words.results)
        path = words.output or words.results / f"{words.at.replace(' ', '')}_{words.axis}.at2"
        check_target(path, {".at2": BEGINNING.encode()})
        write_at2(Column(words.results), path, place(words.at), words.axis)
    except (BadInput, OSError) as error:
        print(f"error: {str(error).rstrip('.')}.", file=sys.stderr)
        return 2
    except ValueError:
        print(f"error: --at {words.at}: must be {', '.join(PLACES)} or a depth with its unit ({', '.join(LENGTHS)}), "
              "\"5 m\".",
              file=sys.stderr)
        return 2
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main())

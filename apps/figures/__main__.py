# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of a finished or running program from the files in its results folder.

    python3 -m figures PROGRAM RESULTS [--out DIR] [--beside OTHER ...]        default DIR: RESULTS/figures

The top of each program's module says what its figures show. The exit code is 2 if the folder cannot be drawn.
"""
import importlib
import pathlib
import sys

try:
    import matplotlib

    from .command_line import CommandLine
    from .common import BadInput, note
except ModuleNotFoundError as missing:
    if missing.name not in ("matplotlib", "numpy", "h5py"):
        raise
    sys.exit(f"error: Python has no module {missing.name}: install it, apt-get install python3-{missing.name}")

PROGRAMS = ("calibrate", "element_test", "resistance", "micromechanics", "soil_column", "soil_test", "rve_replay",
            "biaxial", "column_ensemble")


def main():
    parser = CommandLine(prog="figures", description=__doc__.splitlines()[0])
    parser.add_argument("program", choices=PROGRAMS, help="whose results they are")
    parser.add_argument("results", type=pathlib.Path, help="its results folder")
    parser.add_argument("--out", type=pathlib.Path, help="folder of the figures; default: RESULTS/figures")
    parser.add_argument("--beside", type=pathlib.Path, nargs="*", default=[],
                        help="other results that a figure shows, too (biaxial: fig_band)")
    arguments = parser.parse_args()
    matplotlib.use("Agg")  # files only
    drawing = importlib.import_module(f"figures.{arguments.program}").DRAWING
    try:
        results = drawing.results(arguments.results, arguments.beside)
        drawing.draw(results, arguments.out or arguments.results / "figures")
    except (BadInput, OSError) as error:
        note(error)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())

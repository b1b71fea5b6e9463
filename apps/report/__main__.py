# SPDX-License-Identifier: BSD-3-Clause
"""Leaves the figures and the report of results, or compares two of them.

    python3 -m report leave PROGRAM RESULTS             RESULTS/figures/*.png and RESULTS/report.html: after a run
    python3 -m report report RESULTS                    the same, of the program that RESULTS/provenance.txt names
    python3 -m report compare A B [-o compare.html]     two runs side by side

The exit code is 2 if a folder holds no results, 3 if there are figures and no report.
"""
import pathlib
import sys

try:
    import matplotlib

    from figures.command_line import CommandLine
    from figures.files import BadInput

    from . import run
    from .folder import NUMBERS, find_results
except ModuleNotFoundError as missing:
    if missing.name not in ("matplotlib", "numpy", "h5py"):
        raise
    sys.exit(f"error: Python has no module {missing.name}: install it, apt-get install python3-{missing.name}")


COMMANDS = {"leave": "Figures and report of results of a program", "compare": "Two runs side by side in one file",
            "report": "Draw figures and report.html of results again"}


def parse(command, words):
    """Arguments of a command."""
    line = CommandLine(prog=f"isostat {command}", description=COMMANDS[command])
    if command == "compare":
        line.add_argument("first", type=pathlib.Path, help="results folder of a finished run")
        line.add_argument("second", type=pathlib.Path, help="results folder of another one of the same program")
        line.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("compare.html"),
                          help="output file; an existing page is replaced (default: compare.html)")
        return line.parse_args(words)
    if command == "leave":
        line.add_argument("program", choices=NUMBERS)
    line.add_argument("results", type=pathlib.Path, help="results folder of a run, finished or under way")
    return line.parse_args(words)


def main():
    command, *words = sys.argv[1:]
    arguments = parse(command, words)
    matplotlib.use("Agg")  # files only
    try:
        if command == "leave":
            return run.leave(arguments.results, arguments.program)
        if command == "report":
            return run.leave(arguments.results, find_results(arguments.results).program)
        from . import compare  # pylint: disable=import-outside-toplevel  (a run does not need it)
        return compare.leave(arguments.first, arguments.second, arguments.output)
    except BadInput as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())

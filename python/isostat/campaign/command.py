# SPDX-License-Identifier: BSD-3-Clause
"""What the commands share that do many runs: options, exit codes, progress, figures."""
import argparse
import concurrent.futures
import contextlib
import os
import pathlib
import subprocess
import sys
from collections.abc import Callable
from typing import Any

from isostat import _core
from isostat.calls import stopped_by_signals
from isostat.campaign.engines import ENGINE_TEXT, engine
from isostat.campaign.folder import write_replacing
from isostat.figures.command_line import CommandLine
from isostat.figures.files import BadInput, Damaged

SCENES = next((folder for parent in pathlib.Path(__file__).parents[2:7]
               if (folder := parent / "share/isostat").is_dir()), pathlib.Path("apps"))


WITHOUT_REPORT = 3  # exit code of `report leave`


def line_of(name: str, description: str, **more: Any) -> CommandLine:
    """The command line of a command of isostat."""
    return CommandLine(prog=f"isostat {name}", description=description, **more)


def shipped(folder: str, name: str) -> str:
    """A file as it is named, or else the installed one of this name."""
    installed = str(SCENES / folder / name)
    return installed if not os.path.exists(name) and os.path.isfile(installed) else name


def add_scene(line: argparse.ArgumentParser, text: str, nargs: str | None = None) -> None:
    line.add_argument("scene", metavar="SCENE", nargs=nargs, type=lambda name: shipped("scenes", name), help=text)
    line.add_argument("--set", action="append", default=[], metavar="KEY=VALUE",
                      help='override a key, e.g. --set specimen.pressure="100 kPa" (repeatable)')


def overrides(given: list[str]) -> dict[str, str]:
    """--set of the command line, as scenes take it."""
    for word in given:
        if "=" not in word:
            raise _core.InputError(f"--set {word}: must be KEY=VALUE, e.g. --set motion.damping=0.1.")
    return dict(word.split("=", 1) for word in given)


def add_campaign(line: argparse.ArgumentParser, folder: str, figures: bool = True) -> None:
    """Options of a campaign. folder: default of --output, as the help says it. figures: they can be left out"""
    add_engine(line)
    line.add_argument("-o", "--output", type=pathlib.Path, help=f"results folder (default: {folder})")
    line.add_argument("--overwrite", action="store_true", help="start again: remove finished runs of this folder")
    if figures:
        line.add_argument("--no-figures", action="store_true", help="leave no figure and no report")


def add_engine(line: argparse.ArgumentParser, jobs: int = 1) -> None:
    """Where runs are done, and the messages meanwhile."""
    line.add_argument("-j", "--jobs", type=count(0, 1024), default=jobs,
                      help=f"runs side by side on this machine, each on one thread (default {jobs}; 0: one for each core). "
                           "Results do not depend on it")
    line.add_argument("--engine", help=ENGINE_TEXT)
    line.add_argument("-q", "--quiet", action="store_true", help="no progress on stderr")


def count(low: int, high: int) -> Callable[[str], int]:
    """For argparse: a whole number within limits."""
    def whole(text: str) -> int:
        number = int(text)
        if not low <= number <= high:
            raise argparse.ArgumentTypeError(f"{number} is not in [{low}, {high}]")
        return number
    whole.__name__ = "whole number"
    return whole


def run(program: Callable[[], None]) -> int:
    """The exit code of a command: 0 done, 1 failed, 2 bad input, 130 interrupted, each with a line on stderr."""
    try:
        with stopped_by_signals():
            program()
            sys.stdout.flush()
        return 0
    except (_core.InputError, BadInput, Damaged) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted; what has been run is kept, the same command continues", file=sys.stderr)
        return 130
    except BrokenPipeError:  # who reads has seen enough: `isostat sands | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except (_core.RunFailure, OSError, MemoryError) as error:
        print(f"failed: {error}", file=sys.stderr)
        return 1


def run_campaign(options: argparse.Namespace,
                 program: Callable[[concurrent.futures.Executor], None]) -> int:
    """As run(), with the engine that the options name."""
    return run(lambda: with_engine(options, program))


def with_engine(options: argparse.Namespace, program: Callable[[concurrent.futures.Executor], None]) -> None:
    """Calls the program with the engine that the options name; ranks above 0 only help."""
    with engine(options.engine, options.jobs) as executor:
        if executor is not None:
            program(executor)


class Progress:
    """Lines on stderr: `state()` of the campaign and what a run has come to."""

    def __init__(self, state: Callable[[], str], quiet: bool):
        self.state, self.quiet = state, quiet

    def say(self, line: str) -> None:
        if not self.quiet:
            with contextlib.suppress(BrokenPipeError):  # who reads may have ended
                print(self.state() + line, file=sys.stderr, flush=True)

    def waiting(self, runs) -> None:
        """What runs at work said last: for complete()."""
        self.say("".join(f"\n       {run.name}: {run.last_line}" for run in runs))


def duration_text(seconds: float) -> str:
    """"42 s", "17 min", "3.1 h"."""
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 100 * 60 else f"{seconds / 3600:.1f} h"


def leave(folder: pathlib.Path, text: str, program: str, figures: bool) -> None:
    """Prints the summary, keeps it as summary.txt, and leaves figures and report.html next to it."""
    write_replacing(folder / "summary.txt", text)
    print(text, end="")
    if figures:
        if sys.stderr.isatty():
            print("  drawing figures ...", file=sys.stderr, flush=True)
        print(f"  {drawn(folder, program)}")


def drawn(folder: pathlib.Path, program: str) -> str:
    """Draws the figures of a folder, in a process of its own.   Returns what came of it"""
    call = [sys.executable, "-B", "-P", "-m", "report", "leave", program, "--", str(folder)]
    with contextlib.suppress(KeyboardInterrupt):
        done = subprocess.run(call, env={**os.environ, "PYTHONPATH": str(pathlib.Path(__file__).parents[1])},
                              capture_output=True, text=True, check=False)
        write_replacing(folder / "figures.log", done.stdout + done.stderr)
        if done.returncode == 0:
            return f"figures in {folder / 'figures'}, all on one page in {folder / 'report.html'}"
        if done.returncode == WITHOUT_REPORT:
            return f"figures in {folder / 'figures'}, without a report: {done.stderr.strip().splitlines()[-1]}"
        return f"figures were not drawn: {(done.stderr.strip().splitlines() or [str(done.returncode)])[-1]}"
    raise KeyboardInterrupt

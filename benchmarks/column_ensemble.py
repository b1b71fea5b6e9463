#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a column of grains that liquefies depends on: mesh, packings of a point, the same at all depths or not, seeds.

    column_ensemble.py BIN FOLDER run [--only WORD ...] [--minutes 60] [--dry-run]
    column_ensemble.py BIN FOLDER report [--docs docs]

BIN     folder of soil_column and isostat
FOLDER  specimens and runs; what has finished is not done again, what was interrupted goes on
report  tables on standard output as Markdown, figures in DOCS/results/ensemble

The scene is apps/scenes/column/quick_ensemble.toml; benchmarks/column_ensemble/plan.py says what is varied.
"""
import argparse
import os
import pathlib
import shlex
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from column_ensemble import plan  # noqa: E402  (beside this file, wherever it is called from)

SCENES = HERE.parent / "apps/scenes"


def execute(command):
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run(["nice", "-n", "5", *map(str, command)], capture_output=True, text=True, check=False,
                          stdin=subprocess.DEVNULL, env=environment)


def overrides(settings):
    return [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]


def file_of(arguments, what, grains):
    return arguments.folder / f"{what}{'' if grains == plan.GRAINS else f'_{grains}'}.h5"


def library(arguments, grains):
    """Specimens of so many grains at 20 kPa."""
    path = file_of(arguments, "library", grains)
    if not path.exists():
        seeds = plan.SEEDS if grains == plan.GRAINS else plan.LARGE_SEEDS
        done = execute([arguments.bin / "isostat", "library", SCENES / "rve_library.toml", "-o", path, "-j", 1, "-q",
                        "--pressures", "20 kPa", "-n", seeds,
                        *overrides({"contact.young": "1 GPa", "grading.grains": grains,
                                    "grading.cloud_edge": f"{3.107 * (grains / 300) ** (1 / 3):.3f} mm"})])
        if not path.exists():
            raise SystemExit(f"specimens: {done.stderr}")
    return path


def command(arguments, run, specimens):
    settings = {**run.settings, "grains.library": specimens.resolve(),
                "grains.cache": file_of(arguments, "in_situ", run.grains).resolve()}
    words = [arguments.bin / "soil_column", SCENES / "column/quick_ensemble.toml", "-q", "--no-figures", "-o",
             arguments.folder / "runs" / run.name, *overrides(settings)]
    interrupted = (arguments.folder / "runs" / run.name / "checkpoint").exists()
    return [*words, "--resume" if interrupted else "--overwrite"]


def campaign(arguments):
    begin = time.monotonic()
    todo = [run for run in plan.runs() if not arguments.only or any(word in run.name for word in arguments.only)]
    for k, run in enumerate(todo, 1):
        if (arguments.folder / "runs" / run.name / "summary.txt").exists():
            continue
        words = command(arguments, run, library(arguments, run.grains))
        if arguments.dry_run:
            print(shlex.join(map(str, words)))
            continue
        if time.monotonic() - begin > 60 * arguments.minutes:
            print("the time is over; the same command goes on")
            return
        started, done = time.monotonic(), execute(words)
        result = "done" if done.returncode == 0 else f"failed ({done.returncode}): {done.stderr.strip()}"
        print(f"{k} of {len(todo)}: {run.name} {result}, {time.monotonic() - started:.0f} s", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("what", choices=("run", "report"))
    parser.add_argument("--only", nargs="+", default=[], metavar="WORD",
                        help="runs that have one of these in their name")
    parser.add_argument("--minutes", type=float, default=60, help="no run starts later")
    parser.add_argument("--dry-run", action="store_true", help="prints the command of every run and starts none")
    parser.add_argument("--docs", type=pathlib.Path, default=HERE.parent / "docs")
    arguments = parser.parse_args()
    if arguments.what == "report":
        from column_ensemble import report  # pylint: disable=import-outside-toplevel  (runs need no matplotlib)
        report.write(arguments.folder, arguments.docs / "results/ensemble")
    else:
        arguments.folder.mkdir(parents=True, exist_ok=True)
        campaign(arguments)


if __name__ == "__main__":
    main()

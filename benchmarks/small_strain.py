#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Stiffness against pressure, modulus reduction and damping of packings, with both contact laws.

    PYTHONPATH=build/release/python python3 benchmarks/small_strain.py stiffness
    PYTHONPATH=build/release/python python3 benchmarks/small_strain.py velocity
    PYTHONPATH=build/release/python python3 benchmarks/small_strain.py reduction --jobs 2
    PYTHONPATH=build/release/python python3 benchmarks/small_strain.py figures

Each run leaves one file in --output and is not done again: an interrupted campaign goes on where it was. `figures`
draws what there is and writes the tables.
"""
import argparse
import concurrent.futures
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from small_strain import plan, report, runs  # noqa: E402  (beside this file, wherever it is called from)


def parse():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=("stiffness", "velocity", "reduction", "figures"))
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("results/small_strain"))
    parser.add_argument("--tables", type=pathlib.Path, default=pathlib.Path("docs/results"),
                        help="where `figures` writes")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--grains", type=int, default=1000)
    parser.add_argument("--jobs", type=int, default=1)
    return parser.parse_args()


def do(run, folder, grains):
    """One run, unless its file is there."""
    path = folder / "runs" / f"{run.name}.json"
    if path.exists():
        return run.name, "was there"
    result = getattr(runs, run.kind)(run, folder / "specimens", grains)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps({**run.record(), **result}, indent=1))
    partial.rename(path)
    return run.name, result["seconds"]


def main():
    options = parse()
    if options.what == "figures":
        report.write(options.output, options.tables)
        return
    todo = plan.runs(options.what, options.seeds)
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        futures = [pool.submit(do, run, options.output, options.grains) for run in todo]
        for number, future in enumerate(concurrent.futures.as_completed(futures), 1):
            name, seconds = future.result()
            print(f"{number} of {len(todo)}: {name}, {seconds if isinstance(seconds, str) else f'{seconds:.1f} s'}",
                  flush=True)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Parallel efficiency of a column of grains: 1 rank, 2 ranks, 2 threads, two runs of 1 rank side by side, interleaved.

    rank_efficiency.py BIN SCENE LIBRARY [--rounds 5] [--set key=value ...]

The last case is the machine's own limit: two programs that share nothing but caches and memory. Times are the
wall clock that soil_column measures, with the reading of packings that were brought to their stress before. Prints
medians and ranges; efficiency is T(1)/(2 T), the limit T(1)/T(side by side). A quiet machine with two cores, please.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

ENVIRONMENT = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1",
               "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def start(arguments, ranks, folder, threads=1):
    command = ["mpirun", "--bind-to", "none", "-n", str(ranks), str(arguments.bin / "soil_column"),
               str(arguments.scene), "-o", folder, "-q", "--no-figures", "--threads", str(threads),
               "--set", f"grains.library={arguments.library.resolve()}"]
    for setting in arguments.set:
        command += ["--set", setting]
    return folder, subprocess.Popen(command, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)


def seconds(run):
    folder, process = run
    if process.wait():
        raise SystemExit("soil_column failed")
    return json.loads((pathlib.Path(folder) / "times.json").read_text(encoding="utf-8"))["wall"]


def measure(arguments, cache):
    cases = {"1 rank": (1, 1, 1), "2 ranks": (2, 1, 1), "1 rank of 2 threads": (1, 2, 1),
             "two runs side by side": (1, 1, 2)}
    times = {name: [] for name in cases}
    for _ in range(arguments.rounds):
        for name, (ranks, threads, copies) in cases.items():
            with tempfile.TemporaryDirectory() as folder:
                arguments.set[0] = f"grains.cache={cache}"
                running = [start(arguments, ranks, f"{folder}/{k}", threads) for k in range(copies)]
                times[name].append(max(seconds(run) for run in running))
                print(f"  {name}: {times[name][-1]:.2f} s", flush=True)
    return times


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("bin", type=pathlib.Path)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("library", type=pathlib.Path)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--set", action="append", default=[""])
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as cache:
        with tempfile.TemporaryDirectory() as folder:  # states in situ are made before the clock runs
            arguments.set[0] = f"grains.cache={cache}/in_situ.h5"
            seconds(start(arguments, 1, f"{folder}/first"))
        times = measure(arguments, f"{cache}/in_situ.h5")
    for name, values in times.items():
        print(f"{name:24} median {statistics.median(values):7.2f} s   ({min(values):.2f} to {max(values):.2f})")
    one = statistics.median(times["1 rank"])
    for name in ("2 ranks", "1 rank of 2 threads"):
        print(f"efficiency: {name:20} {one / (2 * statistics.median(times[name])):.3f}")
    print(f"limit of the machine             {one / statistics.median(times['two runs side by side']):.3f}")


if __name__ == "__main__":
    main()

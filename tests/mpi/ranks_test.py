#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""One mesh over 1, 2 and 3 ranks gives the same numbers to 1e-10.

    ranks_test.py BIN
"""
import os
import subprocess
import sys

TIME_LIMIT = float(os.environ.get("ISOSTAT_TIME_LIMIT", "3600")) / 4  # s, as in tests/apps/support.py
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1",
                   OPENBLAS_NUM_THREADS="1")


def numbers_on(ranks, program):
    """Cells of the smallest part, and the lines of numbers a program prints."""
    run = subprocess.run(["mpirun", "--oversubscribe", "-n", str(ranks), program], env=ENVIRONMENT, timeout=TIME_LIMIT,
                         capture_output=True, text=True, check=False)
    assert run.returncode == 0, f"{ranks} ranks: exit code {run.returncode}\n{run.stderr[-2000:]}"
    lines = [line.split() for line in run.stdout.splitlines()]
    fewest = min(int(words[2]) for words in lines if words[0] == "cells")
    return fewest, [[float(word) for word in words] for words in lines if words[0] != "cells"]


def main():
    program = os.path.join(sys.argv[1], "distributed_waves")
    _, expected = numbers_on(1, program)
    assert len(expected) == 4 and all(abs(row[1]) > 1e-5 for row in expected), expected
    for ranks in (2, 3):
        fewest, found = numbers_on(ranks, program)
        assert fewest > 0, "a rank without cells: nothing is shared out"
        worst = 0
        for a, b in zip(expected, found, strict=True):
            scale = [abs(x) for x in a]
            worst = max(worst, *(abs(x - y) / s if s else abs(x - y) for x, y, s in zip(a, b, scale)))
        print(f"{ranks} ranks against 1: {worst:.1e}")
        assert worst < 1e-10, (expected, found)


if __name__ == "__main__":
    main()

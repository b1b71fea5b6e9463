#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs a program on 1, 2 and 3 ranks with 1 and 2 threads each; its output must be the same every time.

    same_output.py MPIRUN PROGRAM        runs MPIRUN -n RANKS PROGRAM THREADS FOLDER, FOLDER being empty
"""
import os
import subprocess
import sys
import tempfile

TIME_LIMIT = float(os.environ.get("ISOSTAT_TIME_LIMIT", "3600")) / 4  # s, as in tests/apps/support.py
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", OPENBLAS_NUM_THREADS="1")


def output_of(mpirun, program, ranks, threads):
    with tempfile.TemporaryDirectory() as folder:
        command = [mpirun, "-n", str(ranks), "--oversubscribe", "--bind-to", "none", program, str(threads), folder]
        run = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
                             timeout=TIME_LIMIT, env=dict(ENVIRONMENT, OMP_NUM_THREADS=str(threads)))
    if run.returncode != 0:
        sys.exit(f"{ranks} ranks, {threads} threads: exit code {run.returncode}\n{run.stdout}{run.stderr}")
    return run.stdout


def main():
    mpirun, program = sys.argv[1:]
    expected = output_of(mpirun, program, 1, 1)
    print(expected, end="")
    for ranks, threads in ((1, 2), (2, 1), (2, 2), (3, 1), (3, 2)):
        found = output_of(mpirun, program, ranks, threads)
        if found != expected:
            sys.exit(f"{ranks} ranks, {threads} threads give another output:\n{found}")
        print(f"{ranks} ranks, {threads} threads: the same")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Consolidation in 3D of several sizes, on one rank and on two: a table of iterations, time, memory and error."""
import argparse
import subprocess
from pathlib import Path

HEAD = ("elements", "unknowns", "ranks", "solutions", "outer iterations: mean, most", "set-up, all: wall s", "CPU s",
        "memory, GB", "error of p/p_0")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", default="4,8,16,21", help="N of meshes of 4 N^3 elements (%(default)s)")
    parser.add_argument("--ranks", default="1,2", help="(%(default)s)")
    parser.add_argument("--steps", default="2", help="steps of T = 0.01 after the load (%(default)s)")
    parser.add_argument("--petsc", default="-statics_pc_type fieldsplit", help="(%(default)s)")
    parser.add_argument("--bin", type=Path, default=Path("build/release/bin"), help="folder of programs (%(default)s)")
    options = parser.parse_args()
    print(f"| {' | '.join(HEAD)} |\n|{'---|' * len(HEAD)}")
    for size in options.sizes.split(","):
        for ranks in options.ranks.split(","):
            subprocess.run(["nice", "mpirun", "--allow-run-as-root", "--oversubscribe", "-x", "OMP_NUM_THREADS=1", "-n",
                            ranks, options.bin / "consolidation_3d", size, options.steps, options.petsc], check=True)


if __name__ == "__main__":
    main()

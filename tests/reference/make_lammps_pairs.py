#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Drives two spheres in contact with LAMMPS along given paths and keeps what the Hertz-Mindlin law is compared with.

    make_lammps_pairs.py [<output folder>]          needs `lmp` of the package lammps (Debian 12: 29 Sep 2021)

The normal stays along x and the spheres do not spin about it on average: there the rotation of history, which LAMMPS
does by projection, does not enter. Relative tangential motion is by spins alone, since LAMMPS knows no alpha. Rolling
and twisting springs of LAMMPS are constant, so their paths keep the overlap, and the one that does not is without. The
same input gives the same bytes.
"""
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from make_fixtures import triples, write  # noqa: E402  (next to this file, wherever it is called from)

R1, R2, STEP = 2e-4, 1.5e-4, 5e-8
YOUNG, POISSON = 64.96e9, 0.12
ROLLING, LIMIT, TWISTING = 0.3, 0.5, 0.3  # alpha_r, eta_r, alpha_t
MU = math.tan(math.radians(18))
DEPTH = 2e-7  # largest overlap, m

COLUMNS = ["step"] + triples("x1", "x2", "v1", "v2", "w1", "w2", "F2", "T1", "T2")
SPIN = 40.0  # 1/s: to sliding within a few hundred steps
# name -> overlap over its largest as an expression of the time in periods, its derivative, spins of both by phase
PULSE = ("0.5-0.5*cos(2*PI*{t})+0.02*sin(14*PI*{t})", "PI*sin(2*PI*{t})+0.28*PI*cos(14*PI*{t})")
HELD = ("1", "0")
PATHS = {
    "shear": (*PULSE, [((0, 0, 0.3 * SPIN), (0, 0, 0.2 * SPIN)), ((0, 0.4 * SPIN, -SPIN), (0, 0, -SPIN)),
                       ((0, 0.2 * SPIN, 0.1 * SPIN), (0, -0.1 * SPIN, 0)), ((0, -SPIN, 0), (0, -0.5 * SPIN, SPIN))]),
    "roll": (*HELD, [((0, 0, 3 * SPIN), (0, 0, -4 * SPIN)), ((0, -3 * SPIN, 0), (0, 4 * SPIN, 0))]),
    "twist": (*HELD, [((SPIN, 0, 0), (-SPIN, 0, 0)), ((-2 * SPIN, 0, 0), (2 * SPIN, 0, 0))]),
}
PHASE = 600  # steps


def deck(name, overlap, rate, phases, dump):
    """A LAMMPS script. Two periods of the overlap over all phases, so that the contact opens once."""
    period = PHASE * len(phases) / 2 * STEP
    time = f"(step*{STEP:.17g}/{period:.17g})"
    contact = math.sqrt(R1 * R2 / (R1 + R2) * DEPTH)  # its radius, where the overlap is held
    shear = 8 * YOUNG / (4 * (1 + POISSON) * (2 - POISSON)) * contact
    reduced = R1 * R2 / (R1 + R2)
    rolling = R1 * R2 * shear * ROLLING / reduced**2
    limit = LIMIT * min(R1, R2) / reduced
    moments = "" if name == "shear" else f"rolling sds {rolling:.17g} 0 {limit:.17g} " \
        f"twisting sds {R1 * R2 * shear * TWISTING:.17g} 0 1e9"
    lines = f"""
units si
atom_style sphere
boundary f f f
newton off
comm_modify vel yes
region all block -0.01 0.01 -0.01 0.01 -0.01 0.01
create_box 2 all
create_atoms 1 single 0 0 0
create_atoms 2 single {R1 + R2:.17g} 0 0
set atom 1 diameter {2 * R1:.17g} density 2650
set atom 2 diameter {2 * R2:.17g} density 2650
pair_style granular
pair_coeff * * hertz/material {YOUNG:.17g} 0 {POISSON} tangential mindlin_rescale/force NULL 0 {MU:.17g} &
  {moments} damping velocity
neighbor 1e-4 bin
neigh_modify delay 0 every 1 check no
timestep {STEP}
group first id 1
group second id 2
variable x equal {-DEPTH}*({overlap.format(t=time)})
variable vx equal {-DEPTH / period}*({rate.format(t=time)})
variable zero equal 0
fix still first move linear 0 0 0
fix driven second move variable v_x v_zero v_zero v_vx v_zero v_zero
dump rows all custom 1 {dump} id x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz
dump_modify rows sort id format float %.17g
thermo 1000
"""
    for first, second in phases:
        lines += "".join(f"set atom {number} omega {w[0]:.17g} {w[1]:.17g} {w[2]:.17g}\n"
                         for number, w in ((1, first), (2, second))) + f"run {PHASE}\n"
    return lines


def rows(dump):
    """Of each step, both spheres."""
    lines = iter(dump.read_text().split("\n"))
    for line in lines:
        if not line.startswith("ITEM: TIMESTEP"):
            continue
        step = next(lines)
        for _ in range(7):
            next(lines)
        one, two = next(lines).split()[1:], next(lines).split()[1:]
        parts = [one[0:3], two[0:3], one[3:6], two[3:6], one[6:9], two[6:9], two[9:12], one[12:15], two[12:15]]
        yield dict(zip(COLUMNS, [step] + [value for part in parts for value in part], strict=True))


def main(target):
    for name, (overlap, rate, phases) in PATHS.items():
        with tempfile.TemporaryDirectory() as folder:
            dump = pathlib.Path(folder) / "dump"
            (pathlib.Path(folder) / "in").write_text(deck(name, overlap, rate, phases, dump))
            subprocess.run(["lmp", "-in", "in", "-log", "none"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
            write(target / f"{name}.csv.gz", COLUMNS, [row for row in rows(dump) if row["step"] != "0"])


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent / "pair_hertz"))

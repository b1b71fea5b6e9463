# SPDX-License-Identifier: BSD-3-Clause
"""LAMMPS and its descendant LIGGGHTS in the comparison; see codes.py for what a code is here."""
import math
import os
import re

from . import packing as packings
from .codes import HERE, Figures, repeated
from .process import PeerError, System, execute, last_lines, under_mpi

BUILD = HERE.parents[1] / "build"
WALLS = ("xl", "xu", "yl", "yu", "zl", "zu")


class Lammps:
    """One constant stiffness; see packing.matched_stiffness and lammps_shear.in."""
    kind, program, package = "lammps", "lmp", "lammps"
    tolerance = 0.05
    at_rest = False
    deck = "lammps_shear.in"
    ending = (
        "One normal stiffness kn for all contacts (Isostat: 2 E r1 r2/(r1 + r2)), chosen so that the packing starts "
        "with the mean stress it has in Isostat, one at walls likewise; tangential, rolling and twisting stiffness "
        "follow from kn with mean radii. Velocity Verlet; lever arms without overlap; it sorts grains by itself. ")
    law = ("Law: hooke, linear_history, rolling sds, twisting {twisting}; elastic frictionless walls that move "
           "uniformly, in Isostat exponentially (1e-7 of an edge apart after 1,500 steps). ")
    damping = ("No damping in both codes.", "Damping is viscous along the contact normal, with the loss per cycle of "
               "the local damping 0.2 in Isostat; give whole_step an option --damping and both run without.")

    def __init__(self, undamped, skin=0.05, twisting="sds", system=System(), native=False):
        """`native`: built from Debian's source for this processor (lammps_native.sh)."""
        self.undamped, self.skin, self.twisting, self.system = undamped, skin, twisting, system
        self.native = BUILD / "lammps-native" if native else None
        self.name = system.label(self.kind + "-native" * native)
        self.differs = self.law.format(twisting=twisting) + self.ending + self.damping[0 if undamped else 1]

    def version(self):
        found = f"{self.package.upper()} {self.system.version(self.package)}"
        return f"{found}, from source with -O3 -march=native" if self.native else found

    def install(self, threads):
        self.system.install(self.program, self.package)
        if threads > 1:
            self.system.install("mpirun", "openmpi-bin")
        if self.native:
            print(f"building {self.name} from source", flush=True)
            build = self.system.inside([HERE / "lammps_native.sh", self.native])
            execute(build, sorted(os.sched_getaffinity(0)), BUILD)

    def run(self, test):
        stiffness = packings.matched_stiffness(test.packing)
        variables = self.write_input(test, stiffness)
        program = self.native / self.program if self.native else self.program
        command = [program, "-log", "none", "-in", HERE / self.deck]
        for name, value in variables.items():
            command += ["-var", name, value]
        return repeated(lambda: self.once(command, test, stiffness), test.steps)

    def once(self, command, test, stiffness):
        final = test.folder / f"{self.kind}_final"
        final.unlink(missing_ok=True)
        out = execute(self.system.inside(under_mpi(command, test.threads)), test.cores, test.folder)
        loops = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps", out.text.partition("timed block")[2])
        seconds = [float(s) for s, steps in loops if int(steps) == test.steps]
        if not seconds or not final.exists():
            raise PeerError(f"{self.name} printed no loop time; its last lines:\n{last_lines(out.text)}")
        rows = final.read_text().split("ITEM: ATOMS")[-1].splitlines()[1:]
        spheres = [tuple(map(float, row.split())) for row in rows]
        if len(spheres) != len(test.packing.spheres):
            raise PeerError(f"{self.name} lost grains: {len(spheres)} of {len(test.packing.spheres)} are left")
        box = packings.sheared_box(test.packing.box, test.rate, test.n_steps() * test.time_step)
        p, q, contacts = packings.reached(packings.Packing(box, spheres), stiffness.wall)
        used = re.findall(r"([\d.]+)% CPU use", out.text)  # of the last run, the timed one; LIGGGHTS does not say
        return Figures(test.steps / seconds[0], p, q, contacts, float(used[-1]) / 100 if used else float("nan"))

    def common(self, test, stiffness):
        return {"data": f"{self.kind}_data", "final": f"{self.kind}_final", "kn": stiffness.normal,
                "kt": packings.STIFFNESS_RATIO * stiffness.normal, "mu": packings.FRICTION, "kwall": stiffness.wall,
                "skin": self.skin * test.packing.mean_radius(), "dt": test.time_step, "warm": test.warm_up,
                "steps": test.steps}

    def write_input(self, test, stiffness):
        packings.write_lammps_data(test.folder / f"{self.kind}_data", test.packing)
        shear = packings.STIFFNESS_RATIO * stiffness.normal
        sds = f"sds {packings.TWISTING * shear * stiffness.product} 0.0 1e3"
        twist = sds if self.twisting == "sds" else self.twisting
        return self.common(test, stiffness) | {
            "gamma": 0.0 if self.undamped else stiffness.damping, "rate": test.rate,
            "kroll": packings.ROLLING * shear * stiffness.reduced, "twisting": twist}


class Liggghts(Lammps):
    kind, program, package = "liggghts", "liggghts", "liggghts"
    deck = "liggghts_shear.in"
    law = ("Law: hooke/stiffness, tangential history, rolling epsd2 with torsion (rolling stiffness 0.83 of Isostat's, "
           "twist under the rolling limit); walls are meshes, a quarter of its time, that move uniformly, in "
           "Isostat exponentially (1e-7 of an edge apart after 1,500 steps). ")

    def write_input(self, test, stiffness):
        packings.write_lammps_data(test.folder / f"{self.kind}_data", widened(test.packing, 2), 2, "granular")
        mass = packings.DENSITY * 4 / 3 * math.pi * test.packing.mean_radius() ** 3
        return self.common(test, stiffness) | self.walls(test) | {
            "gamma": 0.0 if self.undamped else stiffness.damping / (mass / 2)}  # per effective mass, 1/s

    def walls(self, test):
        box = test.packing.box
        for wall, name in enumerate(WALLS):
            write_wall(test.folder / f"{name}.stl", wall, box[wall], widened(test.packing, 1).box)
        speeds = {f"v{axis}": share * test.rate * (box[2 * k + 1] - box[2 * k])
                  for k, (axis, share) in enumerate(zip("xyz", (0.25, -0.5, 0.25)))}
        return speeds | {"walls": HERE / "liggghts_walls_moving.in"}


class LiggghtsStatic(Liggghts):
    kind = "liggghts-static"
    at_rest = True
    law = Liggghts.law.partition("walls")[0] + "walls are planes at rest, rate 0 in both codes. "

    def walls(self, test):
        return dict(zip(WALLS, test.packing.box)) | {"walls": HERE / "liggghts_walls_static.in"}


def widened(packing, share):
    """The packing in a box that is wider on each side by 5 % of its longest edge, times share."""
    box = packing.box
    margin = 0.05 * share * max(box[2 * k + 1] - box[2 * k] for k in range(3))
    return packings.Packing([b + (margin if k % 2 else -margin) for k, b in enumerate(box)], packing.spheres)


def write_wall(path, wall, place, around):
    """Two triangles in the plane of a wall, as wide as the box `around`."""
    axis = wall // 2
    a, b = [k for k in range(3) if k != axis]
    corners = []
    for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)):
        corner = [place] * 3
        corner[a], corner[b] = around[2 * a + i], around[2 * b + j]
        corners.append("vertex {:.17g} {:.17g} {:.17g}".format(*corner))
    normal = " ".join("1" if k == axis else "0" for k in range(3))
    with open(path, "w") as out:
        out.write("solid wall\n")
        for triangle in ((0, 1, 2), (0, 2, 3)):
            out.write("\n".join([f"facet normal {normal}", "outer loop", *(corners[c] for c in triangle), "endloop",
                                 "endfacet", ""]))
        out.write("endsolid wall\n")

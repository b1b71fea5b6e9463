# SPDX-License-Identifier: BSD-3-Clause
"""A packing in YADE: bodies, engines and wall stress, shared by yade_shear.py and yade_hold.py.

A packing is text, lines x y z r (m) with the box in a comment `# box xlo xhi ylo yhi zlo zhi`; bodies are stored in the
order of the lines, contacts start without history. Or it is a state saved by YADE (.yade.bz2: six walls x- x+ y- y+
z- z+, then spheres); contacts then keep their history. The law is the one of Isostat: CohFrictMat without cohesion,
rolling limit, elastic twist, incremental form, frictionless walls, damping 0.2. YADE 2025.2 clips a twisting moment
"without limit" (etaTwist = -1) to 0: it is the same law without twisting only."""
import math

try:
    from minieigen import Vector3
except ImportError:
    from yade.minieigenHP import Vector3  # where YADE brings its own
from yade import *
from yade import utils


def load(path, twisting=True):
    if path.endswith(".yade.bz2"):
        O.load(path)
    else:
        add_bodies(*read_text(path), twisting)


def read_text(path):
    box, spheres = None, []
    for line in open(path):
        words = line.split()
        if words[:2] == ["#", "box"]:
            box = [float(w) for w in words[2:]]
        elif words and words[0] != "#":
            spheres.append([float(w) for w in words])
    return box, spheres


def add_bodies(box, spheres, twisting):
    shared = dict(young=1e10, poisson=0.3, density=2650.0, alphaKr=0.3, alphaKtw=0.3 * twisting,
                  etaRoll=0.5, etaTwist=-1,
                  isCohesive=False, normalCohesion=0, shearCohesion=0)
    O.materials.append(CohFrictMat(frictionAngle=math.radians(18), momentRotationLaw=True, label="grain", **shared))
    O.materials.append(CohFrictMat(frictionAngle=0, momentRotationLaw=False, label="wall", **shared))
    O.bodies.append(utils.aabbWalls([Vector3(box[0], box[2], box[4]), Vector3(box[1], box[3], box[5])], thickness=0,
                                    material="wall"))
    for x, y, z, r in spheres:
        O.bodies.append(utils.sphere(Vector3(x, y, z), r, material="grain"))


def set_engines(rate, dt):
    least = min(b.shape.radius for b in O.bodies if isinstance(b.shape, Sphere))
    triax = TriaxialStressController(thickness=0, internalCompaction=False, stressMask=0, strainDamping=0,
                                     computeStressStrainInterval=10**9, stiffnessUpdateInterval=10**9,
                                     radiusControlInterval=10**9, goal1=rate / 2, goal2=-rate, goal3=rate / 2,
                                     wall_left_id=0, wall_right_id=1, wall_bottom_id=2, wall_top_id=3, wall_back_id=4,
                                     wall_front_id=5)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()], verletDist=0.15 * least),
        InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D(), Ig2_Box_Sphere_ScGeom6D()],
                        [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
                        [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(always_use_moment_law=True,
                                                                   useIncrementalForm=True)]),
        triax,
        NewtonIntegrator(damping=0.2),
    ]
    O.dynDt = False
    O.dt = dt


def wall_stress():
    edge = [O.bodies[2 * k + 1].state.pos[k] - O.bodies[2 * k].state.pos[k] for k in range(3)]
    return [0.5 * (O.forces.f(2 * k + 1)[k] - O.forces.f(2 * k)[k]) / (edge[(k + 1) % 3] * edge[(k + 2) % 3])
            for k in range(3)]

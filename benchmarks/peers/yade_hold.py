# SPDX-License-Identifier: BSD-3-Clause
"""What rattlers do to a held packing in YADE: shears it at constant volume, stops the walls and waits.

    yade -n -x -j1 yade_hold.py PACKING STRAIN RATE TIME_STEP STEPS BRAKE TABLE

The packing and its law: yade_scene.py. BRAKE = 0 leaves grains without a contact alone; 1 sets their velocities to
zero every 20 steps. The file TABLE (CSV) has the mean stress, the kinetic energy of grains with and without a loaded
contact, and the unbalanced force against the steps since the walls stopped."""
import csv
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(next(a for a in sys.argv if a.endswith(".py"))).resolve().parent))
from yade_scene import (O, PyRunner, TriaxialStressController, Vector3, load, set_engines, utils,  # noqa: E402
                        wall_stress)


def in_contact(loaded):
    touched = set()
    for i in O.interactions:
        if i.isReal and (not loaded or i.phys.normalForce.norm() > 0):
            touched.update((i.id1, i.id2))
    return touched


def brake():
    touched = in_contact(False)
    for b in range(6, len(O.bodies)):
        if b not in touched:
            O.bodies[b].state.vel = O.bodies[b].state.angVel = Vector3(0, 0, 0)


def kinetic_energies():
    """Of grains with a loaded contact and of the others, J, and the number of the others."""
    touched, sums, n = in_contact(True), [0.0, 0.0], 0
    for b in range(6, len(O.bodies)):
        s = O.bodies[b].state
        energy = 0.5 * s.mass * s.vel.squaredNorm() + 0.5 * s.inertia[0] * s.angVel.squaredNorm()
        sums[b not in touched] += energy
        n += b not in touched
    return sums[0], sums[1], n


def row(step):
    s = wall_stress()
    return [step, sum(s) / 3e3, (s[1] - 0.5 * (s[0] + s[2])) / 1e3, *kinetic_energies(), utils.unbalancedForce()]


packing, strain, rate, dt, steps, braked, table = [a for a in sys.argv[1:] if not a.endswith(".py")][:7]
load(packing)
set_engines(float(rate), float(dt))
if int(braked):
    O.engines = O.engines[:-1] + [PyRunner(command="brake()", iterPeriod=20, initRun=False)] + O.engines[-1:]
O.run(math.ceil(float(strain) / float(rate) / float(dt)), True)
walls = [e for e in O.engines if isinstance(e, TriaxialStressController)][0]
walls.goal1 = walls.goal2 = walls.goal3 = 0
rows, done, following = [row(0)], 0, 100
while done < int(steps):
    following = min(following, int(steps))
    O.run(following - done, True)
    done, following = following, int(1.3 * following) + 1
    rows.append(row(done))
with open(table, "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(["steps held", "p' (kPa)", "q (kPa)", "kinetic energy of loaded grains (J)",
                  "kinetic energy of rattlers (J)", "rattlers", "unbalanced force ratio"])
    out.writerows([[f"{v:.6g}" if isinstance(v, float) else v for v in r] for r in rows])

# SPDX-License-Identifier: BSD-3-Clause
"""Constant-volume shear of a packing in YADE, timed.

    yade -n -x -j1 yade_shear.py PACKING RATE TIME_STEP WARM_UP STEPS TWISTING TIMES

The packing and its law: yade_scene.py; TWISTING is 1 or 0.
The block of STEPS after WARM_UP untimed steps gives steps per second, contacts,
p and q, written to the file TIMES as JSON."""
import json
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(next(a for a in sys.argv if a.endswith(".py"))).resolve().parent))
from yade_scene import O, load, set_engines, wall_stress  # noqa: E402

path, rate, dt, warm_up, steps, twisting, times = [a for a in sys.argv[1:] if not a.endswith(".py")][:7]
load(path, twisting=bool(int(twisting)))
set_engines(float(rate), float(dt))
O.run(int(warm_up), True)
begin, used = time.perf_counter(), time.process_time()
O.run(int(steps), True)
seconds, used = time.perf_counter() - begin, time.process_time() - used
contacts = sum(1 for i in O.interactions if i.isReal)
s = wall_stress()
with open(times, "w") as file:
    json.dump([{"steps_per_s": int(steps) / seconds, "contacts": contacts, "p_kPa": sum(s) / 3e3,
                "q_kPa": (s[1] - 0.5 * (s[0] + s[2])) / 1e3, "grains": len(O.bodies) - 6, "cores": used / seconds}],
                file)

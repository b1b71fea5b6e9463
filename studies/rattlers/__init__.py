# SPDX-License-Identifier: BSD-3-Clause
"""What the damping of rattlers, pushing walls and local damping change in cyclic tests; packings that are held."""
import numpy as np

from studies.drawing import BLUE, ORANGE, panels, save
from studies.ensembles import mean_and_error, mean_and_interval
from studies.history import History
from studies.scenes import cyclic
from studies.speed_error import plan
from studies.speed_error.plan import DOMAINS, DYNAMIC, TENTH, of
from studies.tables import write_tables

DEFAULTS, QUICK = {"seeds": 6}, {"seeds": 1}
UNDAMPED = {"free_grain_damping": 0}
SETTINGS = [DYNAMIC, of("local damping 0.2 in place of dashpots", contact_damping=0, damping=0.2),
            of("walls push the grains", carry_grains=False), of("rattlers undamped", **UNDAMPED),
            of("half the damping of rattlers", free_grain_damping=0.05),
            of("twice the damping of rattlers", free_grain_damping=0.2),
            of("rattlers undamped, rate / 10", 2.5e5, **TENTH, **UNDAMPED)]
HELD_STEPS = 100_000


class Run(plan.Run):
    """Further kinds: hold and hold-late, which end in a stage at rest, after five cycles and after liquefaction."""

    def scene(self):
        scene = super().scene()
        return scene | {"output": scene["output"] | {"record_steps": 500}} if self.kind.startswith("hold") else scene

    @property
    def stages(self):
        hold = {"kind": "hold", "balance": 1e-14, "max_steps": HELD_STEPS}
        return super().stages | {"hold": [cyclic(cycles=5), hold],
                                 "hold-late": [cyclic(cycles=100, reversals_after_liquefaction=3), hold]}

    share = plan.Run.share | {"hold": 4, "hold-late": 16}


def runs(options):
    every = [(seed, domain) for seed in range(1, options.seeds + 1) for domain in DOMAINS]
    return [*(Run("prepare", *one) for one in every),
            *(Run("cyclic", *one, setting) for one in every for setting in SETTINGS),
            *(Run(kind, *one) for one in every if one[0] <= 3 for kind in ("hold", "hold-late"))]


def cycles_table(tests):
    """Cycles to liquefaction, and less those of the default on the same specimens, ± half the 95 % interval."""
    rows = []
    for (domain, setting), found in tests.items():
        default = tests[domain, DYNAMIC]
        less = [cycles - default[seed][0] for seed, (cycles, _) in found.items() if seed in default]
        cycles, steps = zip(*found.values())
        rows.append([domain, setting.label, len(found), *mean_and_error(cycles), *mean_and_interval(less),
                     float(np.mean(steps))])
    return ["specimens", "setting", "seeds", "cycles to liquefaction", "standard error", "less those of the default",
            "half 95 % interval", "time steps"], rows


def hold_table(held):
    """p' lost by packings whose walls stand still: kind, domain, seed, (steps since loading stopped, p' (kPa))."""
    return ["held", "specimen", "seed", "p' as loading stops (kPa)", "lost in 1e4 steps (kPa)", "lost in all (kPa)"], [
        ["after liquefaction" if kind == "hold-late" else "after 5 cycles", domain, seed, float(p[0]),
         float(p[0] - np.interp(1e4, steps, p)), float(p[0] - p[-1])] for kind, domain, seed, (steps, p) in held]


def resting(history):
    """Steps since loading stopped, and p' (kPa)."""
    rows = history.stage == history.stage[-1]
    return history.step[rows] - history.step[rows][0], history.p[rows] / 1e3


def draw(tests, path):
    """Mean differences of cycles from the default, in boxes and cells."""
    figure, ((axes,),) = panels(1, 1, 6.4, 2.9)
    axes.set_title("")
    for k, (domain, colour) in enumerate(zip(DOMAINS, (BLUE, ORANGE))):
        for y, setting in enumerate(SETTINGS[1:]):
            found, default = tests.get((domain, setting), {}), tests.get((domain, DYNAMIC), {})
            less = [cycles - default[seed][0] for seed, (cycles, _) in found.items() if seed in default]
            if less:
                axes.plot(less, np.full(len(less), y + 0.25 * k), ".", color=colour, alpha=0.5, markersize=4)
                mean, half = mean_and_interval(less)
                axes.errorbar(mean, y + 0.1 + 0.25 * k, xerr=np.nan_to_num(half), fmt="D", color=colour, capsize=2,
                              markersize=4, label=domain if not y else None)
    axes.set_yticks([y + 0.17 for y in range(len(SETTINGS) - 1)], [setting.label for setting in SETTINGS[1:]])
    axes.invert_yaxis()
    axes.axvline(0, color="#777777", linewidth=0.8)
    axes.set_xlabel("Cycles to liquefaction less those of the default")
    axes.legend(loc="lower left")
    save(figure, path)


def report(store, planned, folder):
    tests, held = {}, []
    for run in planned:
        if run.kind == "prepare" or not store.is_done(run):
            continue
        h = History(store.folder(run))
        if run.kind == "cyclic" and h.onset is not None:
            found = tests.setdefault((run.domain, run.setting), {})
            found[run.seed] = h.reversals[h.onset] / 2, h.step[h.onset] - h.step[0]
        elif run.kind != "cyclic":
            held.append((run.kind, run.domain, run.seed, resting(h)))
    if tests:
        write_tables(folder, {"cycles": cycles_table(tests), "hold": hold_table(held)})
        draw(tests, folder / "cycles.png")

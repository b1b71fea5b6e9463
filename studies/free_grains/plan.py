# SPDX-License-Identifier: BSD-3-Clause
"""What is run: settings of [motion], and the scenes of the tests."""
from studies.scenes import cyclic
from studies.speed_error import plan as speed_plan
from studies.speed_error.plan import DENSER, DOMAINS, GRAINS, HUNDREDTH, MANY, TENTH, of  # noqa: F401  (for the tables)

HELD_STEPS = 100_000
DEFAULT = speed_plan.DYNAMIC
SLOW = of("rate / 10", 2.5e5, **TENTH)
SLOWEST = of("rate / 100", 2.5e6, **HUNDREDTH)
# of first cycles only: four decades of the rate, and what the damping of rattlers does at a slow one
EARLY = [DEFAULT, SLOW, SLOWEST, of("rate / 1000", 2.5e7, inertial_number=7e-7, load_per_wave=1e-4),
         *[of(f"c = {c:g}, rate / 100", 2.5e6, **HUNDREDTH, free_grain_damping=c) for c in (0.01, 1)]]
# monotonic tests have a default of their own, I = 4e-5
ONE_WAY = [DEFAULT, of("I of cyclic tests", inertial_number=7e-4), of("I / 10", 2.5e6, inertial_number=4e-6)]
LOCAL, ALONE, PUSHING = {"contact_damping": 0, "damping": 0.2}, {"free_grain_damping": 0}, {"carry_grains": False}


def at_two_rates(label, **motion):
    return [of(label, **motion), of(f"{label}, rate / 10", 2.5e5, **TENTH, **motion)]


LOCAL_SETTINGS = at_two_rates("local damping alone", **LOCAL)
ALONE_SETTINGS = at_two_rates("rattlers left alone", **ALONE)
PUSHED = at_two_rates("walls push", **PUSHING)
OLD_SETTINGS = at_two_rates("all three", **LOCAL, **ALONE, **PUSHING)
NUMERICS = [of("rate x 2", inertial_number=1.4e-3, load_per_wave=0.2),
            of("I alone", load_per_wave=0), of("time step / 2", 5e4, time_step_safety=0.4),
            of("c / 2", free_grain_damping=0.05), of("c x 2", free_grain_damping=0.2),
            of("beta / 2", contact_damping=0.025), of("beta x 2", contact_damping=0.1)]
LARGE = [*at_two_rates("local damping 0.02", damping=0.02), of("load_per_wave 0.02", 7e4, load_per_wave=0.02),
         of("load_per_wave 0.02, local damping 0.02", 7e4, load_per_wave=0.02, damping=0.02)]
DAMPING = {value: at_two_rates(f"local damping {value:g}", damping=value) for value in (0, 0.05, 0.2, 0.4)}


class Run(speed_plan.Run):
    """Further kinds: early, one cycle from rest; liquefied; hold and hold-late, which end in a stage at rest."""

    def scene(self):
        scene = super().scene()
        return scene | {"output": scene["output"] | {"record_steps": 500}} if self.kind.startswith("hold") else scene

    @property
    def stages(self):
        hold = {"kind": "hold", "balance": 1e-14, "max_steps": HELD_STEPS}
        return super().stages | {
            "early": [hold | {"balance": 1e-9}, cyclic(cycles=1)],
            "liquefied": [cyclic(cycles=100, reversals_after_liquefaction=6)],
            "hold": [cyclic(cycles=5), hold],
            "hold-late": [cyclic(cycles=100, reversals_after_liquefaction=3), hold]}

    share = speed_plan.Run.share | {"early": 0.02, "liquefied": 18, "hold": 4, "hold-late": 16}


def runs(n_seeds):
    """Specimens first, then what the limit needs, so that a campaign cut short has it."""
    seeds, half, eight, few, three = (range(1, min(n_seeds, n) + 1) for n in (n_seeds, 10, 8, 6, 3))
    box = DOMAINS[:1]
    result = [Run("prepare", s, domain) for domain in DOMAINS for s in seeds]
    result += [Run("prepare", s, "rigid-box", grains=MANY) for s in three]

    def tests(settings, some=seeds, domains=DOMAINS, **more):
        result.extend(Run("cyclic", s, domain, setting, **more)
                      for s in some for domain in domains for setting in settings)

    tests([DEFAULT, SLOW])
    tests(NUMERICS, half)
    tests([DEFAULT, SLOW, *LARGE], three, box, grains=MANY)
    result += [Run("monotonic", s, "rigid-box", setting) for s in few for setting in ONE_WAY]
    result += [Run("liquefied", s, "rigid-box") for s in three]
    result += [Run("prepare", s, domain, degrees=DENSER) for domain in DOMAINS for s in few]
    tests([DEFAULT, SLOW], few, degrees=DENSER)
    result += [Run(kind, s, domain, setting) for kind in ("hold", "hold-late") for s in three for domain in DOMAINS
               for setting in (DEFAULT, ALONE_SETTINGS[0])]
    tests([fast for fast, _ in DAMPING.values()], half)
    tests(LOCAL_SETTINGS + OLD_SETTINGS + ALONE_SETTINGS, few)
    tests(PUSHED, few, box)
    result += [Run("liquefied", s, "rigid-box", SLOW) for s in three]
    tests([SLOWEST])
    tests([slow for _, slow in DAMPING.values()], few)
    result += [Run("early", s, domain, setting) for s in eight for domain in DOMAINS for setting in EARLY]
    return result

# SPDX-License-Identifier: BSD-3-Clause
"""What is run: settings of [motion], and the scenes of the tests."""
import dataclasses

from speed_error import plan as speed_plan

GRAINS, MANY = 2000, 10_000
DOMAINS = ("rigid-box", "periodic-cell")
LOOSE, DENSER = 10, 8  # preparation friction, degrees
HELD_STEPS = 100_000


@dataclasses.dataclass(frozen=True)
class Setting:
    """One way to run the tests. `motion` holds the keys that differ from the default of [motion]."""

    label: str
    motion: tuple = ()
    steps: float = 2.5e4  # to the onset, for the estimate of time

    @property
    def name(self):
        return "_".join(f"{key}={value}" for key, value in self.motion).replace('"', "") or "default"


def of(label, steps=2.5e4, **motion):
    return Setting(label, tuple(motion.items()), steps)


DEFAULT = of("default")
# both bounds on the rate divided by 10 and by 100
TENTH, HUNDREDTH = {"inertial_number": 7e-5, "load_per_wave": 0.01}, {"inertial_number": 7e-6, "load_per_wave": 1e-3}
SLOW = of("rate / 10", 2.5e5, **TENTH)
SLOWEST = of("rate / 100", 2.5e6, **HUNDREDTH)
# of first cycles only: four decades of the rate, and what the brake on free grains does at a slow one
EARLY = [DEFAULT, SLOW, SLOWEST, of("rate / 1000", 2.5e7, inertial_number=7e-7, load_per_wave=1e-4),
         *[of(f"c = {c:g}, rate / 100", 2.5e6, **HUNDREDTH, free_grain_damping=c) for c in (0.01, 1)]]
# monotonic tests have a default of their own, I = 4e-5
ONE_WAY = [DEFAULT, of("I of cyclic tests", inertial_number=7e-4), of("I / 10", 2.5e6, inertial_number=4e-6)]
LOCAL, ALONE, PUSHING = {"contact_damping": 0, "damping": 0.2}, {"free_grain_damping": 0}, {"carry_grains": "false"}


def at_two_rates(label, **motion):
    return [of(label, **motion), of(f"{label}, rate / 10", 2.5e5, **TENTH, **motion)]


LOCAL_SETTINGS = at_two_rates("local damping alone", **LOCAL)
ALONE_SETTINGS = at_two_rates("free grains left alone", **ALONE)
PUSHED = at_two_rates("walls push", **PUSHING)
OLD_SETTINGS = at_two_rates("all three", **LOCAL, **ALONE, **PUSHING)
NUMERICS = [of("rate x 2", inertial_number=1.4e-3, load_per_wave=0.2),
            of("I alone", load_per_wave=0), of("time step / 2", 5e4, time_step_safety=0.4),
            of("c / 2", free_grain_damping=0.05), of("c x 2", free_grain_damping=0.2),
            of("beta / 2", contact_damping=0.025), of("beta x 2", contact_damping=0.1)]
LARGE = [*at_two_rates("local damping 0.02", damping=0.02), of("load_per_wave 0.02", 7e4, load_per_wave=0.02),
         of("load_per_wave 0.02, local damping 0.02", 7e4, load_per_wave=0.02, damping=0.02)]
DAMPING = {value: at_two_rates(f"local damping {value:g}", damping=value) for value in (0, 0.05, 0.2, 0.4)}


@dataclasses.dataclass(frozen=True)
class Run:
    """One run, as runner.Campaign takes it."""

    kind: str  # prepare, cyclic, early, monotonic, liquefied, hold, hold-late
    seed: int
    domain: str
    setting: Setting = DEFAULT
    grains: int = GRAINS
    degrees: float = LOOSE

    @property
    def packing(self):
        """Domain, and the preparation friction where it is not the usual one."""
        return self.domain + (f" at {self.degrees:g} deg" if self.degrees != LOOSE else "")

    @property
    def name(self):
        what = "specimen" if self.kind == "prepare" else f"{self.kind}_{self.setting.name}"
        return f"{what}_{self.packing.replace(' ', '_')}_n{self.grains}_s{self.seed}"

    @property
    def specimen(self):
        return self.packing, self.grains, self.seed

    def scene(self):
        text = speed_plan.SCENE.format(title=self.name, grains=self.grains, seed=self.seed,
                                       edge=10 * (self.grains / 10000) ** (1 / 3), stage=self.stages(),
                                       record_strain="1e-4",
                                       motion="\n".join(f"{key} = {value}" for key, value in self.setting.motion))
        text = text.replace("rigid-box", self.domain).replace('"10 deg"', f'"{self.degrees:g} deg"')
        return text + "record_steps = 500\n" if self.kind.startswith("hold") else text

    def stages(self):
        cyclic = '[[stage]]\nkind = "undrained-cyclic"\ndeviator_amplitude = "60 kPa"\nuntil = {{ {} }}\n'
        hold = f'[[stage]]\nkind = "hold"\nbalance = 1e-14\nmax_steps = {HELD_STEPS}\n'
        rest = hold.replace("1e-14", "1e-9")
        return {"prepare": "",
                "cyclic": cyclic.format("cycles = 100, reversals_after_liquefaction = 0"),
                "early": rest + cyclic.format("cycles = 1"),
                "liquefied": cyclic.format("cycles = 100, reversals_after_liquefaction = 6"),
                "monotonic": '[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.005\n',
                "hold": cyclic.format("cycles = 5") + hold,
                "hold-late": cyclic.format("cycles = 100, reversals_after_liquefaction = 3") + hold}[self.kind]

    def estimated_seconds(self):
        of_kind = {"prepare": 6e4, "cyclic": self.setting.steps, "monotonic": 0.4 * max(self.setting.steps, 2.5e5),
                   "early": 0.02 * self.setting.steps,
                   "liquefied": 18 * self.setting.steps, "hold": HELD_STEPS, "hold-late": 4e5}
        return 1.1e-4 * of_kind[self.kind] * self.grains / GRAINS


def runs(n_seeds):
    """Specimens first, then what the limit needs, so that a campaign cut short has it."""
    seeds, half, eight, few, three = (range(1, min(n_seeds, n) + 1) for n in (n_seeds, 10, 8, 6, 3))
    box = DOMAINS[:1]
    result = [Run("prepare", s, domain) for domain in DOMAINS for s in seeds]
    result += [Run("prepare", s, "rigid-box", grains=MANY) for s in three]

    def cyclic(settings, some=seeds, domains=DOMAINS, **more):
        result.extend(Run("cyclic", s, domain, setting, **more)
                      for s in some for domain in domains for setting in settings)

    cyclic([DEFAULT, SLOW])
    cyclic(NUMERICS, half)
    cyclic([DEFAULT, SLOW, *LARGE], three, box, grains=MANY)
    result += [Run("monotonic", s, "rigid-box", setting) for s in few for setting in ONE_WAY]
    result += [Run("liquefied", s, "rigid-box") for s in three]
    result += [Run("prepare", s, domain, degrees=DENSER) for domain in DOMAINS for s in few]
    cyclic([DEFAULT, SLOW], few, degrees=DENSER)
    result += [Run(kind, s, domain, setting) for kind in ("hold", "hold-late") for s in three for domain in DOMAINS
               for setting in (DEFAULT, ALONE_SETTINGS[0])]
    cyclic([fast for fast, _ in DAMPING.values()], half)
    cyclic(LOCAL_SETTINGS + OLD_SETTINGS + ALONE_SETTINGS, few)
    cyclic(PUSHED, few, box)
    result += [Run("liquefied", s, "rigid-box", SLOW) for s in three]
    cyclic([SLOWEST])
    cyclic([slow for _, slow in DAMPING.values()], few)
    result += [Run("early", s, domain, setting) for s in eight for domain in DOMAINS for setting in EARLY]
    return result

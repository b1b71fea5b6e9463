# SPDX-License-Identifier: BSD-3-Clause
"""What is run: settings of [motion], and the scenes of the tests."""
import dataclasses

from speed_error import plan as speed_plan

GRAINS = 2000
DOMAINS = ("rigid-box", "periodic-cell")
LOOSE, DENSE = "10 deg", "9 deg"  # friction during compression
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
SLOW = of("I / 10", 2e5, inertial_number=4e-5)
SLOWEST = of("I / 100", 2e6, inertial_number=4e-6)
ALONE = {"free_grain_damping": 0}
OLD = {"free_grain_damping": 0, "carry_grains": "false"}
ALONE_SETTINGS = [of("free grains left alone", **ALONE),
                  of("free grains left alone, I / 10", 2e5, inertial_number=4e-5, **ALONE),
                  of("free grains left alone, I / 40", 6e5, inertial_number=1e-5, **ALONE)]
PUSHED = [of("walls push", carry_grains="false"),
          of("walls push, I / 10", 2e5, inertial_number=4e-5, carry_grains="false")]
OLD_SETTINGS = [of("left alone, walls push", **OLD),
                of("left alone, walls push, I / 10", 2e5, inertial_number=4e-5, **OLD),
                of("left alone, walls push, I / 40", 6e5, inertial_number=1e-5, **OLD)]
NUMERICS = [of("I x 2.5", inertial_number=1e-3), of("time step / 2", 5e4, time_step_safety=0.4),
            of("time step / 4", 1e5, time_step_safety=0.2),
            of("c / 2", free_grain_damping=0.05), of("c x 2", free_grain_damping=0.2)]
DAMPING = [of("damping / 2", damping=0.1), of("damping x 2", damping=0.4), of("damping 0.01", damping=0.01),
           of("damping 0.7", damping=0.7), of("damping 0.01, I / 10", 2e5, damping=0.01, inertial_number=4e-5),
           of("damping 0.7, I / 10", 2e5, damping=0.7, inertial_number=4e-5)]


@dataclasses.dataclass(frozen=True)
class Run:
    """One run, as runner.Campaign takes it."""

    kind: str  # prepare, cyclic, monotonic, liquefied, hold, hold-late
    seed: int
    domain: str
    setting: Setting = DEFAULT
    friction: str = LOOSE

    @property
    def name(self):
        what = "specimen" if self.kind == "prepare" else f"{self.kind}_{self.setting.name}"
        return f"{what}_{self.domain}_{self.friction[:-4]}deg_s{self.seed}"

    @property
    def specimen(self):
        return self.domain, self.friction, self.seed

    def scene(self):
        text = speed_plan.SCENE.format(title=self.name, grains=GRAINS, seed=self.seed,
                                       edge=10 * (GRAINS / 10000) ** (1 / 3), stage=self.stages(), record_strain="1e-4",
                                       motion="\n".join(f"{key} = {value}" for key, value in self.setting.motion))
        text = text.replace("rigid-box", self.domain).replace('"10 deg"', f'"{self.friction}"')
        return text + "record_steps = 500\n" if self.kind.startswith("hold") else text

    def stages(self):
        cyclic = '[[stage]]\nkind = "undrained-cyclic"\ndeviator_amplitude = "60 kPa"\nuntil = {{ {} }}\n'
        hold = f'[[stage]]\nkind = "hold"\nbalance = 1e-14\nmax_steps = {HELD_STEPS}\n'
        return {"prepare": "",
                "cyclic": cyclic.format("cycles = 100, reversals_after_liquefaction = 0"),
                "liquefied": cyclic.format("cycles = 100, reversals_after_liquefaction = 6"),
                "monotonic": '[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.005\n',
                "hold": cyclic.format("cycles = 5") + hold,
                "hold-late": cyclic.format("cycles = 100, reversals_after_liquefaction = 3") + hold}[self.kind]

    def estimated_seconds(self):
        of_kind = {"prepare": 6e4, "cyclic": self.setting.steps, "monotonic": 0.5 * self.setting.steps,
                   "liquefied": 18 * self.setting.steps, "hold": HELD_STEPS, "hold-late": 4e5}
        return 4.5e-5 * of_kind[self.kind]


def runs(n_seeds):
    """Specimens first, then what the limit needs, so that a campaign cut short has it."""
    seeds, few = range(1, n_seeds + 1), range(1, min(n_seeds, 6) + 1)
    result = [Run("prepare", s, domain) for domain in DOMAINS for s in seeds]

    def cyclic(settings, some=seeds, domains=DOMAINS, **more):
        result.extend(Run("cyclic", s, domain, setting, **more)
                      for s in some for domain in domains for setting in settings)

    cyclic([DEFAULT, SLOW])
    cyclic(NUMERICS)
    cyclic([SLOWEST], few)
    result += [Run("liquefied", s, "rigid-box", setting) for s in few[:4] for setting in (DEFAULT, SLOW)]
    cyclic([setting for setting in DAMPING if "I / 10" not in setting.label])
    cyclic(ALONE_SETTINGS[:2] + OLD_SETTINGS[:2])
    cyclic(PUSHED, domains=DOMAINS[:1])
    result += [Run(kind, s, domain, setting) for kind in ("hold", "hold-late") for s in few[:3] for domain in DOMAINS
               for setting in (DEFAULT, ALONE_SETTINGS[0])]
    result += [Run("monotonic", s, "rigid-box", setting) for s in few for setting in (DEFAULT, SLOW, SLOWEST)]
    cyclic([setting for setting in DAMPING if "I / 10" in setting.label], few)
    result += [Run("prepare", s, domain, friction=DENSE) for domain in DOMAINS for s in seeds]
    cyclic([DEFAULT, SLOW, OLD_SETTINGS[0]], friction=DENSE)
    cyclic([ALONE_SETTINGS[2], OLD_SETTINGS[2]], few[:3])
    return result

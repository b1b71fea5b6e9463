# SPDX-License-Identifier: BSD-3-Clause
"""What is run: the scene of a test, and the ways to run it whose errors are compared."""
import dataclasses

import numpy as np

from isostat.scene import value_text
from studies.scenes import cyclic, scene_of

GRAINS, MANY = 2000, 10_000
DOMAINS = ("rigid-box", "periodic-cell")
LOOSE, DENSER = 10, 8  # preparation friction, degrees


@dataclasses.dataclass(frozen=True)
class Setting:
    """One way to run the tests. `motion` holds the keys that differ from the default of [motion]."""

    label: str
    motion: tuple = ()
    steps: float = 2.5e4  # to the onset, for the estimate of time

    @property
    def name(self):
        return "_".join(f"{key}={value_text(value, key)}" for key, value in self.motion).replace('"', "") or "default"


def of(label, steps=2.5e4, **motion):
    return Setting(label, tuple(motion.items()), steps)


@dataclasses.dataclass(frozen=True)
class Run:
    """One run, as isostat study takes it."""

    kind: str  # prepare; cyclic, to the onset; network, the same with snapshots; path, five cycles; monotonic
    seed: int
    domain: str
    setting: Setting = of("dynamic")
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

    @property
    def stages(self):
        to_the_onset = [cyclic(cycles=100, reversals_after_liquefaction=0)]
        return {"prepare": [], "cyclic": to_the_onset, "network": to_the_onset, "path": [cyclic(cycles=5)],
                "monotonic": [{"kind": "undrained-monotonic", "strain": 0.005}]}

    # time steps, or evaluations of forces, over those to the onset of a cyclic test
    share = {"prepare": 2.4, "cyclic": 1, "network": 1, "path": 0.15, "monotonic": 1.3}

    def scene(self):
        specimen = {"domain": self.domain, "pressure": "200 kPa", "preparation_friction": f"{self.degrees:g} deg"}
        return scene_of(self.name, self.grains, self.seed, specimen, self.stages[self.kind],
                        motion=dict(self.setting.motion), record_stress="1 kPa", record_strain=1e-4,
                        snapshots="reversals" if self.kind == "network" else "none")

    def estimated_seconds(self):
        denser = 3 if self.degrees < LOOSE and self.kind == "cyclic" else 1
        return 1.1e-4 * denser * self.share[self.kind] * self.setting.steps * self.grains / GRAINS


def static(increment, balance, steps):
    short = [np.format_float_scientific(value, trim="-", exp_digits=1) for value in (increment, balance)]
    return of(f"static, {short[0]}, balance {short[1]}", steps, drive="static", increment=increment, balance=balance)


DYNAMIC = Run.setting
TENTH, HUNDREDTH = {"inertial_number": 7e-5, "load_per_wave": 0.01}, {"inertial_number": 7e-6, "load_per_wave": 1e-3}
SLOW = of("dynamic, rate / 10", 2.5e5, **TENTH)
LOCAL = of("dynamic, rate / 10, local damping", 2.5e5, **TENTH, contact_damping=0, damping=0.2)
SLOWEST = of("dynamic, rate / 100", 2.5e6, **HUNDREDTH)

STATIC, TIGHT = static(5e-5, 0.01, 2e5), static(2.5e-5, 1e-3, 6e5)
FINEST = static(1.25e-5, 1e-3, 6e5)  # of the path alone
INCREMENTS = [static(1e-4, 0.01, 2e5), static(2.5e-5, 0.01, 3e5)]
TOLERANCES = [static(5e-5, 1e-3, 3e5), static(5e-5, 1e-4, 6e5)]
BY_MARGIN = [DYNAMIC, SLOW, STATIC]  # whose yielding contacts are counted with several margins
# of monotonic tests, which have a default of their own, I = 4e-5
ONE_WAY = [of("dynamic", 8e4), STATIC, INCREMENTS[0], TIGHT, of("dynamic, rate / 10", 2.5e6, inertial_number=4e-6)]

# runs in which an increment stays out of balance for 200,000 evaluations, as the page says
NO_BALANCE = [Run("monotonic", 4, "rigid-box", TIGHT), Run("path", 2, "rigid-box", TIGHT, MANY),
              Run("path", 2, "rigid-box", FINEST, MANY)]


def to_the_onset(seed, degrees):
    """Settings that are run so far; the others end with the path."""
    if degrees < LOOSE:
        return [DYNAMIC, SLOW, STATIC] if seed == 1 else []
    return [DYNAMIC, SLOW, STATIC, *((*INCREMENTS, TIGHT, LOCAL) if seed <= 4 else ())]


def to_reversal_10(seed, degrees):
    return [*(TOLERANCES if seed <= 4 else TOLERANCES[:1]),
            *(s for s in (DYNAMIC, SLOW, STATIC, *INCREMENTS, TIGHT, FINEST) if s not in to_the_onset(seed, degrees))]


def runs(n_seeds):
    """Seed by seed, so that a campaign cut short has every setting; what takes longest comes last."""
    result = []
    for seed in range(1, n_seeds + 1):
        for degrees in (LOOSE, DENSER)[:2 if seed <= 4 else 1]:
            for domain in DOMAINS:
                result += [Run(kind, seed, domain, setting, degrees=degrees) for kind, settings in
                           (("prepare", [DYNAMIC]), ("path", to_reversal_10(seed, degrees)),
                            ("cyclic", to_the_onset(seed, degrees))) for setting in settings]
        if seed <= 4:
            result += [Run("monotonic", seed, "rigid-box", setting) for setting in ONE_WAY[:-1]]
            result += [Run("network", seed, domain, setting) for domain in DOMAINS for setting in BY_MARGIN]
    result += [Run(kind, seed, "rigid-box", setting, MANY) for seed in (1, 2, 3) for kind, setting in
               (("prepare", DYNAMIC), ("path", FINEST), ("path", TIGHT), ("path", INCREMENTS[1]), ("cyclic", DYNAMIC),
                ("cyclic", SLOW), ("cyclic", STATIC))]
    result += [Run("monotonic", seed, "rigid-box", ONE_WAY[-1]) for seed in (1, 2)]
    result += [Run("cyclic", 1, domain, SLOWEST) for domain in DOMAINS]
    return [run for run in result if run not in NO_BALANCE]

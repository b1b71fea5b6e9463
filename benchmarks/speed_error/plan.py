# SPDX-License-Identifier: BSD-3-Clause
"""What is run: settings, one factor at a time around the default, and the scene of each run."""
import dataclasses
import re

BASE_GRAINS = 2000
QAMP = 60e3  # Pa

CONTACT = """[contact]
young = "10 GPa"
stiffness_ratio = 0.3
friction = "18 deg"
rolling = {{ stiffness = 0.3, limit = 0.5 }}
twisting = {{ stiffness = 0.3 }}
"""  # of format(), as the scenes are
GRADING = """\
title = "{title}"

[grading]
curve = "karlsruhe-fine-sand"
grains = {grains}
cloud_edge = "{edge:.15g} mm"     # grains of one size for every number of them
seed = {seed}

"""
SCENE = GRADING + CONTACT + """
[specimen]
domain = "rigid-box"
pressure = "200 kPa"
preparation_friction = "10 deg"

[motion]
{motion}

{stage}
[output]
snapshots = "none"
paraview = false
record_stress = "1 kPa"
record_strain = {record_strain}
"""


@dataclasses.dataclass(frozen=True)
class Setting:
    """One way to run the tests. `motion` holds the keys that differ from the default of [motion]."""

    family: str  # default, inertia, step, damping, old, grains, reference
    label: str  # in figures
    motion: tuple = ()
    grains: int = BASE_GRAINS
    reversals_after: int = 2  # the cyclic test ends so many reversals after the onset; 0: slow, for the onset only
    monotonic: bool = True
    most: int = 1000  # realisations at most

    @property
    def name(self):
        return "_".join(f"{key}={value}" for key, value in self.motion) or "default"

    @property
    def slowness(self):
        """Time steps over those of the default of cyclic tests, on the same path."""
        keys = dict(self.motion)
        return 7e-4 / float(keys.get("inertial_number", 7e-4)) * 0.8 / float(keys.get("time_step_safety", 0.8))


@dataclasses.dataclass(frozen=True)
class Limits:
    """Where tests end, and what the early path is."""

    strain: float = 0.005  # monotonic; beyond some 0.2 % single avalanches part the paths of one specimen
    early_strain: float = 0.001
    longer_strain: float = 0.002  # slow settings end here
    cycles: int = 60  # cyclic, if it does not liquefy
    cyclic_strain: float = 0.03  # ends the liquefied part, if it comes first
    early_reversals: int = 3
    longer_reversals: int = 10  # the second window; the reference runs end here
    max_steps: int = 3_000_000  # of any run


@dataclasses.dataclass(frozen=True)
class Run:
    kind: str  # prepare, cyclic, monotonic
    setting: Setting
    seed: int
    limits: Limits

    @property
    def name(self):
        name = "specimen" if self.kind == "prepare" else f"{self.kind}_{self.setting.name}"
        return f"{name}_n{self.setting.grains}_s{self.seed}"

    @property
    def specimen(self):
        return self.setting.grains, self.seed

    def scene(self):
        motion = "\n".join(f"{key} = {value}" for key, value in self.setting.motion) or "# all as by default"
        return SCENE.format(title=self.name, grains=self.setting.grains, seed=self.seed, motion=motion,
                            edge=10 * (self.setting.grains / 10000) ** (1 / 3), stage=self.stage(),
                            record_strain="1e-5" if self.kind == "monotonic" else "1e-4")

    @property
    def strain(self):
        return self.limits.strain if self.setting.reversals_after else self.limits.longer_strain

    def stage(self):
        limits, after, cycles = self.limits, self.setting.reversals_after, self.limits.cycles
        if self.kind == "monotonic":
            return (f'[[stage]]\nkind = "undrained-monotonic"\nstrain = {self.strain}\n'
                    f"liquefaction_ratio = 1e-6\nmax_steps = {limits.max_steps}\n")
        if self.kind == "cyclic":
            if self.setting.family == "reference":  # for the path only
                cycles = limits.longer_reversals // 2
            return (f'[[stage]]\nkind = "undrained-cyclic"\ndeviator_amplitude = "{QAMP / 1e3:g} kPa"\n'
                    f"until = {{ cycles = {cycles}, reversals_after_liquefaction = {after}, "
                    f"strain = {limits.cyclic_strain:g} }}\n"
                    f"max_steps = {limits.max_steps}\n")
        return ""

    def estimated_seconds(self):
        """CPU time from steps counted on one specimen; the runner scales it by what its own runs took."""
        n = self.setting.grains
        if self.kind == "prepare":
            return 3 * (n / 2000) ** 1.35
        onset, liquefied = (3e3, 0) if self.setting.family == "reference" else (3e4, 4e4 * self.setting.reversals_after)
        steps = onset + liquefied if self.kind == "cyclic" else 1e4 * self.strain / 0.005
        return 0.5 + 2.5e-8 * n * (1 + n / 15000) * min(self.setting.slowness * steps, self.limits.max_steps)


def of(family, label, motion=(), **more):
    return Setting(family, label, tuple(dict(motion).items()), **more)


def inertia(number, **more):
    return of("inertia", f"I = {number}", {"inertial_number": number}, **more)


def safety(value, **more):
    return of("step", f"step {value}", {"time_step_safety": value}, **more)


def damping(value, **more):
    return of("damping", f"damping {value}", {"damping": value}, **more)


def default(grains=BASE_GRAINS, **more):
    family = "default" if grains == BASE_GRAINS else "grains"
    return of(family, "default" if grains == BASE_GRAINS else f"N = {grains:,}", grains=grains, **more)


def reference(grains=BASE_GRAINS, number="1e-5", **more):
    """The slowest rate at half the time step: what early paths are measured against.

    A quarter of the step would take twice as long, I = 4e-6 two and a half times.
    """
    return of("reference", "reference", {"inertial_number": number, "time_step_safety": 0.4}, grains=grains,
              reversals_after=0, **more)


ALONE, PUSHED = {"free_grain_damping": 0}, {"carry_grains": "false"}  # off, as in versions before


def full_settings():
    """Slow settings end with the onset: the liquefied part takes more than twice the time up to it."""
    return [
        default(),
        reference(),
        inertia("1e-5", reversals_after=0),  # the slow limit of cycles
        inertia("4e-5", reversals_after=0),
        inertia("1e-4", reversals_after=0),
        inertia("2e-4", reversals_after=0),
        *map(inertia, ("1e-3", "2e-3")),
        safety(0.4),
        safety(0.2, reversals_after=0, most=4),
        *map(damping, (0.01, 0.1, 0.4, 0.7)),
        of("old", "free grains left alone", ALONE),
        of("old", "walls push", PUSHED),
        of("old", "left alone, walls push", {**ALONE, **PUSHED}),
        default(500),
        reference(500, monotonic=False),
        default(1000),
        reference(1000, monotonic=False),
        default(5000, most=2),
        reference(5000, most=1, monotonic=False),
        default(10000, most=2),
    ]


def quick_settings():
    some = [default(), reference(number="1e-4"), inertia("1e-4", reversals_after=0), inertia("1e-3"), safety(0.4)]
    return [default(500), reference(500, "1e-4"), *(dataclasses.replace(s, grains=1000) for s in some)]


def runs(settings, seeds, limits, only=""):
    """All runs: seed by seed, so that a campaign cut short has every setting; the largest specimens last."""
    result = []
    for place, seed in enumerate(seeds):
        some = [s for s in settings if place < s.most]
        specimens = {s.grains: s for s in some}
        block = [Run("prepare", s, seed, limits) for s in specimens.values()]
        for setting in some:
            block += [Run(kind, setting, seed, limits) for kind in ("cyclic", "monotonic")[:1 + setting.monotonic]]
        block = [run for run in block if run.kind == "prepare" or re.search(only, run.name)]
        needed = {run.specimen for run in block if run.kind != "prepare"}
        block = [run for run in block if run.specimen in needed]
        result += sorted(block, key=lambda run: (run.kind != "prepare", -run.estimated_seconds()))
    return sorted(result, key=lambda run: run.setting.grains > BASE_GRAINS)

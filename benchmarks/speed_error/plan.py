# SPDX-License-Identifier: BSD-3-Clause
"""What is run: settings, one factor at a time around the default, and the scene of each run."""
import dataclasses
import re

BASE_GRAINS, LARGEST = 2000, 10000
QAMP = 60e3  # Pa

CONTACT = """[contact]
young = "10 GPa"
stiffness_ratio = 0.3
friction = "18 deg"
rolling = {{ stiffness = 0.3, limit = 0.5 }}
twisting = {{ stiffness = 0.3 }}
"""  # of format(), as the scenes are
SCENE = """\
title = "{title}"

[grading]
curve = "karlsruhe-fine-sand"
grains = {grains}
cloud_edge = "{edge:.15g} mm"     # grains of one size for every number of them
seed = {seed}

""" + CONTACT + """
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

    name: str
    label: str  # in figures
    family: str  # default, tolerance, wide, rate, inertia, step, damping, grains, reference
    motion: tuple = ()
    grains: int = BASE_GRAINS
    cyclic_steps: float = 4e5  # for the estimate of time: to the end of the cyclic test,
    monotonic_steps: float = 4e4  # ... of the monotonic one; one core, any N
    reversals_after: int = 2  # the cyclic test ends so many reversals after the onset
    cyclic: bool = True
    monotonic: bool = True
    most: int = 1000  # realisations at most


@dataclasses.dataclass(frozen=True)
class Limits:
    """Where tests end, and what the early path is."""

    strain: float = 0.005  # monotonic; beyond some 0.2 % single avalanches part the paths of one specimen
    early_strain: float = 0.001
    longer_strain: float = 0.002  # the reference ends here
    cycles: int = 60  # cyclic, if it does not liquefy
    cyclic_strain: float = 0.03  # ends the liquefied part, if it comes first
    early_reversals: int = 3
    longer_reversals: int = 10  # the second window; the reference runs end here
    max_steps: int = 3_000_000  # of any run
    reversals_after: int = None  # overrides that of the settings


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

    def stage(self):
        limits = self.limits
        if self.kind == "monotonic":
            strain = limits.longer_strain if self.setting.family == "reference" else limits.strain
            return (f'[[stage]]\nkind = "undrained-monotonic"\nstrain = {strain}\n'
                    f"liquefaction_ratio = 1e-6\nmax_steps = {limits.max_steps}\n")
        if self.kind == "cyclic":
            after = self.setting.reversals_after if limits.reversals_after is None else limits.reversals_after
            cycles = limits.cycles
            if self.setting.family == "reference":  # for the path only
                after, cycles = 0, limits.longer_reversals // 2
            return (f'[[stage]]\nkind = "undrained-cyclic"\ndeviator_amplitude = "{QAMP / 1e3:g} kPa"\n'
                    f"until = {{ cycles = {cycles}, reversals_after_liquefaction = {after}, "
                    f"strain = {limits.cyclic_strain:g} }}\n"
                    f"max_steps = {limits.max_steps}\n")
        return ""

    def estimated_seconds(self):
        """CPU time of the first version measured; the runner scales it by what its own runs took."""
        n = self.setting.grains
        if self.kind == "prepare":
            return 6 * (n / 2000) ** 1.35
        per_step = 3e-8 * n * (1 + n / 15000)
        steps = self.setting.cyclic_steps if self.kind == "cyclic" else self.setting.monotonic_steps
        return 0.5 + per_step * min(steps * (self.limits.strain / 0.005 if self.kind == "monotonic" else 1),
                                    self.limits.max_steps)


def tolerance(value, **more):
    return Setting(f"tol{value:g}", f"tol {value:g}", "tolerance", (("quasi_static_tolerance", f"{value:g}"),), **more)


def wide(value, **more):
    keys = (("quasi_static_tolerance", f"{value:g}"), ("rate_floor", '"0.02 1/s"'), ("rate_ceiling", '"20 1/s"'))
    return Setting(f"wide{value:g}", f"tol {value:g}, wide", "wide", keys, **more)


def rate(value, **more):
    return Setting(f"rate{value:g}", f"{value:g} 1/s", "rate", (("strain_rate", f'"{value:g} 1/s"'),), **more)


def inertia(exponent, digit=1, **more):
    number = f"{digit}e{exponent}"
    return Setting(f"I{number}", f"I = {number}", "inertia", (("inertial_number", number),), **more)


def safety(value, **more):
    return Setting(f"step{value:g}", f"step {value:g}", "step", (("time_step_safety", f"{value:g}"),), **more)


def damping(value, **more):
    return Setting(f"damp{value:g}", f"damping {value:g}", "damping", (("damping", f"{value:g}"),), **more)


def default(grains=BASE_GRAINS, **more):
    family = "default" if grains == BASE_GRAINS else "grains"
    return Setting("default", "default" if grains == BASE_GRAINS else f"N = {grains:,}", family, grains=grains, **more)


def reference(grains=BASE_GRAINS, number="1e-5", **more):
    """The slowest rate and the smallest step: what early paths are measured against."""
    keys = (("inertial_number", number), ("time_step_safety", "0.2"))
    return Setting("reference", "reference", "reference", keys, grains, **more)


SLOW = "I1e-5"  # the slow limit of cycles to liquefaction


def full_settings():
    """Steps measured on one or two specimens."""
    slow_reference = {"cyclic_steps": 6e5, "monotonic": False}
    return [
        default(),
        reference(cyclic_steps=3.7e5, monotonic_steps=8e5),
        inertia(-5, reversals_after=0, cyclic_steps=5e5, monotonic_steps=5.4e5),
        tolerance(0.003, cyclic_steps=1e6, monotonic_steps=1.2e5),
        tolerance(0.005, cyclic_steps=7e5, monotonic_steps=8e4),
        tolerance(0.02, cyclic_steps=2.5e5),
        tolerance(0.05, cyclic_steps=2.2e5),
        wide(0.01, cyclic_steps=3.5e5),
        wide(0.02, cyclic_steps=1.7e5),
        wide(0.05, cyclic_steps=8e4),
        wide(0.1, cyclic_steps=6e4),
        inertia(-4, cyclic_steps=9e5, monotonic_steps=6e4),
        inertia(-4, 3, cyclic_steps=3e5, monotonic_steps=2e4),
        inertia(-3, cyclic_steps=1.1e5, monotonic_steps=7e3),
        inertia(-2, cyclic_steps=1e4, monotonic_steps=1e3),
        rate(0.5, cyclic_steps=9e5, monotonic_steps=1.7e5),
        rate(2, cyclic_steps=2.5e5),
        rate(5, cyclic_steps=9e4, monotonic_steps=2e4),
        rate(10, cyclic_steps=5e4, monotonic_steps=1e4),
        rate(20, cyclic_steps=3e4, monotonic_steps=5e3),
        safety(0.4, cyclic_steps=8e5, monotonic_steps=8e4),
        safety(0.2, cyclic_steps=1.6e6, monotonic_steps=1.6e5),
        damping(0.1),
        damping(0.5),
        default(1000),
        reference(1000, **slow_reference),
        default(5000, most=5),
        reference(5000, most=5, **slow_reference),
        default(10000, cyclic_steps=8e5, most=5),
        reference(10000, most=5, **slow_reference),
    ]


def quick_settings():
    return [default(500), reference(500, "1e-4"), dataclasses.replace(default(1000), family="default", label="default"),
            reference(1000, "1e-4"), *(dataclasses.replace(s, grains=1000) for s in quick_variants())]


def quick_variants():
    return [dataclasses.replace(inertia(-4), name=SLOW, label="I = 1e-4 (slow limit of --quick)"), tolerance(0.05),
            inertia(-3), rate(5), safety(0.4)]


def runs(settings, seeds, limits, only=""):
    """All runs: seed by seed, so that a campaign cut short has every setting; within a seed, long ones first."""
    result = []
    for place, seed in enumerate(seeds):
        some = [s for s in settings if place < s.most]
        specimens = {s.grains: s for s in some}
        block = [Run("prepare", s, seed, limits) for s in specimens.values()]
        for setting in some:
            block += [Run(kind, setting, seed, limits) for kind in ("cyclic", "monotonic") if getattr(setting, kind)]
        block = [run for run in block if run.kind == "prepare" or re.search(only, run.name)]
        needed = {run.specimen for run in block if run.kind != "prepare"}
        block = [run for run in block if run.specimen in needed]
        result += sorted(block, key=lambda run: (run.kind != "prepare", -run.estimated_seconds()))
    return result

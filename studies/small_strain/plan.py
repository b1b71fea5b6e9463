# SPDX-License-Identifier: BSD-3-Clause
"""What is run: laws, pressures, seeds, amplitudes."""
import dataclasses

from studies.small_strain import measure

LAWS = {
    "linear-rolling": {"young": "10 GPa"},
    "hertz-mindlin": {"law": "hertz-mindlin"},
}
STIFFNESS_LAWS = {**LAWS, "asperities": {"law": "hertz-mindlin", "exponent": 1.65, "asperity": 0.1}}
DEGREES = (2, 6, 10)  # of preparation friction, in `stiffness`: dense to loose
REDUCTION_DEGREES = 8
GROUND = {  # of deposits: contact parameters that give shear waves of some 150 m/s in 5 m of depth
    "linear-rolling": {"young": "1 GPa"},
    "hertz-mindlin": {"law": "hertz-mindlin", "young": "38 GPa"},
}
REDUCTION_PRESSURES = (25, 100, 400)
AMPLITUDES = (1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2)
DAMPING = 0.2  # local, of packings that answer to a strain; halved as well up to SMALL
SMALL = 1e-5


@dataclasses.dataclass(frozen=True)
class Run:
    """One packing under one loading."""
    kind: str
    law: str
    degrees: int
    seed: int
    pressure: int = 20          # kPa; of `stiffness` the first one
    amplitude: float = 0        # of gamma
    drained: bool = False
    damping: float = DAMPING
    grains: int = 1000

    @property
    def name(self):
        name = f"{self.kind}_{self.law}_{self.degrees}deg_seed{self.seed}"
        if self.kind == "reduction":
            name += f"_{self.pressure}kPa_{self.amplitude:.0e}_{'drained' if self.drained else 'undrained'}"
            name += "" if self.damping == DAMPING else f"_damping{self.damping:g}"
        return name

    @property
    def function(self):
        return getattr(measure, self.kind)

    def arguments(self):
        laws = GROUND if self.kind == "velocity" else STIFFNESS_LAWS
        return {"run": dataclasses.asdict(self), "contact": laws[self.law]}

    def estimated_seconds(self):
        seconds = {"stiffness": 15, "velocity": 10, "reduction": 5 + 60 * min(1, self.amplitude / 1e-3)}
        return seconds[self.kind] * self.grains / 1000


def stiffness(seeds, grains, _):
    return [Run("stiffness", law, degrees, seed, grains=grains) for seed in range(1, seeds + 1) for degrees in DEGREES
            for law in STIFFNESS_LAWS]


def velocity(seeds, grains, _):
    return [Run("velocity", law, 10, seed, 10, grains=grains) for seed in range(1, seeds + 1) for law in LAWS]


def reduction(seeds, grains, amplitudes):
    every = [Run("reduction", law, REDUCTION_DEGREES, seed, pressure, amplitude, drained, damping, grains)
             for damping in (DAMPING, DAMPING / 2) for seed in range(1, seeds + 1) for amplitude in amplitudes
             for pressure in REDUCTION_PRESSURES for law in LAWS for drained in (False, True)]
    return [run for run in every if run.damping == DAMPING or run.amplitude <= SMALL]


PARTS = {"stiffness": stiffness, "velocity": velocity, "reduction": reduction}

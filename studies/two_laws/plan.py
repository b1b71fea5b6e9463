# SPDX-License-Identifier: BSD-3-Clause
"""What is run: undrained tests of the paper and the resistance under four pressures, with both contact laws."""
import dataclasses

LAWS = {"linear-rolling": 'young = "10 GPa"', "hertz-mindlin": 'law = "hertz-mindlin"'}
BOX_GRAINS, CELL_GRAINS = 2000, 1000
PAPER_DEGREES = (10, 8, 12, 9, 11, 7, 6)  # of preparation friction: the density of the paper's test is among them
DENSE_DEGREES = 2
PRESSURES = (50, 100, 200, 400)  # kPa
# tau_amp / sigma'_v0; the last bracket 15 cycles
RATIOS = {"linear-rolling": (0.16, 0.22, 0.19, 0.14), "hertz-mindlin": (0.16, 0.22, 0.19, 0.26)}
SHEAR_DEGREES = 10
CYCLES = 100

SCENE = """title = "{name}"
[grading]
grains = {grains}
cloud_edge = "{edge:.6f} mm"
seed = {seed}
[contact]
{law}
friction = "18 deg"
rolling = {{ stiffness = 0.3, limit = 0.5 }}
twisting = {{ stiffness = 0.3 }}
[specimen]
domain = "{domain}"
pressure = "{pressure} kPa"
preparation_friction = "{degrees} deg"
{motion}{stage}[output]
snapshots = "none"
paraview = false
"""


@dataclasses.dataclass(frozen=True)
class Run:
    """One run, as isostat study takes it: its specimen first (prepare), then its test."""

    kind: str  # prepare, cyclic (triaxial), monotonic, shear (cyclic simple shear)
    law: str
    seed: int
    degrees: int
    domain: str = "rigid-box"
    pressure: int = 200
    ratio: float = 0
    rate: float = 1  # of the default's, both bounds

    @property
    def specimen(self):
        return self.law, self.seed, self.degrees, self.domain, self.pressure

    @property
    def name(self):
        name = f"{self.kind}_{self.law}_{self.domain}_{self.degrees}deg_{self.pressure}kPa_s{self.seed}"
        return name + (f"_csr{self.ratio:g}" if self.ratio else "") + (f"_rate{self.rate:g}" if self.rate != 1 else "")

    @property
    def grains(self):
        return BOX_GRAINS if self.domain == "rigid-box" else CELL_GRAINS

    def scene(self):
        until = f"until = {{ cycles = {CYCLES}, reversals_after_liquefaction = 2 }}\n"
        stage = {
            "prepare": "",
            "cyclic": f'[[stage]]\nkind = "undrained-cyclic"\ndeviator_amplitude = "60 kPa"\n{until}',
            "monotonic": '[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.05\n',
            "shear": f'[[stage]]\nkind = "undrained-cyclic-simple-shear"\nstress_ratio = {self.ratio}\n{until}'
        }[self.kind]
        motion = "[motion]\n" + (f"inertial_number = {7e-4 * self.rate:g}\nload_per_wave = {0.1 * self.rate:g}\n"
                                 if self.rate != 1 else "")
        return SCENE.format(name=self.name, grains=self.grains, edge=10 * (self.grains / 1e4) ** (1 / 3),
                            seed=self.seed, law=LAWS[self.law], domain=self.domain, pressure=self.pressure,
                            degrees=self.degrees, motion=motion, stage=stage)

    def estimated_seconds(self):
        seconds = {"prepare": 10, "cyclic": 60, "monotonic": 60, "shear": 15}[self.kind]
        return seconds * (1 if self.kind == "prepare" else 1 / self.rate)


def with_specimens(tests):
    """The tests, each specimen before the first test that needs it."""
    seen, result = set(), []
    for run in tests:
        if run.specimen not in seen:
            seen.add(run.specimen)
            result.append(dataclasses.replace(run, kind="prepare", ratio=0, rate=1))
        result.append(run)
    return result


def runs(n_seeds):
    """In an order in which a campaign cut short has a part of everything."""
    seeds = range(1, n_seeds + 1)
    both = [(law, seed) for seed in seeds for law in LAWS]
    tests = [Run("cyclic", law, seed, degrees) for degrees in PAPER_DEGREES[:3] for law, seed in both]
    tests += [Run("monotonic", law, seed, DENSE_DEGREES) for law, seed in both]
    tests += [Run("shear", law, seed, SHEAR_DEGREES, "periodic-cell", pressure, RATIOS[law][k])
              for k in range(4) for pressure in PRESSURES for law, seed in both]
    tests += [Run("shear", law, seed, SHEAR_DEGREES, "periodic-cell", 100, RATIOS[law][1], 0.1) for law, seed in both]
    tests += [Run("cyclic", law, seed, degrees) for degrees in PAPER_DEGREES[3:] for law, seed in both]
    return with_specimens(tests)

# SPDX-License-Identifier: BSD-3-Clause
"""What is run: specimens with grains of one size for every number of them, compressed at constant volume."""
import dataclasses

from studies.speed_error.plan import CONTACT

STRAINS = (0.0002, 0.0005, 0.001, 0.002, 0.005)  # axial, of the table
SCENE = """title = "Stress against N: {grains} grains, realisation {seed}"
[grading]
curve = "karlsruhe-fine-sand"
grains = {grains}
cloud_edge = "{edge:.12g} mm"
seed = {seed}
""" + CONTACT + """[specimen]
pressure = "200 kPa"
preparation_friction = "10 deg"
[motion]
damping = 0.2
strain_rate = "{rate:g} 1/s"
[[stage]]
kind = "undrained-monotonic"
direction = "compression"
strain = {strain:g}
[output]
record_stress = "2 kPa"
record_strain = 5e-5
snapshots = "none"
paraview = false
checkpoint = "2 min"
"""


@dataclasses.dataclass(frozen=True)
class Run:
    """A specimen and its test in one."""

    grains: int
    seed: int
    rate: float  # 1/s
    kind = "monotonic"

    @property
    def specimen(self):
        return self.grains, self.seed

    @property
    def name(self):
        return f"n{self.grains:06d}_seed{self.seed:02d}"

    def scene(self):
        return SCENE.format(grains=self.grains, seed=self.seed, edge=10 * (self.grains / 10000) ** (1 / 3),
                            rate=self.rate, strain=STRAINS[-1])

    def estimated_seconds(self):
        return self.grains / 2000 * (10 + 11 / self.rate)

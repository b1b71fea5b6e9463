# SPDX-License-Identifier: BSD-3-Clause
"""The runs of the campaign, the most telling first."""
import dataclasses

SEEDS = 40  # asked of the library; those that miss their density are not in it
MIXED = 38  # seeds of which a packing has one by lot, where depths differ


@dataclasses.dataclass(frozen=True)
class Run:
    """A column of so many points (two in each element), so many packings at each; `mixed`: each depth has others."""

    mixed: bool
    points: int
    realisations: int
    member: int
    viscosity: float = 0.1  # ms, of the skeleton

    @property
    def group(self):
        return f"{'mixed' if self.mixed else 'same'}_p{self.points}_m{self.realisations}_v{self.viscosity:g}"

    @property
    def name(self):
        return f"{self.group}_{self.member}"

    @property
    def settings(self):
        """Those of `soil_column --ensemble`: a member has other seeds, or another lot of the same ones."""
        keys = {"layer.0.cells": self.points // 2, "grains.realisations": self.realisations,
                "analysis.viscosity": f"{self.viscosity:g} ms"}
        if self.mixed:
            return {**keys, "layer.0.mixed_realisations": MIXED, "layer.0.lot": self.member}
        return {**keys, "layer.0.realisation": self.member * self.realisations}


# ((mixed, points, realisations, viscosity in ms), members), the most telling first
STAGES = [
    [((False, 10, 1, 0.1), range(3)), ((True, 10, 1, 0.1), range(3)), ((False, 10, 1, 0), range(3)),
     ((False, 4, 1, 0.1), range(3)), ((True, 4, 1, 0.1), range(3))],
    [((False, 20, 1, 0.1), range(3)), ((True, 20, 1, 0.1), range(3)), ((False, 10, 3, 0.1), range(3))],
    [((False, 10, 1, 0.1), range(3, 8)), ((True, 10, 1, 0.1), range(3, 8)), ((False, 10, 1, 1), range(3)),
     ((False, 4, 1, 0.1), range(3, 8)), ((True, 4, 1, 0.1), range(3, 8))],
    [((False, 10, 10, 0.1), range(2)), ((False, 40, 1, 0.1), range(2)), ((True, 40, 1, 0.1), range(2)),
     ((True, 10, 3, 0.1), range(3))],
    [((False, 20, 1, 0.1), range(3, 6)), ((True, 20, 1, 0.1), range(3, 6)), ((True, 20, 3, 0.1), range(3)),
     ((False, 10, 3, 0.1), range(3, 6)), ((False, 10, 10, 0.1), range(2, 4))],
]


def runs():
    """Stage by stage, member by member over the samples of a stage, so that a campaign that ends early has some of
    each."""
    return [Run(mixed, points, realisations, member, viscosity) for stage in STAGES for member in range(8)
            for (mixed, points, realisations, viscosity), members in stage if member in members]

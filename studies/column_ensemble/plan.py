# SPDX-License-Identifier: BSD-3-Clause
"""What is run, the most telling first."""
import dataclasses
import pathlib

from isostat.column import ColumnScene
from studies.columns import SCENES

GRAINS = 300  # of a packing
LARGE, LARGE_SEEDS = 3000, 2  # one packing of as many grains as ten have
SEEDS = 40  # of the library; those that miss their density are not in it
MIXED = 38  # seeds of which a packing draws one at random, where depths differ


@dataclasses.dataclass(frozen=True)
class Run:
    """A column of this many points (two in each element) and packings at each; `mixed`: each depth has others."""

    folder: pathlib.Path  # of the study
    mixed: bool
    points: int
    realisations: int
    member: int
    viscosity: float = 0.1  # ms, of the skeleton
    length: float = 0  # m; points so near to each other have the same seeds
    grains: int = GRAINS
    kind, specimen, program = "column", None, "soil_column"

    @property
    def sample(self):
        grains = [] if self.grains == GRAINS else [self.grains]
        return self.mixed, self.realisations, self.viscosity, self.length, *grains

    @property
    def group(self):
        depths = (f"blocks{self.length:g}" if self.length else "mixed") if self.mixed else "same"
        grains = "" if self.grains == GRAINS else f"_n{self.grains}"
        return f"{depths}_p{self.points}_m{self.realisations}_v{self.viscosity:g}{grains}"

    @property
    def name(self):
        return f"{self.group}_{self.member}"

    @property
    def settings(self):
        """Those of `isostat ensemble`: a member has other seeds, or another draw of the same ones."""
        keys = {"layer.0.cells": self.points // 2, "grains.realisations": self.realisations,
                "grains.library": library_of(self.folder, self.grains),
                "grains.cache": self.folder / f"in_situ_{self.grains}.h5",
                "analysis.viscosity": f"{self.viscosity:g} ms"}
        if self.mixed:
            return {**keys, "layer.0.mixed_realisations": MIXED, "layer.0.lot": self.member,
                    **({"layer.0.lot_length": f"{self.length:g} m"} if self.length else {})}
        return {**keys, "layer.0.realisation": self.member * self.realisations}

    def scene(self):
        if library_of(self.folder, self.grains).is_file():
            return ColumnScene(SCENES / "column/quick_ensemble.toml", set=self.settings)
        return None

    def estimated_seconds(self):
        return 25 * (self.points / 10) ** 1.6 * self.realisations * self.grains / GRAINS


def library_of(folder, grains):
    return folder / f"library_{grains}.h5"


# (mixed, realisations, viscosity in ms, length in m); samples with their points and members, the most telling first
SAME, OTHER, BLOCKS, WITHOUT, MORE = ((False, 1, 0.1, 0), (True, 1, 0.1, 0), (True, 1, 0.1, 0.8), (False, 1, 0, 0),
                                       (False, 3, 0.1, 0))
MIXED_MORE, TEN, MIXED_TEN = (True, 3, 0.1, 0), (False, 10, 0.1, 0), (True, 10, 0.1, 0)
STAGES = [
    [(SAME, 10, range(3)), (OTHER, 10, range(3)), (WITHOUT, 10, range(3)), (SAME, 4, range(3)), (OTHER, 4, range(3))],
    [(SAME, 20, range(3)), (OTHER, 20, range(3)), (BLOCKS, 10, range(3)), (BLOCKS, 20, range(3)), (MORE, 10, range(3))],
    [(SAME, 10, range(3, 8)), (OTHER, 10, range(3, 8)), (BLOCKS, 10, range(3, 8)), (TEN, 10, range(1)),
     (MIXED_MORE, 10, range(1)), (MIXED_TEN, 10, range(1)), (OTHER, 40, range(1))],
    [(SAME, 40, range(1)), (BLOCKS, 40, range(1)), (TEN, 10, range(1, 3)), (MIXED_MORE, 10, range(1, 3)),
     (MIXED_TEN, 10, range(1, 3)), (MORE, 10, range(3, 8)), (SAME, 20, range(3, 8)), (OTHER, 20, range(3, 8)),
     (BLOCKS, 20, range(3, 8)), (SAME, 4, range(3, 8)), (OTHER, 4, range(3, 8))],
    [(OTHER, 80, range(1)), (SAME, 80, range(1)), (BLOCKS, 80, range(1)), (SAME, 40, range(1, 3)),
     (OTHER, 40, range(1, 3)), (BLOCKS, 40, range(1, 3))],
    [((False, 1, 1, 0), 10, range(3)), (OTHER, 160, range(1)), (SAME, 160, range(1)), (BLOCKS, 160, range(1))],
]


def runs(folder, n_members):
    """Stage by stage, member by member over the samples of a stage, so that a campaign that ends early has some of
    each."""
    small = [Run(folder, mixed, points, realisations, member, viscosity, length) for stage in STAGES
             for member in range(n_members) for (mixed, realisations, viscosity, length), points, members in stage
             if member in members]
    return small + [Run(folder, False, 10, 1, member, grains=LARGE) for member in range(min(n_members, LARGE_SEEDS))]

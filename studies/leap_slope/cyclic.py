# SPDX-License-Identifier: BSD-3-Clause
"""The undrained cyclic triaxial test of Ottawa F65, predicted: cycles to r_u near 1 and to 2.5 % of axial strain."""
import dataclasses

import numpy as np

from isostat.results import read_table
from studies.history import parsed
from studies.leap_slope.drained import FIRST_SEED, PREPARED, scene_of
from studies.scenes import cyclic

VOID_RATIO, PRESSURE, AMPLITUDE = 0.507, 100, 65  # kPa; q = 2 x 0.325 x 100 kPa
GRAINS, MOST_CYCLES, ONSET, STRAIN = 1000, 100, 0.05, 0.025  # ONSET: p'/p0' at which r_u counts as 1


@dataclasses.dataclass(frozen=True)
class Cyclic:
    """The test on one specimen, prepared for the void ratio of a test of the laboratory."""

    void_ratio: float
    seed: int
    expansion: float = 0
    kind, specimen, program = "cyclic", None, "element_test"

    @property
    def name(self):
        return f"cyclic_e{self.void_ratio:g}_{'opened_' if self.expansion else ''}s{self.seed}"

    def scene(self):
        stage = cyclic(f"{AMPLITUDE} kPa", cycles=MOST_CYCLES, strain=STRAIN,
                       reversals_after_liquefaction=2 * MOST_CYCLES)
        return scene_of(self.name, self.seed, GRAINS, {}, PRESSURE, PREPARED[self.void_ratio],
                        [stage | {"liquefaction_ratio": ONSET}], {}, self.expansion)

    def estimated_seconds(self):
        return 15


def runs(seeds, expansion):
    """The test; after the predictions the same on packings of drained tests, the dependence on density, and on opened
    ones."""
    return [*(Cyclic(VOID_RATIO, seed, x) for x in (0, expansion) for seed in range(FIRST_SEED, FIRST_SEED + seeds)),
            *(Cyclic(e0, FIRST_SEED) for e0 in (0.584, 0.724)), Cyclic(0.584, FIRST_SEED, expansion)]


def cycles(folder):
    """To ONSET and to STRAIN, MOST_CYCLES where they are not reached; void ratio, largest r_u, largest axial strain."""
    history, summary = read_table(folder / "history.csv"), parsed(folder)
    onset, strain = summary["liquefaction"], np.abs(history["eps_y"])
    reached = strain >= STRAIN
    return {"r_u": onset["cycle"] if onset else MOST_CYCLES,
            "strain": history["reversals"][reached.argmax()] / 2 if reached.any() else MOST_CYCLES,
            "e": history["e"][0], "largest r_u": 1 - history["p"].min() / history["p"][0],
            "largest strain": strain.max()}

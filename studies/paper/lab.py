# SPDX-License-Identifier: BSD-3-Clause
"""Laboratory tests on Karlsruhe fine sand (apps/laboratory)."""
import dataclasses

import numpy as np

from isostat.results import read_table
from studies import APPS
from studies.tables import read_csv

FOLDER = APPS / "laboratory"


@dataclasses.dataclass(frozen=True)
class Drained:
    """One drained test: strains as shares, stresses in Pa, compression positive."""

    name: str
    void_ratio: float
    relative_density: float
    pressure: float  # kPa, nominal
    strain: np.ndarray
    volume_strain: np.ndarray
    axial: np.ndarray
    radial: np.ndarray

    def until(self, strain):
        """The same test, ended at this strain."""
        rows = self.strain <= strain * (1 + 1e-6)
        return dataclasses.replace(self, **{name: getattr(self, name)[rows] for name in
                                            ("strain", "volume_strain", "axial", "radial")})


def drained_tests():
    programme = {row["test_id"]: row for row in read_csv(FOLDER / "drained/programme.csv")}
    return [drained_test(path, programme[path.stem]) for path in sorted((FOLDER / "drained").glob("TMD*.csv"))]


def drained_test(path, entry):
    columns = read_table(path)
    return Drained(path.stem, entry["e_0[-]"], entry["Dr_0[%]"] / 100, 100 * round(entry["sigma_r0[kPa]"] / 100),
                   columns["eps_a[%]"] / 100, columns["eps_v[%]"] / 100, 1e3 * columns["sigma_v[kPa]"],
                   1e3 * columns["sigma_r[kPa]"])


def undrained_anchors():
    """Single states of undrained tests; a number that was not read is nan."""
    return read_csv(FOLDER / "undrained_anchors.csv")

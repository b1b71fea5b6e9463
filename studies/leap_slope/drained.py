# SPDX-License-Identifier: BSD-3-Clause
"""Drained triaxial tests on packings of Ottawa F65, and the fit of the contact to the laboratory's peak friction.

Packings are as dense as the specimens of the laboratory: the void ratio of a packing follows from the friction with
which it is prepared.
"""
import dataclasses
import itertools
import tomllib

import isostat
import numpy as np

from studies import APPS
from studies.sand_calibration.predictions import modulus
from studies.tables import read_csv

LABORATORY, SAND = APPS / "laboratory/ottawa_f65", APPS / "scenes/sands/ottawa-f65.toml"
FRICTIONS, LIMITS, PREPARATIONS = (20, 25), (0.05, 0.1), (2, 5, 12, 20)  # deg, eta_r, deg
GRAINS, STRAIN, PACE = 800, 0.16, 2e-3  # PACE: inertial number
PRESSURE = 200  # kPa, in the middle of the fitted tests
# {void ratio of the laboratory: preparation friction in deg}, as the fit found it; of 0.507, that of the cyclic test,
# beyond the packings of the grid
PREPARED = {0.507: 0.92, 0.584: 2.97, 0.604: 4.02, 0.724: 13.4}
FIRST_SEED = 11  # of tests on the fitted sand: other packings than those of the fit


def sand():
    return tomllib.loads(SAND.read_text(encoding="utf-8"))


def scene_of(name, seed, grains, contact, pressure, preparation, stages, motion, expansion):
    return isostat.Scene({
        "title": name, "grading": sand()["grading"] | {"grains": grains, "seed": seed},
        "contact": sand()["contact"] | contact,
        "specimen": {"domain": "periodic-cell", "pressure": f"{pressure} kPa",
                     "preparation_friction": f"{preparation} deg", "expansion": expansion},
        "motion": motion, "output": {"snapshots": "none", "paraview": False}, "stage": stages})


@dataclasses.dataclass(frozen=True)
class Drained:
    """Triaxial test of one specimen; without a friction, of the sand as its file has it."""

    preparation: float  # deg
    seed: int
    friction: float | None = None  # deg
    limit: float | None = None  # eta_r
    void_ratio: float | None = None  # of the laboratory's test
    pressure: float = PRESSURE
    direction: str = "compression"
    expansion: float = 0
    kind, specimen, program = "drained", None, "element_test"

    @property
    def name(self):
        of = (f"e{self.void_ratio:g}" if self.void_ratio else
              f"{self.friction:g}deg_{self.limit:g}_{self.preparation:g}deg")
        return f"{self.direction}_{of}_{self.pressure:g}kPa_{'opened_' if self.expansion else ''}s{self.seed}"

    def scene(self):
        contact = {} if self.friction is None else {
            "friction": f"{self.friction} deg", "rolling": sand()["contact"]["rolling"] | {"limit": self.limit}}
        stage = {"kind": "drained", "direction": self.direction, "strain": STRAIN}
        return scene_of(self.name, self.seed, GRAINS, contact, self.pressure, self.preparation, [stage],
                        {"inertial_number": PACE}, self.expansion)

    def estimated_seconds(self):
        return 2.5


class Modulus(Drained):
    """G of the network of contacts."""

    kind, function = "modulus", staticmethod(modulus)

    @property
    def name(self):
        return f"G_{super().name}"

    def arguments(self):
        return {"scene": self.scene().text}


def moduli(seeds, expansion):
    """As dense as the sand for which E was chosen, at 100 kPa."""
    return [Modulus(PREPARED[0.604], seed, void_ratio=0.604, pressure=100, expansion=x) for x in (0, expansion)
            for seed in range(FIRST_SEED, FIRST_SEED + seeds)]


def hardin_richart(e, pressure):
    """G of round Ottawa sand, MPa (Hardin and Richart 1963).   pressure: kPa"""
    return 6.908 * (2.17 - e)**2 / (1 + e) * pressure**0.5


def grid(seeds):
    return [Drained(preparation, seed, friction, limit) for seed in range(1, seeds + 1)
            for friction, limit, preparation in itertools.product(FRICTIONS, LIMITS, PREPARATIONS)]


def tests():
    return read_csv(LABORATORY / "drained_peaks.csv")


def is_fitted(row):
    return row["mode"] == "TC" and row["sigma_3 (kPa)"] <= 300


def checks(seeds, expansion=0):
    """All tests of the laboratory, of the fitted sand."""
    return [Drained(PREPARED[row["e0"]], seed, void_ratio=row["e0"], pressure=row["sigma_3 (kPa)"],
                    direction="compression" if row["mode"] == "TC" else "extension", expansion=expansion)
            for row in tests() for seed in range(FIRST_SEED, FIRST_SEED + seeds)]


def strength(history):
    """Peak friction angle, deg: sin(phi) = (sigma_1 - sigma_3)/(sigma_1 + sigma_3), axial strain there and void ratio
    at the start.   tested: tests/studies/leap_slope_test.py"""
    q, p, axial = history["q"], history["p"], history["eps_y"]
    sine = np.abs(q) / (2 * p + q / 3)  # in extension q < 0 and sigma_1 is the lateral stress
    peak = int(sine.argmax())
    return float(np.degrees(np.arcsin(sine[peak]))), float(abs(axial[peak])), float(history["e"][0])


def fitted():
    """{void ratio: mean peak friction of the laboratory in compression at 100 to 300 kPa}"""
    return {e0: float(np.mean([row["peak friction (deg)"] for row in tests() if is_fitted(row) and row["e0"] == e0]))
            for e0 in sorted({row["e0"] for row in tests()})}


def at_void_ratio(found, e0):
    """(peak friction, preparation friction) of packings of a void ratio; between those of the grid both are linear,
    the latter in its logarithm.   found: (preparation friction, peak friction, strain, void ratio) of each"""
    groups = {}
    for preparation, friction, _, e in found:
        groups.setdefault(preparation, []).append((e, friction))
    e, friction, preparation = np.array(sorted((*np.mean(values, axis=0), of) for of, values in groups.items())).T
    k = int(np.clip(np.searchsorted(e, e0), 1, len(e) - 1))
    t = (e0 - e[k - 1]) / (e[k] - e[k - 1])
    return (float(friction[k - 1] + t * (friction[k] - friction[k - 1])),
            float(preparation[k - 1] * (preparation[k] / preparation[k - 1])**t))


def fit(strengths):
    """Least root mean square of the differences in peak friction over friction and ln(eta_r), in which peak friction is
    bilinear.

    strengths: {(friction, limit, preparation, seed): (peak friction, strain, void ratio)} of the whole grid
    returns    friction, limit, misfit in deg, {void ratio: (laboratory, fit, preparation friction)}
    """
    def packings(*contact):
        return [(key[2], *value) for key, value in strengths.items() if key[:2] == contact]

    table = np.array([[[at_void_ratio(packings(friction, limit), e0) for e0 in fitted()] for limit in LIMITS]
                      for friction in FRICTIONS])  # last index: peak friction, preparation friction
    s, t = np.meshgrid(*2 * [np.linspace(0, 1, 101)], indexing="ij")
    weights = np.stack([[(1 - s) * (1 - t), (1 - s) * t], [s * (1 - t), s * t]])
    values = np.einsum("ijmn,ijev->mnev", weights, table)
    misfit = np.sqrt(np.mean((values[..., 0] - list(fitted().values()))**2, axis=-1))
    m, n = np.unravel_index(misfit.argmin(), misfit.shape)
    friction = FRICTIONS[0] + s[m, n] * (FRICTIONS[1] - FRICTIONS[0])
    limit = LIMITS[0] * (LIMITS[1] / LIMITS[0])**t[m, n]
    return float(friction), float(limit), float(misfit[m, n]), {
        e0: (laboratory, *values[m, n, k]) for k, (e0, laboratory) in enumerate(fitted().items())}

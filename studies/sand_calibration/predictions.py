# SPDX-License-Identifier: BSD-3-Clause
"""What a fitted contact predicts: the modulus at small strain, drained, undrained and cyclic triaxial tests."""
import dataclasses
import functools
import json
import pathlib
import tomllib

import isostat
import numpy as np

from studies.sand_calibration import posterior
from studies.sand_calibration.posterior import number
from studies.scenes import cyclic, scene_of
from studies.tables import read_csv

LABORATORY = pathlib.Path(__file__).parents[2] / "apps/laboratory"
PLAN = LABORATORY.parent / "scenes/calibrate/karlsruhe_drained.toml"
GRAINS, FIRST_SEED = 1000, 11  # other specimens than those of the fit
MOST_CYCLES, ONSET = 100, 0.05  # p'/p0' at which cycles are counted, r_u = 0.95
CYCLIC = ("TCUI1", "TCUI4", "TCUI7", "TCUI13")  # cycles known, and the same as the last on another specimen
EXPANSIONS = (0, 0.002, 0.005, 0.01)
KINDS = {"small strain": 1, "drained": 3, "undrained": 3, "cyclic": 8}  # CPU seconds, by estimate


@functools.cache
def curves():
    """{test: its curve in the plan}, of those with specimens as dense as the fitted ones."""
    plan = tomllib.loads(PLAN.read_text(encoding="utf-8"))
    return {pathlib.Path(curve["file"]).stem: curve for curve in plan["curve"] if "preparation_friction" not in curve}


def fitted():
    """{group of specimens: the test to which their preparation friction is fitted}"""
    return {curve["group"]: test for test, curve in curves().items() if not curve.get("blind")}


@functools.cache
def densities():
    """{test: (relative density of the laboratory, p0' in kPa)}, of the drained tests."""
    return {row["test_id"]: (row["Dr_0[%]"] / 100, row["sigma_r0[kPa]"])
            for row in read_csv(LABORATORY / "drained/programme.csv")}


def limits():
    """e_min and e_max of the laboratory."""
    text = (LABORATORY / "drained/properties.csv").read_text(encoding="utf-8")
    return [next(float(line.split(",")[2]) for line in text.splitlines() if f",{name}," in line)
            for name in ("e_min", "e_max")]


def relative_density(void_ratio):
    """Of the laboratory."""
    least, most = limits()
    return (most - void_ratio) / (most - least)


class Fit:
    """What isostat calibrate left of a contact."""

    def __init__(self, folder):
        self.folder = folder
        self.numbers = json.loads((folder / "calibrate.json").read_text(encoding="utf-8"))
        self.contact = isostat.Scene(folder / "best_scene.toml").to_dict()["contact"]
        self.fitted = self.numbers["misfit_best"]
        self.values = [number(one["best"]) for one in self.numbers["parameters"]]

    def drawn(self, k):
        """{key of a scene, or group of specimens: number}: the best set (0), or a draw of the posterior."""
        values = posterior.fit(self.folder.parent).draw(k) if k else self.values
        return dict(zip((one["curve"] or one["key"] for one in self.numbers["parameters"]), map(float, values)))

    def scene(self, k, density):
        """Sections contact and specimen of a draw, for specimens of a relative density of the laboratory."""
        values = self.drawn(k)
        contact = self.contact | {"friction": f"{values['contact.friction']:.6g} deg"}
        contact["rolling"] = contact["rolling"] | {"limit": values["contact.rolling.limit"]}
        return contact, {"domain": "periodic-cell", "expansion": values["specimen.expansion"],
                         "preparation_friction": f"{preparation(values, density):.5g} deg"}


def preparation(frictions, density):
    """Friction with which specimens of a relative density of the laboratory are prepared, deg: its logarithm is linear
    between those of the three that were fitted, and beyond them.   frictions: {group of specimens: deg}"""
    at = sorted((densities()[test][0], np.log(frictions[group])) for group, test in fitted().items())
    k = 0 if density < at[1][0] else 1
    (low, first), (high, last) = at[k:k + 2]
    return float(np.exp(first + (density - low) / (high - low) * (last - first)))


def fit_of(folder):
    """None: it has not been fitted yet."""
    return Fit(folder) if (folder / "calibrate.json").is_file() else None


def modulus(results, scene):
    """G of a packing in MPa: mean of the three shear moduli of its contact network."""
    specimen = isostat.prepare(isostat.Scene(scene), cache=results.parent / "specimens", threads=1, quiet=True)
    stiffness = isostat.Rve(specimen.snapshot).stiffness()
    return {"void_ratio": specimen.snapshot.void_ratio, "G": float(np.mean(np.diag(stiffness)[3:])) / 1e6}


@dataclasses.dataclass(frozen=True)
class Test:
    """One specimen under one test of the laboratory, with the best set (the first seed) or a draw of the posterior."""

    output: pathlib.Path  # of the study
    contact: str
    kind: str
    test: str
    density: float  # relative, of the laboratory
    pressure: float  # kPa
    seed: int
    stage: tuple = ()  # (key, value)
    expansion: float | None = None  # in place of the fitted one

    @property
    def name(self):
        of = "" if self.expansion is None else f"_x{self.expansion:g}"
        return f"{self.contact}_{self.test}{of}_s{self.seed}".replace(" ", "_")

    def scene(self):
        fit = fit_of(self.output / self.contact)
        if fit is None:
            return None
        contact, specimen = fit.scene(self.seed - FIRST_SEED, self.density)
        if self.expansion is not None:
            specimen |= {"expansion": self.expansion}
        return isostat.Scene(scene_of(self.name, GRAINS, self.seed, specimen | {"pressure": f"{self.pressure:g} kPa"},
                                      [dict(self.stage)] if self.stage else [], contact=contact, motion=self.motion))

    @property
    def motion(self):
        """Rates: of the fit; of cyclic tests the default, as for the undrained ones of p' at little strain."""
        return {"drained": {"inertial_number": 2e-3}, "undrained": {"inertial_number": 7e-4}}.get(
            self.kind.removesuffix(" over expansion"), {})

    def estimated_seconds(self):
        return KINDS[self.kind.removesuffix(" over expansion")]


class SmallStrain(Test):
    function = staticmethod(modulus)

    def arguments(self):
        scene = self.scene()
        if scene is None:
            raise isostat.InputError(f"{self.contact} has not been fitted yet.")
        return {"scene": scene.text}


def cyclic_stage(amplitude):
    return tuple((cyclic(f"{amplitude:g} kPa", cycles=MOST_CYCLES, reversals_after_liquefaction=0)
                  | {"liquefaction_ratio": ONSET}).items())


def small_strain(output, contact, seeds):
    return [SmallStrain(output, contact, "small strain", f"G of {test}", densities()[test][0], 100, seed)
            for test in fitted().values() for seed in seeds]


def undrained(output, contact, seeds):
    """The tests of undrained_anchors.csv at 200 kPa, of packings as loose, medium and dense as the fitted ones."""
    rows = {row["test"]: row for row in read_csv(LABORATORY / "undrained_anchors.csv")}
    return [Test(output, contact, "undrained", test, densities()[fitted()[row["density"]]][0], 200, seed,
                 (("kind", "undrained-monotonic"), ("direction", row["direction"]), ("strain", 0.05)))
            for test, row in rows.items() for seed in seeds]


def cyclic_tests(output, contact, seeds):
    return [Test(output, contact, "cyclic", row["test"], round(relative_density(row["e0"]), 4), row["p0 (kPa)"], seed,
                 cyclic_stage(row["q amplitude (kPa)"]))
            for seed in seeds for row in read_csv(LABORATORY / "undrained_cyclic.csv") if row["test"] in CYCLIC]


def expansions(output, contact, seeds):
    """Dense undrained compression to 1 % with the best set and other expansions, a cyclic test with none."""
    tests = {test.test: test for test in cyclic_tests(output, contact, seeds)}
    tests |= {test.test: dataclasses.replace(test, stage=tuple((dict(test.stage) | {"strain": 0.01}).items()))
              for test in undrained(output, contact, seeds)}  # dense ones reach 10 MPa after that
    return [dataclasses.replace(tests[name], kind=f"{tests[name].kind} over expansion", expansion=x)
            for name, x in [*(("TMU6", x) for x in EXPANSIONS), ("TCUI13", 0)]]


def drained(output, contact, seeds):
    """Those in drained/ that are not fitted."""
    others = sorted({path.stem for path in (LABORATORY / "drained").glob("TMD*.csv")} - set(fitted().values()))
    return [Test(output, contact, "drained", test, densities()[test][0], round(densities()[test][1], -2), seed,
                 (("kind", "drained"), ("strain", 0.106))) for test in others for seed in seeds]

# SPDX-License-Identifier: BSD-3-Clause
"""What a fitted contact predicts: the modulus at small strain, drained, undrained and cyclic triaxial tests."""
import dataclasses
import functools
import pathlib
import tomllib

import isostat
import numpy as np

from studies.sand_calibration import posterior
from studies.sand_calibration.posterior import PARAMETERS
from studies.scenes import cyclic, scene_of
from studies.tables import read_csv

LABORATORY = pathlib.Path(__file__).parents[2] / "apps/laboratory"
PLAN = LABORATORY.parent / "scenes/calibrate/karlsruhe_drained.toml"
GRAINS, FIRST_SEED, DRAWS = 1000, 11, 2  # other specimens than those of the fit; sets of the posterior
MOST_CYCLES, ONSET = 100, 0.05  # p'/p0' at which cycles are counted, r_u = 0.95
LIKE_PAPER = ("TCUI13", "TCUI7")  # D_r = 0.59 and 0.67; 11 cycles of the paper's specimen, D_r = 0.64, same load
KINDS = {"small strain": 3, "drained": 5, "undrained": 4, "cyclic": 8}  # CPU seconds, by estimate
CONTACT = {"law": "hertz-mindlin", "young": "65 GPa", "friction": "25 deg", "rolling": {"stiffness": 0.3, "limit": 0.1},
           "twisting": {"stiffness": 0.3}}  # quartz; the two others are fitted
COMPACTED = CONTACT | {"young": "38 GPa"}, [25, 0.1, 0, 0, 0, 26, 17, 6.9]  # not opened; fit of revision 8b91876a
EXPANSION, PREPARATION = "specimen.expansion", "specimen.preparation_friction"
OPENINGS = {f"expansion {x:g}": {EXPANSION: x} for x in (0, 0.002, 0.005, 0.01, 0.02)}
# of dense packings {contact: {label: what is changed, None: left out}}
VARIANTS = {"compacted": {"linear": {"contact.law": "linear-rolling", "contact.young": "1.45 GPa"},
                          "asperities": {"contact.exponent": 2}, "no twisting": {"contact.twisting": None},
                          "no rolling and twisting": {"contact.rolling": None, "contact.twisting": None},
                          "walls": {"specimen.domain": "rigid-box"},
                          **{f"4 deg, {of}": {PREPARATION: "4 deg", **changed} for of, changed in OPENINGS.items()}},
            "opened": OPENINGS | {"static": {"motion.drive": "static"}}}
SLOWER = "4 times slower", {"motion.inertial_number": 5e-4}
DRAINED_CYCLES = {"kind": "path", "drive": "y", "x": {"keep": "stress"}, "z": {"keep": "stress"}, "consolidation": True,
                  "turn": {"strain": 5e-4}, "until": {"cycles": 10}}


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


@dataclasses.dataclass
class Fit:
    """A contact, and sets of values in the order of PARAMETERS: the best (0), draws of the posterior."""

    contact: dict
    sets: list

    def values(self, k, density):
        """{key: value} for specimens of a relative density of the laboratory."""
        groups = {}
        for one, value in zip(PARAMETERS, map(float, self.sets[k])):
            groups.setdefault(one["key"], {})[one.get("curve")] = value
        return {key: of[None] if None in of else at_density(of, density) for key, of in groups.items()}

    def scene(self, k, density):
        """Sections contact and specimen."""
        values = self.values(k, density)
        contact = self.contact | {"friction": f"{values['contact.friction']:.6g} deg"}
        contact["rolling"] = contact["rolling"] | {"limit": values["contact.rolling.limit"]}
        return contact, {"domain": "periodic-cell", "expansion": values[EXPANSION],
                         "preparation_friction": f"{values[PREPARATION]:.5g} deg"}


def at_density(values, density):
    """Expansion or preparation friction of specimens of a relative density of the laboratory: the logarithm is linear
    between the three that were fitted, and beyond them.   values: {group of specimens: value}"""
    at = sorted((densities()[test][0], values[group]) for group, test in fitted().items())
    k = 0 if density < at[1][0] else 1
    (low, first), (high, last) = at[k:k + 2]
    return float(first * (last / first)**((density - low) / (high - low))) if first else 0.0


def fit_of(output, contact):
    """None: it has not been fitted yet."""
    if contact == "compacted":
        return Fit(COMPACTED[0], [COMPACTED[1]])
    if not (output / "design/calibrate.json").is_file():
        return None
    return Fit(CONTACT, [posterior.fit(output).draw(k) for k in range(1 + DRAWS)])


def modulus(results, scene):
    """G of a packing in MPa: mean of the three shear moduli of its contact network."""
    specimen = isostat.prepare(isostat.Scene(scene), cache=results.parent / "specimens", threads=1, quiet=True)
    stiffness = isostat.Rve(specimen.snapshot).stiffness()
    return {"void_ratio": specimen.snapshot.void_ratio, "G": float(np.mean(np.diag(stiffness)[3:])) / 1e6}


@dataclasses.dataclass(frozen=True)
class Test:
    """One specimen under one test of the laboratory."""

    output: pathlib.Path  # of the study
    contact: str
    kind: str
    test: str
    density: float  # relative, of the laboratory
    pressure: float  # kPa
    stages: list
    seed: int
    draw: int = 0  # 0: the best set
    label: str = ""  # of what is changed
    changes: dict = dataclasses.field(default_factory=dict)  # {key: value}

    @property
    def name(self):
        of = "_".join(filter(None, (self.contact, self.test, self.label, self.draw and f"draw{self.draw}")))
        return f"{of}_s{self.seed}".replace(" ", "_").replace(",", "")

    def scene(self):
        fit = fit_of(self.output, self.contact)
        if fit is None:
            return None
        contact, specimen = fit.scene(self.draw, self.density)
        scene = scene_of(self.name, GRAINS, self.seed, specimen | {"pressure": f"{self.pressure:g} kPa"}, self.stages,
                         contact=contact, motion=self.motion)
        for key, value in self.changes.items():
            section, name = key.split(".")
            of_section = ({} if section == "motion" else scene[section]) | {name: value}
            scene[section] = {key: value for key, value in of_section.items() if value is not None}
        return isostat.Scene(scene)

    @property
    def motion(self):
        """Rates: of the fit; of cyclic tests the default, as for the undrained ones of p' at little strain."""
        return {"drained": {"inertial_number": 2e-3}, "undrained": {"inertial_number": 7e-4}}.get(self.kind, {})

    def estimated_seconds(self):
        return KINDS[self.kind] * (4 if "drive" in str(self.changes) or "slower" in self.label else 1)


class SmallStrain(Test):
    function = staticmethod(modulus)

    def arguments(self):
        scene = self.scene()
        if scene is None:
            raise isostat.InputError(f"{self.contact} has not been fitted yet.")
        return {"scene": scene.text}


def small_strain(output, contact, *packing):
    return [SmallStrain(output, contact, "small strain", f"G of {test}", densities()[test][0], 100, [], *packing)
            for test in fitted().values()]


def drained(output, contact, *packing):
    return [Test(output, contact, "drained", test, densities()[test][0], round(densities()[test][1], -2),
                 [{"kind": "drained", "strain": 0.106}], *packing)
            for test in sorted(path.stem for path in (LABORATORY / "drained").glob("TMD*.csv"))]


def undrained(output, contact, *packing):
    """The tests of undrained_anchors.csv at 200 kPa, of packings as loose, medium and dense as the fitted ones. Dense
    ones, whose p' is least before, to 2 % of strain."""
    rows = {row["test"]: row for row in read_csv(LABORATORY / "undrained_anchors.csv")}
    return [Test(output, contact, "undrained", test, densities()[fitted()[row["density"]]][0], 200,
                 [{"kind": "undrained-monotonic", "direction": row["direction"],
                   "strain": 0.02 if row["density"] == "dense" else 0.05}], *packing) for test, row in rows.items()]


def cyclic_tests(output, contact, *packing):
    def stage(amplitude):
        return cyclic(f"{amplitude:g} kPa", cycles=MOST_CYCLES, reversals_after_liquefaction=0) | {
            "liquefaction_ratio": ONSET}
    return [Test(output, contact, "cyclic", row["test"], round(relative_density(row["e0"]), 4), row["p0 (kPa)"],
                 [stage(row["q amplitude (kPa)"])], *packing) for row in read_csv(LABORATORY / "undrained_cyclic.csv")]


def dense(output, contact, seed):
    """The dense tests, drained and undrained, that are varied."""
    return [run for of in (drained, undrained) for run in of(output, contact, seed)
            if run.test in (fitted()["dense"], "TMU6")]


def variants(output, seeds):
    """What preparation and asperities change; of the first seed expansion, static drive, cycles before, rate."""
    changed = [dataclasses.replace(run, label=label, changes=changes) for contact, of in VARIANTS.items()
               for label, changes in of.items() for seed in (seeds if contact == "compacted" else seeds[:1])
               for run in dense(output, contact, seed) if label != "static" or run.kind == "undrained"]
    changed += [dataclasses.replace(run, label="10 drained cycles", stages=[DRAINED_CYCLES, *run.stages])
                for run in dense(output, "opened", seeds[0])]
    return changed + [dataclasses.replace(run, label=SLOWER[0], changes=SLOWER[1])
                      for run in drained(output, "opened", seeds[0]) if run.test in fitted().values()]

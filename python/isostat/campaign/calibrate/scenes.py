# SPDX-License-Identifier: BSD-3-Clause
"""The numbers of a scene that are varied between bounds, and the scenes of element_test that follow from their values.

tested: tests/python/calibration_test.py
"""
import functools
import math
import pathlib
import re
from typing import Any

from isostat import _core
from isostat.campaign.calibrate.keys import DENSITIES, number_text, unknown_text
from isostat.campaign.calibrate.plan import concerns
from isostat.campaign.scenes import OF_A_RUN, POWERS, in_si
from isostat.scene import Scene

NUMBERS = ("number", "length", "pressure", "stress rate", "angle", "rate", "time", "time interval", "density")
SET_ELSEWHERE = {"grading.seed": "[specimens]", "grading.grains": "[specimens]", "grading.cloud_edge": "[specimens]",
                 "specimen.pressure": "[[curve]]"}


@functools.cache
def kinds() -> dict[str, str]:
    """The keys of scenes and the kinds of their values."""
    found, section = {}, ""
    for line in _core.scene_manual().splitlines():
        if head := re.match(r"## \[+(\w+)\]", line):
            section = head[1] + "."
        elif row := re.match(r"\| `([\w.]+)` \| (.*?) \|", line):
            found[section + row[1]] = row[2]
    return found


class Parameter:
    """What a plan says of a parameter. The search sees a share of the way between the bounds, along the logarithm if
    the plan says so; values are in SI units, degrees of an angle:

        share = (x - low)/(high - low)     or     ln(x/low)/ln(high/low)

    scene  text of the scene, every key resolved
    Raises InputError: a key that is none, that is no number, or that the curves or [specimens] set; bounds that the
    scene refuses, or that leave nothing between them; a start outside of them.
    """

    def __init__(self, plan: Any, given: Any, scene: str):
        self.key, self.curve, self.given = given.key, given.curve or "", given
        self.unit, self.remark = "", ""
        self.check_key(plan)
        (low, high), start = given.bounds, given.start
        self.low, self.high = self.checked(low, "bounds[0]", scene), self.checked(high, "bounds[1]", scene)
        self.is_log = given.scale == "log"
        if not self.low < self.high:
            raise self.refuse(f"bounds = [{shown(low)}, {shown(high)}] leave nothing between them. Give the lower one "
                              "first.")
        if self.is_log and self.low <= 0:
            raise self.refuse(f"bounds[0] = {shown(low)}; must be > 0 because the scale is log. Raise it or take scale "
                              "= \"linear\".")
        first = self.value(0.5)
        if start is not None:
            first = self.checked(start, "start", scene)
            if not self.low <= first <= self.high:
                raise self.refuse(f"start = {shown(start)}; must be within bounds = [{shown(low)}, {shown(high)}]. "
                                  "Move it or widen the bounds.")
        elif (there := self.of_scene(Scene(scene))) is not None:
            if self.low <= there <= self.high:
                first = there
            else:
                self.remark = "the scene's value is outside of the bounds: the start is their middle"
        self.start = self.share(first)

    def refuse(self, problem: str) -> _core.InputError:
        return _core.InputError(f"{self.given.where}: parameter.key = {self.key}; {problem}")

    def check_key(self, plan: Any) -> None:
        owner = SET_ELSEWHERE.get(self.key, "[[curve]]" if self.key.startswith("stage.") else "")
        if self.key == "motion.inertial_number" and plan.specimens.inertial_number:
            owner = "[specimens]"
        if owner:
            raise self.refuse(f"is set by {owner} of the plan. Give another key.")
        if self.key not in kinds():
            raise self.refuse(unknown_text(self.key, kinds(), "element_test --print-defaults lists those of scenes."))
        if kinds()[self.key] not in NUMBERS:
            raise self.refuse("is not a number that can be varied. Give a key with a number or a quantity.")
        if self.key == "grading.d50":
            raise self.refuse("stays that of the scene, whatever the number of grains. Give another key.")
        for curve in plan.curve if self.key.removeprefix("specimen.") in DENSITIES else ():
            if concerns(self.given, curve) and any(vars(curve)[name] is not None for name in DENSITIES):
                raise self.refuse(f"but curve \"{curve.name}\" ({curve.where}) says how dense its specimens are. "
                                  "Remove one of them.")

    def checked(self, value: float | str, what: str, scene: str) -> float:
        """A bound; the scene itself says whether it takes it."""
        try:
            number = self.of_scene(Scene(scene, set={self.key: shown(value)}))
        except _core.InputError as error:
            why = str(error).partition(f"{self.key} = {shown(value)}; ")[2] or str(error)
            raise self.refuse(f"{what} = {shown(value)}; {why}") from error
        return number or 0.0  # scenes leave out some keys that are 0

    def of_scene(self, scene: Scene) -> float | None:
        value = functools.reduce(lambda table, word: table.get(word, {}), self.key.split("."), scene.to_dict())
        if value == {}:
            return None
        self.unit = str(value).partition(" ")[2].replace("tan", "deg")
        return in_si(str(value))

    @property
    def label(self) -> str:
        """"contact.friction (deg)", with its curve or group if it has one."""
        return f"{self.key}{self.curve and ' of '}{self.curve} ({self.unit or '-'})"

    def value(self, share: float) -> float:
        """At a share, with seven digits, so that tables and scenes show what was run."""
        exact = self.low * (self.high / self.low) ** share if self.is_log else self.low + share * (self.high - self.low)
        return min(max(float(f"{exact:.6e}"), self.low), self.high)

    def share(self, value: float) -> float:
        if self.is_log:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def number(self, value: float) -> str:
        """As it is in a scene, without its unit."""
        return number_text(value, POWERS.get(self.unit, 0))

    def text(self, value: float) -> str:
        """As scenes and --set take it: "18.5 deg", "0.3"."""
        return f"{self.number(value)} {self.unit}".strip()


def shown(value: float | str) -> str:
    return value if isinstance(value, str) else number_text(value)


def direction(curve: Any) -> int:
    """Of the axial strain, compression positive."""
    return 1 if curve.direction == "compression" else -1


class SceneMaker:
    """Makes scenes as a user would who edits the scene of the plan.

    Raises InputError: the scene or a parameter is wrong; a curve that needs what the scene cannot give.
    """

    def __init__(self, plan: Any):
        self.plan = plan
        scene = Scene(pathlib.Path(plan.scene_path)).to_dict()
        if scene["specimen"].get("file"):
            raise _core.InputError(f"{plan.scene_path}: specimen.file = {scene['specimen']['file']}; must not be given "
                                   "because each trial prepares specimens of its own. Give "
                                   "specimen.preparation_friction or relative_density.")
        if scene["specimen"].get("consolidation", "isotropic") != "isotropic":
            raise _core.InputError(f"{plan.scene_path}: specimen.consolidation = {scene['specimen']['consolidation']}; "
                                   "must be isotropic, as the tests of the curves are.")
        scene["output"].pop("folder", None)
        self.grading, self.standard_pressure = scene["grading"], scene["specimen"]["pressure"]
        self.text = Scene(scene).text  # every key resolved
        self.parameters = [Parameter(plan, given, self.text) for given in plan.parameter]

    def pressure(self, curve: Any) -> float:
        """Before its test, Pa."""
        return in_si(curve.pressure or self.standard_pressure)

    def keys(self, values: list[float], curve: Any, grains: int) -> dict[str, Any]:
        """Keys of a scene that differ from the plan's; without a curve, those of all.

        The cloud's edge grows with the cube root of the number of grains, so that their size stays; where the scene
        gives d50, it does so by itself.
        """
        keys: dict[str, Any] = {"grading.grains": grains}
        if "d50" not in self.grading:
            edge = in_si(self.grading["cloud_edge"]) * math.cbrt(grains / self.grading["grains"])
            keys["grading.cloud_edge"] = f"{number_text(edge, -3)} mm"
        for parameter, value in zip(self.parameters, values):
            if concerns(parameter.given, curve) if curve else not parameter.curve:
                keys[parameter.key] = parameter.text(value)
        if curve:
            keys["specimen.pressure"] = curve.pressure or self.standard_pressure
            keys |= {f"specimen.{name}": vars(curve)[name] for name in DENSITIES if vars(curve)[name] is not None}
        return keys

    def end(self, curve: Any) -> float:
        """Of its stage: a logarithmic strain."""
        return curve.strain_end if curve.strains != "linear" else abs(math.log1p(-direction(curve) * curve.strain_end))

    def test(self, keys: dict[str, Any], curve: Any, title: str, output: dict[str, Any], **specimen: str) -> Scene:
        scene = Scene(self.text, set=keys).to_dict()
        kind = "drained" if curve.test == "drained" else "undrained-monotonic"
        return Scene(scene | {"title": title, "stage": [{"kind": kind, "direction": curve.direction, "strain": self.end(curve)}],
                              "output": scene["output"] | output, "specimen": scene["specimen"] | specimen})

    def trial(self, values: list[float], curve: Any, seed: int) -> Scene:
        """The test of a curve on a specimen of a trial.   Raises InputError"""
        keys = self.keys(values, curve, self.plan.specimens.grains) | {"grading.seed": seed}
        if self.plan.specimens.inertial_number:
            keys["motion.inertial_number"] = self.plan.specimens.inertial_number
        return self.test(keys, curve, f"{curve.name}, seed {seed}",
                         OF_A_RUN,
                         cache="../../specimens")  # one for all trials

    def full_test(self, values: list[float], curve: Any) -> Scene:
        """The same at full size, with the motion of the plan's scene."""
        keys = self.keys(values, curve, self.plan.specimens.full_grains)
        return self.test(keys, curve, f"{curve.name}, calibrated", {})

    def full_scene(self, values: list[float]) -> Scene:
        """The scene of the plan at full size, with the values that belong to all curves."""
        scene = Scene(self.text, set=self.keys(values, None, self.plan.specimens.full_grains)).to_dict()
        return Scene(scene | {"title": f"{scene['title']}, calibrated"})

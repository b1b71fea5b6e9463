# SPDX-License-Identifier: BSD-3-Clause
"""A number of the scene that is varied between bounds.   tested: tests/python/calibration_test.py"""
import functools
import math
import re
from typing import Any

from isostat import _core
from isostat.campaign.calibrate.keys import DENSITIES, number_text, unknown_text
from isostat.campaign.calibrate.plan import concerns
from isostat.campaign.scenes import POWERS, in_si
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

# SPDX-License-Identifier: BSD-3-Clause
"""From a plan and values of its parameters to scenes of element_test.   tested: tests/python/calibration_test.py"""
import math
import pathlib
from typing import Any

from isostat import _core
from isostat.campaign.calibrate.keys import DENSITIES, number_text
from isostat.campaign.calibrate.parameter import Parameter
from isostat.campaign.calibrate.plan import concerns
from isostat.campaign.scenes import OF_A_RUN, in_si
from isostat.scene import Scene


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

    def test(self, keys: dict[str, Any], curve: Any, title: str, output: dict[str, Any], **specimen: str) -> Scene:
        scene = Scene(self.text, set=keys).to_dict()
        end = curve.strain_end
        if curve.strains == "linear":
            end = abs(math.log1p(-direction(curve) * end))  # stages end at logarithmic strains
        kind = "drained" if curve.test == "drained" else "undrained-monotonic"
        return Scene(scene | {"title": title, "stage": [{"kind": kind, "direction": curve.direction, "strain": end}],
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

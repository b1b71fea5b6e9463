# SPDX-License-Identifier: BSD-3-Clause
"""What the files of an element test show: by what each stage ended, liquefaction, rate, density, reversals."""
import re

import numpy as np

from figures.column_results import quantity
from figures.common import LIQUEFIED
from figures.files import NOT_SHEARED

# From where on a test counts as fast, docs/guide/rate.md: inertial number, largest indicator.
FAST_INERTIA, FAST_INDICATOR = 1e-3, 0.2


def endings(results):
    """A line for each stage that shears, and for each other that its limit of steps ended: the first words of the
    summary on it."""
    stages = results.scene.get("stage", [])
    for end in results.numbers.get("ended", []):
        if end["early"] or stages[end["stage"]]["kind"] not in NOT_SHEARED:
            name, text, *_ = re.split(r": |, before |; ", end["text"])
            yield f"{name[0].upper()}{name[1:]}:", f"{text}.", "attention" if end["early"] else "good"


def liquefaction(results, run):
    undrained = [stage for stage in results.scene.get("stage", []) if stage["kind"].startswith("undrained")]
    if not undrained and results.numbers.get("liquefaction"):
        undrained = [stage for stage in results.scene["stage"] if stage["kind"] == "path"]
    if not undrained or not run.sheared:
        return
    event, ratio = results.numbers.get("liquefaction"), undrained[0].get("liquefaction_ratio", LIQUEFIED)
    if event:
        ratio = event.get("ratio", ratio)
        cycles = f"after {event['cycle']:g} cycles" if run.cyclic else "before its end"
        before = ""  # which summaries of older versions do not have
        if "IR_before" in event:
            before = f"in the row before {event['IR_before']:.3f} at p'/p0' = {event['p_ratio_before']:.3f}, "
        yield "Liquefied:", (f"p'/p0' fell below {ratio:g} {cycles}; I_R at the onset {event['IR_at_onset']:.3f}, "
                             f"{before}largest strain before it {100 * event['strain_before']:.3g} %."), "plain"
    else:
        yield "Not liquefied:", (f"p'/p0' never fell below {ratio:g}; its smallest value is "
                                 f"{np.nanmin(run.p_ratio):.3f}."), "plain"


def how_driven(scene, summary):
    """Whether the rate of the stages that shear was left to the control, or fixed; None if there is no such stage.
    @param summary  its text on the rate, which those of older runs do not have"""
    common = scene.get("motion", {}).get("strain_rate")
    rates = [stage.get("strain_rate", common) for stage in scene.get("stage", [])
             if "strain" in stage or "until" in stage]
    fixed = sorted(set(rates) - {None})
    if fixed:
        which = "not controlled" if None not in rates else "in some stages; in the others controlled"
        which += f": {summary}" if summary and None in rates else ""
        return f"fixed at {', '.join(fixed)}, {which}.", "plain"
    return (f"controlled, {summary}." if summary else "controlled.", "good") if rates else None


def rate(results):
    """How the stages that shear were driven, and how far from equilibrium that has brought the packing."""
    summary, eta = results.numbers.get("strain_rate"), results.numbers.get("max_indicator")
    if summary and results.scene.get("motion", {}).get("drive") == "static":
        yield "Rate:", f"{summary}.", "good"
        return
    driven = how_driven(results.scene, summary)
    if not driven:
        return
    text, kind = driven
    if eta is None:
        older = "" if "rows" in results.numbers else " Only the summary of this older run gives the rate."
        yield "Rate:", text + older, "plain"
        return
    fast = []
    if (results.numbers.get("inertial_number") or 0) > FAST_INERTIA:
        fast.append(f"I is above {FAST_INERTIA:g}")
    if eta > FAST_INDICATOR:
        fast.append(f"the indicator is above {FAST_INDICATOR:g}")
    text += f" The largest quasi-static indicator before liquefaction is {eta:.4f}"
    if fast:
        yield "Rate:", text + (f"; {' and '.join(fast)}, so the test counts as fast. Compare it with one at a tenth of "
                               "the rate."), "attention"
    else:
        yield "Rate:", f"{text}; above {FAST_INDICATOR:g} a test counts as fast.", kind


def tolerances(results):
    """Density and reversals against what the scene asks for."""
    specimen, numbers = results.scene.get("specimen", {}), results.numbers
    asked, reached = specimen.get("relative_density"), numbers.get("relative_density")
    if asked is not None and reached is not None and "density_tolerance" in specimen:
        held = abs(reached - asked) <= specimen["density_tolerance"]
        yield "Density:", (f"D_r = {reached:.3f}, requested {asked:g}; the tolerance of "
                           f"{specimen['density_tolerance']:g} {'held' if held else 'did not hold'}."), (
                               "good" if held else "attention")
    amplitudes = [quantity(stage["deviator_amplitude"]) for stage in results.scene.get("stage", [])
                  if "deviator_amplitude" in stage]
    if numbers.get("CSR"):
        amplitudes.append(numbers["CSR"] * numbers["sigma_v0"])
    if amplitudes and numbers.get("reversals"):
        over = numbers["worst_overshoot"]
        yield "Reversals:", (f"{numbers['reversals']}; the worst overshoot is {over / 1e3:.3g} kPa, "
                             f"{100 * over / max(amplitudes):.2g} % of the amplitude."), "plain"
    if numbers.get("energy_residual") is not None:
        residual = numbers["energy_residual"]
        yield "Energy:", f"the residual of the balance is {residual:.1e} of the work exchanged.", "plain"


def lines(results, run):
    """(name, sentence, kind) of each verdict.   @param run  figures.common.Run, or None"""
    liquefied = liquefaction(results, run) if run is not None else ()
    return [*endings(results), *liquefied, *rate(results), *tolerances(results)]

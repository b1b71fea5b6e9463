# SPDX-License-Identifier: BSD-3-Clause
"""What the files of an element test show: by what each stage ended, liquefaction, rate, density, reversals."""
import numpy as np

from figures.common import LIQUEFIED
from figures.column_results import quantity

SERVO = ("compress", "rebalance", "hold", "k0-compress")
REACHED = 1 - 1e-6  # of a strain: rows have ten digits
# From where on a test counts as fast, docs/guide/rate.md: inertial number, largest indicator.
FAST_INERTIA, FAST_INDICATOR = 1e-3, 0.2


def stage_rows(run, number):
    """Rows of a stage of the scene, of one that is repeated the last time, as a slice, and how often it was done; None
    if it left no rows."""
    rows, times = np.flatnonzero(run.whole["stage"] == number), 1
    if rows.size and "done" in run.whole:
        done = run.whole["done"][rows]
        rows, times = rows[done == done[-1]], len(np.unique(done))
    return (slice(rows[0], rows[-1] + 1), times) if rows.size else None


def steps_of(run, rows):
    """Time steps of a stage: to its last row, from the last one of the stage before."""
    before = run.whole["step"][rows.start - 1] if rows.start > 0 else 0
    return run.whole["step"][rows.stop - 1] - before


def strain_of(stage, run, rows):
    """The strain that ends the stage, as an amount."""
    name = "gamma_xy" if stage["kind"].endswith("simple-shear") or stage.get("drive") == "xy" else "eps_y"
    return abs(run.whole[name][rows.stop - 1]), "gamma" if name == "gamma_xy" else "axial strain"


def cyclic_end(stage, run, rows):
    """By which of its conditions a cyclic stage ended, or None."""
    until, reversals = stage["until"], run.whole["reversals"]
    last = reversals[rows.stop - 1]
    liquefied = np.flatnonzero(run.whole["liquefied"] > 0)
    if liquefied.size and last - reversals[liquefied[0]] >= until["reversals_after_liquefaction"]:
        return f"{until['reversals_after_liquefaction']} reversals after liquefaction"
    if last >= 2 * until["cycles"]:
        return f"{until['cycles']} cycles"
    strain, name = strain_of(stage, run, rows)
    return f"{name} of {100 * until['strain']:g} %" if strain >= REACHED * until["strain"] else None


def path_end(stage, run, rows):
    """By which of its conditions a path ended, as far as columns show; it has no other end but its limit of steps."""
    if stage["drive"] == "none":
        return "its path and balance"
    until = stage.get("until", {})
    return f"the first of {', '.join(until)}" if until else None


def shear_end(stage, run, rows):
    """What a stage that shears reached, or None if that was not its target."""
    if stage["kind"] == "path":
        return None if limit_reached(stage, run, rows) else path_end(stage, run, rows)
    if "until" in stage:
        return cyclic_end(stage, run, rows)
    strain, name = strain_of(stage, run, rows)
    return f"{name} of {100 * stage['strain']:g} %" if strain >= REACHED * stage["strain"] else None


def limit_reached(stage, run, rows):
    return stage.get("max_steps", 0) > 0 and steps_of(run, rows) + 1 >= stage["max_steps"]


def early_endings(results):
    """A line for each stage that its limit of steps ended, or that had nothing to do, as in the summary."""
    for end in results.numbers.get("ended_early", []):
        name, _, text = end["text"].partition(": ")
        yield f"{name[0].upper()}{name[1:]}:", f"{text}.", "attention"


def endings(results, run):
    """A line for each stage that shears, and for each other one that its limit of steps ended."""
    told = {(end["stage"], end["times"]) for end in results.numbers.get("ended_early", [])}
    for number, stage in enumerate(results.scene.get("stage", [])):
        rows, times = stage_rows(run, number) or (None, 0)
        if rows is None or (number, times) in told:
            continue
        name, limited = f"Stage {number}, {stage['kind']}:", limit_reached(stage, run, rows)
        if times > 1:
            name = f"Stage {number}, {stage['kind']}, the last of {times} times:"
        if stage["kind"] in SERVO:
            if limited:
                yield name, f"ended by its limit of {stage['max_steps']} time steps, not by its balance.", "attention"
            continue
        target = shear_end(stage, run, rows)
        if target:
            yield name, f"ended at its target, {target}.", "good"
        elif limited:
            strain, what = strain_of(stage, run, rows)
            yield name, (f"ended by its limit of {stage['max_steps']} time steps at {what} = {100 * strain:.4g} %, "
                         "before its target."), "attention"


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
    found = []
    if run is not None:
        found += [*endings(results, run), *early_endings(results), *liquefaction(results, run)]
    return [*found, *rate(results), *tolerances(results)]

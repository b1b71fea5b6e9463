# SPDX-License-Identifier: BSD-3-Clause
"""What the files of a run show: how it ended, whether it liquefied, what held. Nothing is concluded that
the files do not say; where they are silent, there is no line."""
import dataclasses

from figures.column_soil import LIQUEFIED_RU

from . import element_test_verdicts

GOOD, PLAIN, ATTENTION = "good", "plain", "attention"


@dataclasses.dataclass
class Verdict:
    """A heading of one or two words, a sentence, and whether it is good news, none, or asks for attention."""

    name: str
    text: str
    kind: str = PLAIN


def element_test(results, run):
    return [Verdict(*line) for line in element_test_verdicts.lines(results, run)]


def soil_column(results, _column):
    s = results.numbers
    dynamic = s.get("analysis") == "dynamic"
    found = [Verdict("Ended", f"at its target, the end time of the scene, after {s['steps']} steps.", GOOD)]
    if dynamic and (s.get("max_ru") or 0) >= LIQUEFIED_RU:
        found.append(Verdict("Liquefied:", f"r_u reached {s['max_ru']:.3f} at a depth of {s['max_ru_depth']:.2f} m, "
                             f"t = {s['max_ru_time']:.4g} s."))
    elif dynamic and (s.get("max_ru") or 0) > 0:
        found.append(Verdict("Not liquefied:", f"the largest r_u is {s['max_ru']:.3f}, at a depth of "
                             f"{s['max_ru_depth']:.2f} m; {LIQUEFIED_RU} counts as liquefied here."))
    if s.get("min_redundancy") is not None:
        side = "below" if s["min_redundancy"] < 1 else "not below"
        found.append(Verdict("Redundancy:", f"the smallest I_R is {s['min_redundancy']:.3f}, {side} 1, at a depth of "
                             f"{s['min_redundancy_depth']:.2f} m, t = {s['min_redundancy_time']:.4g} s."))
    if dynamic and s.get("relative_energy_residual") is not None:
        found.append(Verdict("Energy:", f"the residual of the balance is {s['relative_energy_residual']:.1e} of the "
                             "largest energy."))
    if s.get("degree_of_consolidation") is not None:
        found.append(Verdict("Consolidation:", f"{100 * s['degree_of_consolidation']:.2f} % of the final settlement."))
    return found


def biaxial(results, _block):
    s = results.numbers
    if s["complete"]:
        ended = Verdict("Ended", f"at its target, an axial strain of {100 * s['axial_strain']:.4g} %.", GOOD)
    else:
        ended = Verdict("Stopped", f"at an axial strain of {100 * s['axial_strain']:.4g} %, before its target: "
                        f"{s['failure']}", ATTENTION)
    effort = f"{s['iterations']} iterations in {s['steps']} steps; {s['substeps']} sub-steps, {s['rejected']} rejected."
    return [ended, Verdict("Equilibrium:", effort), Verdict("Shear strain:", "90 % quantile of the points over their "
                                                       f"median: {s['localisation']:.3g}; uniform is 1.")]


def rve_replay(results, _replay):
    s = results.numbers
    if s["equal"] == s["increments"]:
        return [Verdict("Same:", f"the stress of the column bit for bit in all {s['increments']} increments.", GOOD)]
    return [Verdict("Different:", f"the stress of the column bit for bit in {s['equal']} of {s['increments']} "
                    f"increments; rms difference {100 * s['shear_error']:.3g} % of tau.")]


def resistance(results, campaign):
    status = [run[3] for run in campaign.runs] if campaign else []
    counts = [f"{status.count(word)} {text}" for word, text in (
        ("liquefied", "liquefied"), ("censored", "did not liquefy within their cycles"),
        ("strain", "reached the strain limit before"), ("failed", "failed"), ("missing", "have not ended"))
        if word in status]
    found = []
    if counts:
        bad = "failed" in status or "missing" in status
        found.append(Verdict("Runs:", f"of {len(status)}, " + ", ".join(counts) + ".", ATTENTION if bad else GOOD))
    fit = results.numbers["fit"]
    if not fit:
        return found + [Verdict("No fit:", "fewer than two ratios have a run that liquefied.", ATTENTION)]
    left = f"; {fit['left_out']} that did not liquefy are left out" if fit["left_out"] else ""
    return found + [Verdict("Fit:", f"CSR = {fit['a']:.4f} N^-{fit['b']:.3f} by {fit['runs']} runs{left}. CSR at 15 "
                            f"cycles: {fit['CSR_15']:.4f}.")]


def soil_test(results, _test):
    s = results.numbers
    if s["CRR_15"] is None:
        return [Verdict("Does not liquefy:", "shear builds up no pore pressure that would.")]
    target = f", {100 * (s['CRR_15'] / s['CRR_of_scene'] - 1):+.1f} % of that of the scene" if s["CRR_of_scene"] else ""
    return [Verdict("Resistance:", f"CRR = {s['CRR_15']:.3f} at 15 cycles{target}; exponent b = {s['b']:.2f}.")]


def calibrate(results, _calibration):
    s = results.numbers
    found = [Verdict("Ended", f"because {s['ending']}."),
             Verdict("Misfit:", f"{s['misfit_start']:.4f} at the start, {s['misfit_best']:.4f} at the best set, trial "
                     f"{s['best']} of {s['trials']}.")]
    for parameter in s["parameters"]:
        if parameter["bound"]:
            found.append(Verdict(f"{parameter['label']}:", f"{parameter['best']}, "
                                 f"{parameter['bound'].strip().lower()}: the best value may lie beyond it.", ATTENTION))
    for curve in s["curves"]:
        if curve["failure"]:
            found.append(Verdict(f"{curve['name']}:", f"a run of the best set failed: {curve['failure']}", ATTENTION))
    return found


def micromechanics(results, _analysis):
    s = results.numbers
    if s["onset"] is None:
        return [Verdict("Not liquefied:", f"none of {s['snapshots']} snapshots has p'/p0' below the ratio of "
                        "liquefaction.")]
    return [Verdict("Liquefied:", f"first in snapshot {s['onset']} of 0 to {s['snapshots'] - 1}.")]


def column_ensemble(results, _ensemble):
    s = results.numbers
    found = [Verdict("Members:", f"{s['members']} of {s['asked']} have finished.",
                     GOOD if s["members"] == s["asked"] else ATTENTION)]
    thickness = s["numbers"].get("liquefied_thickness")
    if thickness and thickness["max"] == 0:
        found.append(Verdict("Not liquefied:", f"r_u stays below {s['liquefied_ru']} in all members (largest "
                             f"{s['numbers']['max_ru']['max']:.3g})."))
    elif thickness and thickness["n"] > 1:
        found.append(Verdict("Liquefied:", f"a thickness of {thickness['mean']:.3g} m, standard error "
                             f"{thickness['standard_error']:.2g} m, had r_u above {s['liquefied_ru']}; the members "
                             f"range from {thickness['min']:.3g} to {thickness['max']:.3g} m."))
    return found


OF_PROGRAM = {judge.__name__: judge for judge in (element_test, soil_column, biaxial, rve_replay,
                                                  resistance, soil_test, calibrate, micromechanics, column_ensemble)}


def of_run(results, drawn):
    """Verdicts on a run.   @param drawn  what its figures are drawn from, or None"""
    if results.numbers is None:
        return [Verdict("Not finished:", "there is no summary yet. The run is under way, was interrupted, or "
                        "failed with a message on its terminal; what follows is what it has so far.", ATTENTION)]
    return OF_PROGRAM[results.program](results, drawn)

# SPDX-License-Identifier: BSD-3-Clause
"""Draws the figures of a run from its history.csv and summary.json.

    python3 -m figures element_test RESULTS

Stresses and strains are positive in compression. Cyclic tests are drawn against the number of cycles: reversals count
half a cycle each, the first one too, and between two the strain, which runs one way there, says how far it has come.
Monotonic tests are drawn against axial strain, tests without a shear stage against the time step and without a stress
path. In simple shear the strain is gamma. If a cyclic test has fewer cycles
after the onset of liquefaction than before, they get half of the x axis, and its label says so. A column that is
missing costs its curve or panel, with a note.
"""
import numpy as np

from .common import (BLACK, BLUE, FLOOR, GREEN, GREY, ORANGE, Run, curves, draw_path, explain_median, index_label,
                          legend_above, legend_of_path, letters, mark_level, mark_onset, note, plt, two_rows)
from .drawing import Drawing, draws
from .dilatancy import dilatancy
from .simple_shear import rotation, shear_path

FULL = 6  # constraints of a contact as Eq. (2) counts them
NEAR_LIQUEFACTION = 0.1  # p'/p0' that has to be passed for a logarithmic axis


@draws("fig_stress_path", {"triaxial": "(a) q against p', (b) q against axial strain",
                           "drained triaxial": "(c) volumetric strain against axial strain",
                           "simple shear": "tau against (a) sigma'_v, (b) p', (c) gamma"})
def stress_path(run):
    if not run.sheared:
        return None
    if run.shear:
        return shear_path(run)
    n = 3 if run.drained else 2
    figure, (left, right, *volume) = plt.subplots(1, n, figsize=(3.6 * n, 3.3), layout="constrained")
    p, q = run["p"] / 1e3, run["q"] / 1e3
    for axes, x in ((left, p), (right, 100 * run.strain)):
        draw_path(run, axes, x, q)
        axes.set_ylabel(r"Deviatoric stress $q$ (kPa)")
    left.set(xlim=(min(0.0, float(np.nanmin(p))), None), xlabel=r"Mean effective stress $p^\prime$ (kPa)")
    right.set_xlabel(run.strain_label)
    if run.cyclic:
        right.axvline(0, color=BLACK, linewidth=0.6, zorder=1.4)
    letters([left, right, *volume])
    for axes in volume:
        draw_path(run, axes, 100 * run.strain, 100 * (run["eps_x"] + run["eps_y"] + run["eps_z"]))
        axes.set(xlabel=run.strain_label, ylabel=r"Volumetric strain $\varepsilon_v$ (%)")
    legend_of_path(run, figure, left)
    return figure


def draw_pressure(run, axes):
    """p'/p0', over the decades that a liquefying specimen goes through; else from zero. Of what is not sheared p'."""
    if not run.sheared:
        axes.plot(run.progress, run["p"] / 1e3, color=BLACK, linewidth=0.9)
        axes.set(ylabel=r"$p^\prime$ (kPa)", ylim=(0, None))
        return
    ratio = np.clip(run.p_ratio, FLOOR, None)
    axes.plot(run.progress, ratio, color=BLACK, linewidth=0.9)
    axes.set_ylabel(r"$p^\prime/p_0^\prime$")
    top, lowest = max(1.0, float(np.nanmax(ratio))), float(np.nanmin(run.p_ratio))
    if lowest > NEAR_LIQUEFACTION:
        axes.set_ylim(0, 1.1 * top)
        return
    axes.set_yscale("log")
    level = run.liquefied_ratio
    axes.set_ylim(FLOOR if lowest < level else level / 2, 1.5 * top)
    mark_level(axes, level, f"${level:g}$")
    if lowest < FLOOR:
        axes.annotate(r"values below $10^{-4}$ lie on the axis", (0.01, 0.05), xycoords="axes fraction", fontsize=7.5,
                      color=GREY)


@draws("fig_redundancy")
def redundancy(run):
    """(a) redundancy index I_R of the contact law, in which 1 is isostatic, next to other counts, (b) p'/p0', of a test
    without a shear stage p'."""
    if not run.has("IR"):
        return None
    figure, (top, bottom) = two_rows(run, (1.25, 1))
    constraints = run["IR_constraints"] if run.has("IR_constraints") else FULL
    own = index_label(constraints)
    thin = [("IR_eq2", "Eq. (2)", {"color": GREY, "linewidth": 0.7})] if np.any(constraints < FULL) else [
        ("IR_no_twist", "without twisting", {"color": ORANGE, "linewidth": 0.7}),
        ("IR_sliding", "sliding only", {"color": GREEN, "linewidth": 0.7})]
    curves(run, top, [("IR", own, {"color": BLUE, "zorder": 3}), *thin])
    top.set(ylim=(0, None), ylabel=r"Redundancy index $I_R$")
    mark_level(top, 1.0, "isostatic\n$I_R = 1$")
    if run.sheared and np.all(constraints == FULL):
        mark_level(top, 0.35, "$0.35$")  # of full liquefaction, in Eq. (2)

    draw_pressure(run, bottom)
    mark_onset(run, (top, bottom))
    legend_above(top)
    return figure


def explained(run, top, bottom):
    """The figure of two panels with what pales after the onset, and their legends."""
    mark_onset(run, (top, bottom))
    explain_median(run, bottom)
    legend_above(top)
    legend_above(bottom)
    return top.figure


@draws("fig_contact_fractions")
def contact_fractions(run):
    """(a) yielding contacts: sliding, rolling, both; (b) contacts that do not yield."""
    if not any(run.has(name) for name in ("f_S", "f_R", "f_SR", "f_NSR")):
        return None
    _, (top, bottom) = two_rows(run, (1.6, 1))
    curves(run, top, [("f_S", "sliding (S)", {"color": BLUE}), ("f_SR", "both (SR)", {"color": GREEN}),
                      ("f_R", "rolling (R)", {"color": ORANGE})], steady=True)
    curves(run, bottom, [("f_NSR", "neither (NSR)", {"color": BLACK})], steady=True)
    top.set_ylim(0, min(1.02, top.get_ylim()[1]))
    bottom.set_ylim(0, 1.02)
    for axes in (top, bottom):
        axes.set_ylabel("Fraction of contacts")
    return explained(run, top, bottom)


@draws("fig_fabric")
def fabric(run):
    """(a) Fxx, Fyy, Fzz, (b) F[y-x], F[y-z]."""
    if not any(run.has(name) for name in ("Fxx", "Fyy", "Fzz", "F_yx", "F_yz")):
        return None
    _, (top, bottom) = two_rows(run)
    along_y = "vertical" if run.shear else "axial"
    curves(run, top, [("Fyy", rf"$F_{{yy}}$ ({along_y})", {"color": BLUE, "zorder": 3}),
                      ("Fxx", r"$F_{xx}$", {"color": ORANGE}),
                      ("Fzz", r"$F_{zz}$", {"color": GREEN, "linewidth": 0.7})], steady=True)
    curves(run, bottom, [("F_yx", r"$F_{[y-x]}$", {"color": ORANGE}),
                         ("F_yz", r"$F_{[y-z]}$", {"color": GREEN, "linewidth": 0.7})], steady=True)
    mark_level(top, 1 / 3, "isotropic\n$1/3$")
    mark_level(bottom, 0.0, "$0$")
    top.set_ylabel("Contact-normal fabric")
    bottom.set_ylabel("Fabric anisotropy")
    return explained(run, top, bottom)


def undrawn(name, run):
    # of simple shear, of drained stages, of stages that shear alone
    meant = {"fig_principal_stress": run.shear, "fig_dilatancy": False, "fig_stress_path": run.sheared}
    if meant.get(name, True):
        note(f"{name}: none of its columns is there; not drawn")


def kinds(run):
    """Whose parts of captions fit the test."""
    if run.shear:
        return {"simple shear"}
    return {"triaxial", "drained triaxial"} if run.drained else {"triaxial"}


DRAWING = Drawing(Run, [stress_path, dilatancy, redundancy, contact_fractions, fabric, rotation], undrawn, kinds)

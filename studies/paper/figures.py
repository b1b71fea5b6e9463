# SPDX-License-Identifier: BSD-3-Clause
"""Draws the committed tables, nothing else: each figure from the CSV files of one folder."""
import numpy as np

from isostat.figures.common import legend_below
from studies.drawing import (BLUE, GREEN, GREY, ORANGE, RED, STYLE, Table, band, bands, of_tables, panels,
                             plain_logarithm, save)
from studies.paper import lab, plan, states

DENSITIES = dict(zip(plan.PAPER, (RED, GREEN, BLUE)))
PRIME = r"$p^\prime$"
PACE_NAMES = {plan.DEFAULT: "rate of the default", plan.SLOW: "a tenth of the default's rate"}


def draw(folder):
    for name, function in FIGURES.items():
        if all((folder / f"{table}.csv").exists() for table in function.tables):
            figure = function(Table(folder / f"{function.tables[0]}.csv"), folder)
            if figure is not None:
                figure.set_dpi(STYLE["savefig.dpi"])
                figure.draw_without_rendering()  # so that ticks are those that savefig lays out
                save(figure, folder / f"{name}.png")
                print(folder / f"{name}.png")


@of_tables("undrained_curves")
def monotonic(table, _):
    """Figure 1: effective stress paths and stress-strain curves, next to laboratory anchors."""
    figure, ((path, curve),) = panels(1, 2, height=3.9)
    for density, colour in DENSITIES.items():
        for direction, sign in (("compression", 1), ("extension", -1)):
            rows = table.where(**{"specimen": f"D_r {density:.2f}, 200 kPa", "test": direction})
            if not rows:
                continue
            label = f"$D_r$ = {density:.2f}" if sign > 0 else None
            p, q, strain = rows["p' (kPa)"], sign * rows["q (kPa)"], sign * rows["|eps_1| (%)"]
            path.plot(p, q, color=colour, linewidth=1.1, label=label)
            band(curve, strain, q, rows["q (kPa) s.d."], colour)
    for anchor in lab.undrained_anchors():
        colour = dict(zip(("loose", "medium", "dense"), DENSITIES.values()))[anchor["density"]]
        marker = "s" if anchor["state"] == "instability" else "o"
        if np.isfinite(anchor["q (kPa)"]):
            path.plot(anchor["p' (kPa)"], anchor["q (kPa)"], marker, color=colour, markersize=5, mec="black", zorder=5)
            curve.plot(anchor["eps_1 (%)"], anchor["q (kPa)"], marker, color=colour, markersize=5, mec="black",
                       zorder=5)
        else:
            path.plot(anchor["p' (kPa)"], -342, "^", color=colour, markersize=5, mec="black", zorder=5)
    for panel in (path, curve):
        panel.axhline(0, color="black", linewidth=0.6)
        panel.set(ylim=(-350, 450), ylabel="Deviatoric stress $q$ (kPa)")
    path.set(xlim=(0, 500), xlabel=f"Mean effective stress {PRIME} (kPa)")
    curve.set(xlim=(-5, 5), xlabel=r"Axial strain $\varepsilon_1$ (%)")
    for marker, text in (("s", "laboratory, instability"), ("o", f"laboratory, least {PRIME}"),
                         ("^", f"laboratory, least {PRIME} in extension ($q$ not read)")):
        path.plot([], [], marker, color="white", mec="black", markersize=5, label=text)
    legend_below(figure, path, 0.12, 3)
    return figure


@of_tables("undrained_curves")
def dense(table, _):
    """Why dense packings reach megapascals at constant volume: the same test with softer contacts."""
    figure, ((stress, ratio),) = panels(1, 2)
    for young, colour in ((10, BLUE), (1, GREEN), (0.1, ORANGE)):
        label = f"D_r {plan.PAPER[2]:.2f}, 200 kPa" + ("" if young == 10 else f", E {young:g} GPa")
        rows = table.where(**{"specimen": label, "test": "compression"})
        if rows:
            band(stress, rows["|eps_1| (%)"], rows["q (kPa)"] / 1e3, rows["q (kPa) s.d."] / 1e3, colour,
                 f"$E$ = {young:g} GPa")
            ratio.plot(rows["|eps_1| (%)"], rows["q (kPa)"] / rows["p' (kPa)"], color=colour, linewidth=1.1)
    stress.set(ylabel="Deviatoric stress $q$ (MPa)", yscale="log", ylim=(1e-2, None))
    ratio.set_ylabel(f"$q$/{PRIME}")
    for panel in (stress, ratio):
        panel.set_xlabel(r"Axial strain $\varepsilon_1$ (%)")
    stress.legend()
    return figure


@of_tables("cyclic_tests")
def cycles(table, _):
    """Figure 2 as an ensemble: cycles to liquefaction against void ratio, at the amplitude of the paper."""
    figure, ((panel, strains),) = panels(1, 2)
    for label in table.values("specimen"):
        rows = table.where(specimen=label, pace=plan.DEFAULT)
        colour, marker = (GREEN, "s") if "cell" in label else (RED, "D") if label.startswith("D_r") else (BLUE, "o")
        number, applied = rows["cycles"], rows["cycles applied"]
        panel.plot(rows["e"], number, marker, color=colour, markersize=4)
        panel.plot(rows["e"][np.isnan(number)], applied[np.isnan(number)], "^", color=colour, markersize=5, mfc="none")
    panel.axhline(17, color=GREY, linewidth=0.9, linestyle="--")
    panel.axhline(11, color=GREY, linewidth=0.9, linestyle=":")
    plain_logarithm(panel.yaxis)
    panel.locator_params(axis="x", nbins=5)
    panel.set(xlabel="Void ratio $e$", ylabel=f"Cycles to {PRIME}/$p_0^\\prime$ < 0.01")
    for marker, colour, text in (("^", RED, "$D_r$ = 0.64, not liquefied"), ("o", BLUE, "7° to 11°"),
                                 ("^", BLUE, "7° to 11°, not liquefied"), ("s", GREEN, "no walls")):
        panel.plot([], [], marker, color=colour, markersize=4, label=text, mfc="none" if marker == "^" else colour)
    panel.plot([], [], "--", color=GREY, label="paper: 17")
    panel.plot([], [], ":", color=GREY, label="laboratory: 11")
    legend_below(figure, panel, 0.13, 3)
    rows = table.where(pace=plan.SLOW)
    strains.plot(*(rows[f"largest strain after, {side} (%)"] for side in ("compression", "extension")), "o", color=BLUE,
                 markersize=4)
    high = max(1.0, np.nanmax(strains.dataLim.max))
    strains.plot([0, high], [0, high], color=GREY, linewidth=0.8)
    strains.set_xlabel(r"Largest $\varepsilon_1$ after the onset, compression (%)")
    strains.set_ylabel("Largest $\\varepsilon_1$ after the onset,\nextension (%)")
    return figure


def densest_liquefying(table):
    """Rows of the preparation with the most seeds that liquefy; the densest of those."""
    labels = [label for label in table.values("specimen") if "deg" in label]
    most = max((table.where(specimen=label)["seeds"][0] for label in labels), default=0)
    fitting = [label for label in labels if table.where(specimen=label)["seeds"][0] == most]
    return table.where(specimen=min(fitting, key=lambda label: float(label.split()[0]), default=None))


def title_of(rows):
    return (f"{rows.rows[0]['specimen']}, {PACE_NAMES[rows.rows[0]['pace']]}, n = {rows['seeds'][0]:.0f} seeds\n"
            f"Bands: range within the cycles to the onset, standard deviation behind it")


def phase_axis(axes, rows):
    last = int(np.ceil(rows["phase"][-1]))
    for panel in axes:
        panel.axvline(1, color=RED, linewidth=0.9, linestyle=":")
        panel.set_xlim(0, last)
        panel.set_xticks(range(last + 1), ["0", "onset", "reversal", *[f"{k}" for k in range(1, last - 1)]])
    axes[-1].set_xlabel("Share of the half cycles to the onset; on to the next reversal; whole half cycles, the first "
                        "towards compression")


@of_tables("cyclic_curves")
def redundancy(table, _):
    """Figure 3: redundancy index and contact fractions, mean and standard deviation over seeds."""
    rows = densest_liquefying(table)
    if not rows:
        return None
    figure, axes = panels(3, 1, height=6.2, sharex=True)
    index, ratio, fractions = axes[:, 0]
    counts = {name: text for name, text in states.COUNTS.items() if name != "IR_walls"}
    bands(index, rows, zip(counts, (BLUE, ORANGE, GREEN), counts.values()))
    for level in (1, 0.35):
        index.axhline(level, color=GREY, linewidth=0.8, linestyle="--")
    index.set_ylabel("Redundancy index $I_R$")
    bands(ratio, rows, [("p'/p0'", "black", None)])
    ratio.axhline(0.01, color=GREY, linewidth=0.8, linestyle="--")
    ratio.set(yscale="log", ylabel=f"{PRIME}/$p_0^\\prime$")
    bands(fractions, rows, (("f_S", BLUE, "sliding"), ("f_SR", GREEN, "both"), ("f_R", ORANGE, "rolling")))
    fractions.set_ylabel("Fraction of contacts")
    index.legend(ncols=4, loc="upper right")
    fractions.set_ylim(0, 0.85)
    fractions.legend(ncols=3, loc="upper left")
    phase_axis(axes[:, 0], rows)
    figure.suptitle(title_of(rows), fontsize=8)
    return figure


@of_tables("cyclic_curves")
def fabric(table, _):
    """Figure 4: fabric and its anisotropy, where enough contacts carry."""
    rows = densest_liquefying(table)
    if not rows:
        return None
    figure, axes = panels(2, 1, height=4.6, sharex=True)
    normals, anisotropy = axes[:, 0]
    bands(normals, rows, (("Fyy", BLUE, "$F_{yy}$"), ("Fxx", ORANGE, "$F_{xx}$"), ("Fzz", GREEN, "$F_{zz}$")))
    bands(anisotropy, rows, (("F_yx", ORANGE, "$F_{[y-x]}$"), ("F_yz", GREEN, "$F_{[y-z]}$")))
    normals.axhline(1 / 3, color=GREY, linewidth=0.8, linestyle="--")
    anisotropy.axhline(0, color=GREY, linewidth=0.8, linestyle="--")
    normals.set_ylabel("Contact-normal fabric")
    anisotropy.set_ylabel("Fabric anisotropy")
    normals.legend(ncols=3, loc="upper left")
    anisotropy.legend(ncols=2, loc="upper left")
    phase_axis([normals, anisotropy], rows)
    figure.suptitle(title_of(rows), fontsize=8)
    return figure


@of_tables("half_cycles")
def anisotropy(table, _):
    """The paper's conclusion: anisotropy at the end of a half cycle against the strain of that half cycle."""
    figure, ((against, numbers),) = panels(1, 2, sharey=True)
    for direction, colour in (("compression", BLUE), ("extension", ORANGE)):
        part = table.where(direction=direction)
        for panel, x in ((against, "strain travelled (%)"), (numbers, "half cycle")):
            panel.plot(part[x], np.abs(part["F_yx at its end"]), "o", color=colour, markersize=3, label=direction)
    against.set_xlabel(r"Axial strain $|\Delta\varepsilon_1|$ of the half cycle (%)")
    numbers.set_xlabel("Number of the half cycle after the onset")
    against.set_ylabel("$|F_{[y-x]}|$ at its end")
    legend_below(figure, against, 0.13, 2)
    return figure


@of_tables("drained_curves")
def drained(table, _):
    """Drained tests at 200 kPa next to the laboratory."""
    figure, (axes,) = panels(1, 2)
    tests = {test.name: test for test in lab.drained_tests()}
    for (density, name), colour in zip(plan.LABORATORY.items(), (RED, GREEN, BLUE)):
        rows = table.where(specimen=f"D_r {density:.2f}, {plan.P0} kPa")
        test = tests[name]
        for panel, column, curve in zip(axes, ("q (kPa)", "eps_v (%)"),
                                        ((test.axial - test.radial) / 1e3, 100 * test.volume_strain)):
            if rows:
                band(panel, rows["|eps_1| (%)"], rows[column], rows[f"{column} s.d."], colour)
            panel.plot(100 * test.strain, curve, "--", color=colour, linewidth=0.9)
            panel.set(xlabel=r"Axial strain $\varepsilon_1$ (%)", xlim=(0, 15))
        axes[0].plot([], [], color=colour, label=f"$D_r$ = {density:.2f}")
    axes[0].set_ylabel("Deviatoric stress $q$ (kPa)")
    axes[1].set_ylabel(r"Volumetric strain $\varepsilon_v$ (%)")
    axes[0].plot([], [], "--", color=GREY, label="laboratory (Wichtmann and Triantafyllidis 2016)")
    legend_below(figure, axes[0], 0.1, 4)
    return figure


@of_tables("cyclic_path")
def path(table, _):
    """Figure 2 as the paper draws it, of one specimen."""
    figure, ((stress, strain),) = panels(1, 2, sharey=True)
    stress.plot(table["p' (kPa)"], table["q (kPa)"], color=BLUE, linewidth=0.6)
    strain.plot(table["eps_1 (%)"], table["q (kPa)"], color=BLUE, linewidth=0.6)
    stress.set(xlabel=f"Mean effective stress {PRIME} (kPa)", ylabel="Deviatoric stress $q$ (kPa)")
    strain.set_xlabel(r"Axial strain $\varepsilon_1$ (%)")
    first = table.rows[0]
    figure.suptitle(f"{first['specimen']}, seed {first['seed']}, {PACE_NAMES[first['pace']]}: one specimen", fontsize=9)
    return figure


FIGURES = {"figure_1": monotonic, "dense": dense, "figure_2": cycles, "figure_2_path": path, "figure_3": redundancy,
           "figure_4": fabric, "anisotropy": anisotropy,
           "drained": drained}

# SPDX-License-Identifier: BSD-3-Clause
"""Draws the committed tables, nothing else: each figure from the CSV files of one folder."""
import numpy as np

from isostat.figures.common import legend_below
from studies.drawing import (BLUE, GREEN, GREY, ORANGE, RED, STYLE, Table, band, bands, of_tables, panels,
                             plain_logarithm, save)
from studies.paper import lab, plan, states
from studies.paper.resistance import REFERENCE, fitted_ratios

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
            rows = table.where(**{"specimen": f"D_r {density:.2f}, 200 kPa", "test": direction, "slow": "False"})
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
        rows = table.where(**{"specimen": label, "test": "compression", "slow": "False"})
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
    table = table.where(**{"p0' (kPa)": "200", "q_amp/(2 p0')": plan.PAPER_RATIO})
    after, table = table, table.where(pace=plan.DEFAULT)
    for label in table.values("specimen"):
        rows = table.where(specimen=label)
        paper = label.startswith("D_r")
        colour, marker = (RED, "D") if paper else (BLUE, "o")
        number, applied = rows["cycles"], rows["cycles applied"]
        panel.plot(rows["e"], number, marker, color=colour, markersize=4)
        panel.plot(rows["e"][np.isnan(number)], applied[np.isnan(number)], "^", color=colour, markersize=5, mfc="none")
    panel.axhline(17, color=GREY, linewidth=0.9, linestyle="--")
    panel.axhline(11, color=GREY, linewidth=0.9, linestyle=":")
    plain_logarithm(panel.yaxis)
    panel.set(xlabel="Void ratio $e$", ylabel=f"Cycles to {PRIME}/$p_0^\\prime$ < 0.01")
    for marker, colour, text in (("^", RED, "$D_r$ = 0.64, not liquefied when the test ended"),
                                 ("o", BLUE, "5° to 11°"),
                                 ("^", BLUE, "5° to 11°, not liquefied")):
        panel.plot([], [], marker, color=colour, markersize=4, label=text, mfc="none" if marker == "^" else colour)
    panel.plot([], [], "--", color=GREY, label="paper: 17")
    panel.plot([], [], ":", color=GREY, label="laboratory: 11")
    legend_below(figure, panel, 0.13, 3)
    for pace, face in ((plan.DEFAULT, "none"), (plan.SLOW, BLUE)):
        rows = after.where(pace=pace)
        sides = [rows[f"largest strain after, {side} (%)"] for side in ("compression", "extension")]
        if np.isfinite(sides[0]).any():
            strains.plot(*sides, "o", color=BLUE, mfc=face, markersize=4, label=PACE_NAMES[pace])
    strains.legend()
    high = max(1.0, np.nanmax(strains.dataLim.max))
    strains.plot([0, high], [0, high], color=GREY, linewidth=0.8)
    strains.set_xlabel(r"Largest $\varepsilon_1$ after the onset, compression (%)")
    strains.set_ylabel("Largest $\\varepsilon_1$ after the onset,\nextension (%)")
    return figure


def densest_liquefying(table):
    """Rows of the slow tests, or of the preparation with the most seeds that liquefy; the densest of those."""
    table = table.where(pace=plan.SLOW) or table
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
    table = table.where(**{"q_amp/(2 p0')": plan.PAPER_RATIO})
    for direction, colour in (("compression", BLUE), ("extension", ORANGE)):
        for pace, face in ((plan.DEFAULT, "none"), (plan.SLOW, colour)):
            part = table.where(direction=direction, pace=pace)
            for panel, x in ((against, "strain travelled (%)"), (numbers, "half cycle")):
                if part:
                    panel.plot(part[x], np.abs(part["F_yx at its end"]), "o", color=colour, mfc=face, markersize=3,
                               label=f"{direction}, {PACE_NAMES[pace]}")
    against.set_xlabel(r"Axial strain $|\Delta\varepsilon_1|$ of the half cycle (%)")
    numbers.set_xlabel("Number of the half cycle after the onset")
    against.set_ylabel("$|F_{[y-x]}|$ at its end")
    legend_below(figure, against, 0.13, 2)
    return figure


@of_tables("drained_curves")
def drained(table, _):
    """Drained tests next to the laboratory, the two pressures in columns."""
    figure, axes = panels(2, 2, height=5.4, sharex=True)
    tests = {test.name: test for test in lab.drained_tests()}
    for column, pressure in enumerate((100, 200)):
        for (density, names), colour in zip(plan.LABORATORY.items(), (RED, GREEN, BLUE)):
            rows = table.where(specimen=f"D_r {density:.2f}, {pressure} kPa")
            for panel, name in zip(axes[:, column], ("q (kPa)", "eps_v (%)")):
                if rows:
                    band(panel, rows["|eps_1| (%)"], rows[name], rows[f"{name} s.d."], colour)
            test = tests[names[column]]
            axes[0, column].plot(100 * test.strain, (test.axial - test.radial) / 1e3, "--", color=colour, linewidth=0.9)
            axes[1, column].plot(100 * test.strain, 100 * test.volume_strain, "--", color=colour, linewidth=0.9)
        axes[0, column].set_title(f"{pressure} kPa")
        axes[1, column].set(xlabel=r"Axial strain $\varepsilon_1$ (%)", xlim=(0, 15))
    axes[0, 0].set_ylabel("Deviatoric stress $q$ (kPa)")
    axes[1, 0].set_ylabel(r"Volumetric strain $\varepsilon_v$ (%)")
    for density, colour in zip(plan.LABORATORY, (RED, GREEN, BLUE)):
        axes[0, 0].plot([], [], color=colour, label=f"$D_r$ = {density:.2f}")
    axes[0, 0].plot([], [], "--", color=GREY, label="laboratory (Wichtmann and Triantafyllidis 2016)")
    legend_below(figure, axes[0, 0], 0.05, 4)
    return figure


def resistance_points(panel, rows, fit, colour, name):
    """Full: in the fit; open: of ratios that are not, because a specimen lasted; an arrow where it still does."""
    cycles, ratio = rows["cycles"], rows["q_amp/(2 p0')"]
    fitted = np.isin(ratio, list(fitted_ratios(list(zip(ratio, cycles)))))
    lasted = ~np.isfinite(cycles)
    panel.plot(cycles[fitted], ratio[fitted], "o", color=colour, markersize=4, label=name)
    panel.plot(cycles[~fitted], ratio[~fitted], "o", color=colour, markersize=4, markerfacecolor="none")
    panel.plot(rows["cycles applied"][lasted], ratio[lasted], ">", color=colour, markersize=4, markerfacecolor="none")
    if fit:
        ends = np.quantile(cycles[fitted], (0, 1))
        panel.plot(ends, fit["CSR at 15 cycles"][0] * (ends / REFERENCE)**-fit["b"][0], color=colour, linewidth=0.9)


@of_tables("cyclic_tests", "resistance")
def resistance(table, folder):
    """Cyclic stress ratio against cycles to liquefaction, by preparation and by pressure, and the fits."""
    table = table.where(pace=plan.DEFAULT)
    fits = Table(folder / "resistance.csv")
    figure, (row,) = panels(1, 2, sharey=True)
    colours = (RED, GREEN, BLUE)
    for panel, labels, names in (
            (row[0], [f"{d:g} deg, 200 kPa" for d in plan.RESISTANCE], [f"{d:g} deg" for d in plan.RESISTANCE]),
            (row[1], [f"9 deg, {p:g} kPa" for p in plan.PRESSURES],
             [f"$p_0^\\prime$ = {p:g} kPa" for p in plan.PRESSURES])):
        for label, name, colour in zip(labels, names, colours):
            rows = table.where(specimen=label)
            if rows:
                resistance_points(panel, rows, fits.where(specimen=label), colour, name)
        plain_logarithm(panel.xaxis)
        panel.set_xlabel(f"Cycles to {PRIME}/$p_0^\\prime$ < 0.01")
        if panel.get_legend_handles_labels()[0]:
            panel.legend()
    row[0].set_ylabel(r"$q_\mathrm{amp}/(2 p_0^\prime)$")
    return figure


@of_tables("critical_states")
def critical_states(table, folder):
    """Ends of monotonic tests with the line through them; strain of liquefied specimens that drain."""
    figure, ((line, drained_strain),) = panels(1, 2)
    for kind, walls, marker, colour, label in (
            ("compression", True, "o", BLUE, "undrained compression, box"),
            ("extension", True, "s", ORANGE, "undrained extension, box"),
            ("drained", True, "^", GREEN, "drained, box"), ("drained", False, "D", RED, "drained, periodic cell")):
        rows = table.where(test=kind, walls=walls)
        if rows:
            line.plot(rows["p' (kPa)"] / 1e3, rows["e"], marker, color=colour, markersize=4,
                      mfc="none" if walls else colour, label=label)
    table = Table.of([row for row in table.rows if np.isfinite(row["Gamma"])]) if "Gamma" in table.rows[0] else None
    if table:
        p = np.quantile(table["p' (kPa)"], (0, 1))
        line.plot(p / 1e3, table["Gamma"][0] - table["lambda"][0] * np.log(p), color="black", linewidth=0.9,
                  label=f"{table['Gamma'][0]:.3f} \N{MINUS SIGN} {table['lambda'][0]:.4f} ln({PRIME}/kPa)")
    plain_logarithm(line.xaxis)
    line.set(xlabel=f"Mean effective stress {PRIME} (MPa)", ylabel="Void ratio $e$")
    legend_below(figure, line, 0.12, 3)
    if (folder / "reconsolidation.csv").exists():
        rows = Table(folder / "reconsolidation.csv")
        labels = sorted(rows.values("specimen"), key=lambda label: rows.where(specimen=label)["e"].mean())
        for label, colour in zip(labels, (RED, BLUE, ORANGE, GREEN, GREY)):
            part = rows.where(specimen=label)
            drained_strain.plot(part["largest gamma (%)"], part["eps_v (%)"], "o", color=colour, markersize=4,
                                label=label)
        drained_strain.legend()
    drained_strain.set_xlabel(r"Largest shear strain $\gamma = 1.5|\varepsilon_1|$ (%)")
    drained_strain.set_ylabel(r"$\varepsilon_v$ as it drains to $p_0^\prime$ (%)")
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
           "drained": drained, "resistance": resistance, "critical_states": critical_states}

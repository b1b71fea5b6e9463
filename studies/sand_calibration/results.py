# SPDX-License-Identifier: BSD-3-Clause
"""Tables and figures of the fit and of what it predicts."""
import copy

import matplotlib.pyplot as plt
import numpy as np

from isostat.campaign.calibrate.curves import compare, read_laboratory, read_model
from isostat.campaign.calibrate.plan import read_plan
from isostat.campaign.runs import read_summary
from isostat.figures.common import legend_below
from isostat.results import read_table
from studies.drawing import BLUE, GREEN, GREY, ORANGE, RED, band, panels, plain_logarithm, save
from studies.ensembles import ensemble
from studies.sand_calibration import posterior
from studies.sand_calibration.posterior import PARAMETERS, number
from studies.sand_calibration.predictions import (FIRST_SEED, LABORATORY, LIKE_PAPER, MOST_CYCLES, SLOWER, densities,
                                                  fit_of, fitted, limits)
from studies.small_strain.published import small_strain_modulus
from studies.tables import read_csv, write_csv

COLOURS = {"opened": ORANGE, "compacted": BLUE}
GROUPS = (("loose", 0.4, RED), ("medium", 0.75, ORANGE), ("dense", 1.1, BLUE))  # name, largest D_r, colour
STRAINS = (0.1, 0.2, 0.5, 1, 2, 6)  # %, of q in the table of variants
FIRST = 0.25  # where a figure has cycles of specimens that liquefy in the first loading


def parameter_rows(output):
    """Best set, and the posterior with its correlations."""
    found = posterior.fit(output)
    low, median, high = found.band()
    names = [" ".join(filter(None, (one.get("curve"), one["key"].split(".", 1)[1]))) for one in PARAMETERS]
    for k, (name, one) in enumerate(zip(names, PARAMETERS)):
        yield {"parameter": name, "lower bound": number(one["bounds"][0]), "upper bound": number(one["bounds"][1]),
               "best": found.best[k], "16 %": low[k], "median": median[k], "84 %": high[k],
               **{f"correlation with {other}": r for other, r in zip(names, found.correlation()[k])}}
    yield {"parameter": "misfit of the linear curves", "best": found.misfit, "median": found.expected}
    yield {"parameter": "the same with one expansion", "best": found.tied}
    yield {"parameter": "a packing misses them by", "best": found.missed}


def comparison(output, test, folders):
    """As the fit compares, for any drained test."""
    plan = read_plan(output / "plans/design.toml")
    curve = copy.copy(plan.curve[0])
    curve.path, curve.where = str(LABORATORY / f"drained/{test}.csv"), test
    return compare(read_laboratory(curve, 1e3 * densities()[test][1]),
                   [read_model(folder, curve) for folder in folders], curve, plan.misfit)


def peak(curve, pressure):
    """Largest mobilised friction angle, deg: sin(phi) = q/(q + 2 sigma_3).   pressure: sigma_3, Pa"""
    q = curve.q.max()
    return float(np.degrees(np.arcsin(q / (q + 2 * pressure))))


def grouped(store, planned, kind, *names):
    """{values of these attributes: [(run, its folder)]}, of what has been run."""
    cases = {}
    for run in planned:
        if run.kind == kind and store.is_done(run):
            cases.setdefault(tuple(getattr(run, name) for name in names), []).append((run, store.folder(run)))
    return cases


def is_fitted(test):
    return test in fitted().values()


def drained_rows(compared):
    for (contact, test), found in compared.items():
        density, pressure = densities()[test]
        laboratory, model = (peak(curve, 1e3 * pressure) for curve in (found.laboratory, found.mean))
        yield {"contact": contact, "test": test, "D_r": density, "p0 (kPa)": round(pressure, -2),
               "fitted": is_fitted(test), "misfit": found.misfit,
               "scatter": found.scatter, "peak friction (deg)": model, "laboratory (deg)": laboratory,
               "difference (deg)": model - laboratory}


def small_strain_rows(store, planned):
    """G of packings next to sand of the void ratio of the laboratory's test."""
    least, most = limits()
    for (contact, density), cases in grouped(store, planned, "small strain", "contact", "density").items():
        found = [store.run(run).result for run, _ in cases]
        mean, deviation, _, n = ensemble([one["G"] for one in found])
        void_ratio = most - density * (most - least)
        sand = float(small_strain_modulus(void_ratio, 100e3)) / 1e6
        yield {"contact": contact, "D_r": density, "e of packings": ensemble([one["void_ratio"] for one in found])[0],
               "G (MPa)": mean, "s.d.": deviation, "n": n, "e of sand": void_ratio, "G of sand (MPa)": sand,
               "ratio": mean / sand}


def least_p(folder):
    """Least p', kPa."""
    return float(read_table(folder / "history.csv")["p"].min() / 1e3)


def at_start(folder, column):
    """Of shearing."""
    return read_table(folder / "history.csv")[column][read_summary(folder)["shear_stage_first_row"]]


def cycles_of(folder):
    """To p'/p0' < ONSET; MOST_CYCLES if it is not reached, 0 in the first loading."""
    onset = read_summary(folder)["liquefaction"]
    return onset["cycle"] if onset else MOST_CYCLES


def spread_rows(store, planned, kind, value, of_test):
    """Of each contact and test: the best set over seeds, and the best set and draws of the posterior on the packings of
    the first seed.   value: of a folder   of_test: (run, mean) -> more columns"""
    for (contact, test), cases in grouped(store, planned, kind, "contact", "test").items():
        seed = cases[0][0].seed
        over = {"seeds": [value(folder) for run, folder in cases if run.draw == 0],
                "posterior": [value(folder) for run, folder in cases if run.seed == seed]}
        run, mean = cases[0][0], float(np.median(over["seeds"]))
        yield {"contact": contact, "test": test, "D_r": run.density, "p0 (kPa)": run.pressure, "median of seeds": mean,
               **{f"{name}: {what}": function(values) for name, values in over.items()
                  for what, function in (("least", min), ("most", max), ("n", len))}, **of_test(run, mean)}


def undrained_of(run, mean):
    measured = next(row["p' (kPa)"] for row in read_csv(LABORATORY / "undrained_anchors.csv")
                    if (row["test"], row["state"]) == (run.test, "least p'"))
    return {"direction": run.stages[-1]["direction"], "laboratory": measured,
            "difference / p0'": (mean - measured) / run.pressure}


def cyclic_of(run, _):
    amplitude = float(run.stages[-1]["deviator_amplitude"].split()[0])
    measured = {row["test"]: row["cycles"] for row in read_csv(LABORATORY / "undrained_cyclic.csv")} | {
        LIKE_PAPER[0]: 11}
    return {"q amplitude (kPa)": amplitude, "q/p0": amplitude / run.pressure, "laboratory": measured[run.test]}


def variant_rows(store, planned, output):
    """Dense packings that are prepared, loaded or touch in other ways: the drained test and least p' undrained."""
    cases = {}
    for run in planned:
        if run.test in (fitted()["dense"], "TMU6") and run.draw == 0 and store.is_done(run):
            cases.setdefault((run.contact, run.label), {}).setdefault(run.kind, []).append(store.folder(run))
    for (contact, label), folders in cases.items():
        of_test, least = folders.get("drained", []), [least_p(folder) for folder in folders.get("undrained", [])]
        row = {"contact": contact, "label": label, "n": max(len(of_test), len(least)),
               **{name: np.mean([at_start(folder, name) for one in folders.values() for folder in one])
                  for name in ("e", "Z")}}
        if of_test:
            found = comparison(output, fitted()["dense"], of_test)
            row |= {"misfit": found.misfit, "largest eps_v (%)": 100 * found.mean.other.max(),
                    **{f"{name} at {strain:g} % (kPa)": np.interp(strain / 100, curve.strain, curve.q) / 1e3
                       for name, curve in (("q", found.mean), ("laboratory", found.laboratory)) for strain in STRAINS}}
        if least:
            row |= {"least p' (kPa)": np.mean(least), "lowest": min(least), "highest": max(least)}
        yield row


def rate_rows(store, planned, output):
    """The fitted tests of the best set at a quarter of the rate, same packings: misfits, and the root mean square of
    the difference of both over the laboratory's largest q and volumetric strain."""
    cases = grouped(store, planned, "drained", "contact", "test", "seed", "label")
    for test in fitted().values():
        rates = [cases.get(("opened", test, FIRST_SEED, label)) for label in ("", SLOWER[0])]
        if all(rates):
            fast, slow = (comparison(output, test, [folder for _, folder in of]) for of in rates)
            q, volume = (np.sqrt(np.mean((one - other)**2)) / np.abs(of).max()
                         for one, other, of in zip(fast.mean[1:], slow.mean[1:], fast.laboratory[1:]))
            yield {"test": test, "misfit": fast.misfit, "misfit, slower": slow.misfit, "q apart": q,
                   "eps_v apart": volume}


def score_rows(tables):
    """How many of the targets each contact meets."""
    def of(name, contact):
        return [row for row in tables[name] if row["contact"] == contact]
    for contact in COLOURS:
        cycles = [row for row in of("cyclic", contact) if np.isfinite(row["laboratory"])]
        met = {"misfit": [row["misfit"] <= (0.08 if row["fitted"] else 0.12) for row in of("drained", contact)],
               "peak friction": [abs(row["difference (deg)"]) <= 1.5 for row in of("drained", contact)],
               "G": [abs(row["ratio"] - 1) <= 0.2 for row in of("small_strain", contact)],
               "least p'": [abs(row["difference / p0'"]) <= 0.3 for row in of("undrained", contact)],
               "cycles": [row["laboratory"] / 1.5 <= row["median of seeds"] <= 1.5 * row["laboratory"]
                          for row in cycles]}
        yield {"contact": contact, **{f"{name}, {what}": value for name, values in met.items() for what, value in
                                      (("met", sum(values)), ("of", len(values)))}}


def draw_drained(compared, path):
    tests = sorted({test for _, test in compared}, key=densities().get)
    columns, lines = min(4, len(tests)), -(-len(tests) // 4)
    figure, axes = plt.subplots(2 * lines, columns, figsize=(1.85 * columns, 3.8 * lines), layout="constrained",
                                sharex=True, squeeze=False)
    for axis in axes[-2:, (len(tests) - 1) % columns + 1:].flat:
        axis.set_visible(False)
    for k, test in enumerate(tests):
        upper, lower = (axes[2 * (k // columns) + row][k % columns] for row in (0, 1))
        upper.set_title(f"{test}, {densities()[test][1]:.0f} kPa, $D_r$ = {densities()[test][0]:.2f}"
                        f"\n{'fitted' if is_fitted(test) else 'not fitted'}", fontsize=7)
        for contact, colour in COLOURS.items():
            if (contact, test) not in compared:
                continue
            found = compared[contact, test]
            strain = 100 * found.laboratory.strain
            for axis, row, scale in ((upper, 1, 1e-3), (lower, 2, 100)):
                axis.plot(strain, scale * found.laboratory[row], "k.", markersize=2.5,
                          label="laboratory" if contact == "opened" else None)
                band(axis, strain, scale * found.mean[row], scale * found.deviation[row], colour, f"{contact} packings")
        axes[-1][k % columns].set_xlabel("axial strain (%)")
        if k % columns == 0:
            upper.set_ylabel("$q$ (kPa)")
            lower.set_ylabel(r"$\varepsilon_v$ (%)")
    legend_below(figure, axes[0][0], 0.05, 5)
    save(figure, path)


def draw_predictions(undrained, variants, path):
    """Least p' of undrained tests, and the two dense tests over the expansion."""
    figure, ((left, right),) = panels(1, 2)
    names = list(dict.fromkeys(row["test"] for row in undrained))
    for contact, colour in COLOURS.items():
        rows = {row["test"]: row for row in undrained if row["contact"] == contact}
        kinds = (("seeds", "o", "two packings"), ("posterior", "_", "posterior, one packing"))
        for shift, (over, marker, label) in zip((-0.2, 0), kinds if contact == "opened" else kinds[:1]):
            x = np.array([names.index(test) for test in rows]) + shift + 0.35 * (contact == "compacted")
            low, high = (np.array([row[f"{over}: {end}"] for row in rows.values()]) for end in ("least", "most"))
            left.errorbar(x, (low + high) / 2, (high - low) / 2, color=GREEN if over == "posterior" else colour,
                          fmt=marker, markersize=4, capsize=2, linewidth=1, label=f"{contact}: {label}")
    measured = {row["test"]: row["laboratory"] for row in undrained}
    left.plot(range(len(names)), [measured[test] for test in names], "k*", markersize=7, label="laboratory")
    of = {row["test"]: row for row in undrained}
    left.set_xticks(range(len(names)), [f"{test}\n{of[test]['direction'][:4].rstrip('e')}.\n$D_r$ {of[test]['D_r']:.2f}"
                                        for test in names], fontsize=6.5)
    left.set_ylabel("least $p'$ (kPa)")
    legend_below(figure, left, 0.1, 4)
    points = sorted((float(row["label"].split()[-1]), row) for row in variants
                    if row["contact"] == "opened" and row["label"].startswith("expansion"))
    for colour, marker, label, over in (
            (ORANGE, "o", "least $p'$, TMU6", lambda row: row.get("least p' (kPa)", np.nan) / measured["TMU6"]),
            (GREY, "s", "$q$ at 0.2 %, TMD18", lambda row: row["q at 0.2 % (kPa)"] / row["laboratory at 0.2 % (kPa)"])):
        right.plot([x for x, _ in points], [over(row) for _, row in points], marker + "-", color=colour, markersize=4,
                   label=label)
    right.axhline(1, color="k", linestyle="--", linewidth=0.8)
    right.set(xlabel="expansion of dense packings", ylabel="packings over laboratory")
    right.legend()
    save(figure, path)


def draw_cyclic(rows, path):
    """Resistance: amplitude over cycles, by density."""
    figure, (axes,) = panels(1, 2, sharey=True)
    for axis, contact in zip(axes, COLOURS):
        axis.text(0.5, 1.02, f"{contact} packings", transform=axis.transAxes, ha="center")
        low = 0
        for name, high, colour in GROUPS:
            part = [row for row in rows if row["contact"] == contact and low <= row["D_r"] < high]
            low = high
            for row in part:
                ends = [max(FIRST, row[f"seeds: {end}"]) for end in ("least", "most")]
                y = 2 * [row["q/p0"] + 0.01 * (row["D_r"] - 0.5)]  # looser ones below, so that they do not hide others
                axis.plot(ends, y, "o-", color=colour, markersize=3.5, linewidth=0.8,
                          markerfacecolor="none" if ends[0] >= MOST_CYCLES else colour)
                if np.isfinite(row["laboratory"]):
                    axis.plot(row["laboratory"], row["q/p0"], "*", color=colour, markersize=11, markeredgecolor="k")
            axis.plot([], [], "o", color=colour, markersize=3.5, label=name)
        axis.plot([], [], "k*", markersize=9, label="laboratory")
        plain_logarithm(axis.xaxis)
        axis.set(xlim=(0.2, 150), xlabel="cycles to $p'$ < 0.05 $p_0'$")
    axes[0].set_ylabel("amplitude of $q$ over $p_0'$")
    legend_below(figure, axes[0], 0.08, 4)
    save(figure, path)


def report(store, planned, folder):
    output = planned[0].output
    if fit_of(output, "opened") is None:
        return
    plain = [run for run in planned if not run.label]
    compared = {(contact, test): comparison(output, test, [path for _, path in cases]) for (contact, test), cases in
                grouped(store, plain, "drained", "contact", "test").items()}
    tables = {"parameters": list(parameter_rows(output)), "drained": list(drained_rows(compared)),
              "small_strain": list(small_strain_rows(store, plain)),
              "undrained": list(spread_rows(store, plain, "undrained", least_p, undrained_of)),
              "cyclic": list(spread_rows(store, plain, "cyclic", cycles_of, cyclic_of)),
              "variants": list(variant_rows(store, planned, output)), "rates": list(rate_rows(store, planned, output))}
    tables["scores"] = list(score_rows(tables))
    for name, rows in tables.items():
        if rows:
            write_csv(folder / f"{name}.csv", rows, 4)
    if compared:
        draw_drained(compared, folder / "drained.png")
    if tables["undrained"]:
        draw_predictions(tables["undrained"], tables["variants"], folder / "predictions.png")
    if tables["cyclic"]:
        draw_cyclic(tables["cyclic"], folder / "cyclic.png")

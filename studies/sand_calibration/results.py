# SPDX-License-Identifier: BSD-3-Clause
"""Tables and figures of the fits and of what they predict."""
import copy

import matplotlib.pyplot as plt
import numpy as np

from isostat.campaign.calibrate.curves import compare, read_laboratory, read_model
from isostat.campaign.calibrate.plan import read_plan
from isostat.campaign.runs import read_summary
from isostat.figures.common import legend_below
from isostat.results import read_table
from studies.drawing import ORANGE, band, panels, save
from studies.ensembles import ensemble
from studies.sand_calibration import posterior
from studies.sand_calibration.posterior import PARAMETERS, number
from studies.sand_calibration.predictions import (FIRST_SEED, LABORATORY, MOST_CYCLES, curves, densities, fit_of,
                                                  fitted, limits)
from studies.small_strain.published import small_strain_modulus
from studies.tables import read_csv, write_csv

EXPANDED = ("TMU6", "TCUI13")
COLOURS = {"opened": ORANGE}


def parameter_rows(fit):
    """Best set, and the posterior with its correlations."""
    found = posterior.fit(fit.folder.parent)
    low, median, high = found.band()
    names = [" ".join(filter(None, (one.get("curve"), one["key"].split(".", 1)[1]))) for one in PARAMETERS]
    for k, (name, one) in enumerate(zip(names, PARAMETERS)):
        yield {"parameter": name, "lower bound": number(one["bounds"][0]), "upper bound": number(one["bounds"][1]),
               "best": fit.values[k], "16 %": low[k], "median": median[k], "84 %": high[k],
               **{f"correlation with {other}": r for other, r in zip(names, found.correlation()[k])}}


def folders_of_fit(fit, curve):
    (best,) = read_csv(fit.folder / "trials.csv")
    return sorted(path for path in (fit.folder / best["folder"]).glob(f"{curve['name']}_seed*") if path.is_dir())


def comparison(fit, test, folders):
    """As the fit compares, for any drained test."""
    plan = read_plan(fit.folder.parent / "plans" / f"{fit.folder.name}.toml")
    curve = copy.copy(plan.curve[0])
    curve.path, curve.where = str(LABORATORY / f"drained/{test}.csv"), test
    return compare(read_laboratory(curve, 1e3 * densities()[test][1]),
                   [read_model(folder, curve) for folder in folders], curve, plan.misfit)


def peak(curve, pressure):
    """Largest mobilised friction angle, deg: sin(phi) = q/(q + 2 sigma_3).   pressure: sigma_3, Pa"""
    q = curve.q.max()
    return float(np.degrees(np.arcsin(q / (q + 2 * pressure))))


def drained_of(store, planned, fit, contact):
    """{test: comparison}"""
    folders = {test: folders_of_fit(fit, curve) for test, curve in curves().items() if is_fitted(test)}
    for run in planned:
        if (run.kind, run.contact) == ("drained", contact) and store.is_done(run):
            folders.setdefault(run.test, []).append(store.folder(run))
    order = sorted(filter(folders.get, folders), key=densities().get)
    return {test: comparison(fit, test, folders[test]) for test in order}


def is_fitted(test):
    return test in fitted().values()


def drained_rows(contact, compared):
    for test, found in compared.items():
        density, pressure = densities()[test]
        laboratory, model = (peak(curve, 1e3 * pressure) for curve in (found.laboratory, found.mean))
        yield {"contact": contact, "test": test, "D_r": density, "p0 (kPa)": round(pressure, -2),
               "fitted": is_fitted(test), "misfit": found.misfit,
               "scatter": found.scatter, "peak friction (deg)": model, "laboratory (deg)": laboratory,
               "difference (deg)": model - laboratory}


def small_strain_rows(store, planned):
    """G of packings next to sand of the void ratio of the laboratory's test."""
    least, most = limits()
    cases = {}
    for run in planned:
        if run.kind == "small strain" and store.is_done(run):
            cases.setdefault((run.contact, run.density), []).append(store.run(run).result)
    for (contact, density), found in cases.items():
        mean, deviation, _, n = ensemble([one["G"] for one in found])
        void_ratio = most - density * (most - least)
        sand = float(small_strain_modulus(void_ratio, 100e3)) / 1e6
        yield {"contact": contact, "D_r": density, "e of packings": ensemble([one["void_ratio"] for one in found])[0],
               "G (MPa)": mean, "s.d.": deviation, "n": n, "e of sand": void_ratio, "G of sand (MPa)": sand,
               "ratio": mean / sand}


def predicted(store, planned, kind):
    """{test: (first of its runs, folders of all)}"""
    cases = {}
    for run in planned:
        if run.kind == kind and store.is_done(run):
            cases.setdefault(run.test, (run, []))[1].append(store.folder(run))
    return cases


def undrained_rows(store, planned):
    for test, (run, folders) in predicted(store, planned, "undrained").items():
        least = [read_table(folder / "history.csv")["p"].min() / 1e3 for folder in folders]
        mean = np.mean(least)
        measured = next(row["p' (kPa)"] for row in read_csv(LABORATORY / "undrained_anchors.csv")
                        if (row["test"], row["state"]) == (test, "least p'"))
        yield {"contact": run.contact, "test": test, "direction": dict(run.stage)["direction"], "D_r": run.density,
               "least p' (kPa)": mean, "lowest": min(least), "highest": max(least), "n": len(least),
               "laboratory (kPa)": measured,
               "difference / p0'": (mean - measured) / run.pressure}


def cycles_of(folder):
    """To p'/p0' < ONSET; MOST_CYCLES if it is not reached."""
    onset = read_summary(folder)["liquefaction"]
    return onset["cycle"] if onset else MOST_CYCLES


def cyclic_rows(store, planned):
    measured = {row["test"]: row["cycles"] for row in read_csv(LABORATORY / "undrained_cyclic.csv")}
    for test, (run, folders) in predicted(store, planned, "cyclic").items():
        cycles = [cycles_of(folder) for folder in folders]
        amplitude = float(dict(run.stage)["deviator_amplitude"].split()[0])
        yield {"contact": run.contact, "test": test, "D_r": run.density, "p0 (kPa)": run.pressure,
               "q amplitude (kPa)": amplitude, "q/p0": amplitude / run.pressure,
               "cycles, median": float(np.median(cycles)), "least": min(cycles), "most": max(cycles), "n": len(cycles),
               f"reached in {MOST_CYCLES}": sum(c < MOST_CYCLES for c in cycles), "laboratory": measured[test]}


def draw_drained(all_compared, path):
    tests = max(map(list, all_compared.values()), key=len)
    columns, lines = min(4, len(tests)), -(-len(tests) // 4)
    figure, axes = plt.subplots(2 * lines, columns, figsize=(1.85 * columns, 3.8 * lines), layout="constrained",
                                sharex=True, squeeze=False)
    for axis in axes[-2:, (len(tests) - 1) % columns + 1:].flat:
        axis.set_visible(False)
    for k, test in enumerate(tests):
        upper, lower = (axes[2 * (k // columns) + row][k % columns] for row in (0, 1))
        upper.set_title(f"{test}, {densities()[test][1]:.0f} kPa, $D_r$ = {densities()[test][0]:.2f}"
                        f"\n{'fitted' if is_fitted(test) else 'not fitted'}", fontsize=7)
        of_test = {contact: compared[test] for contact, compared in all_compared.items() if test in compared}
        laboratory = next(iter(of_test.values())).laboratory
        upper.plot(100 * laboratory.strain, laboratory.q / 1e3, "k.", markersize=2.5, label="laboratory")
        lower.plot(100 * laboratory.strain, 100 * laboratory.other, "k.", markersize=2.5)
        for contact, found in of_test.items():
            for axis, row, scale in ((upper, 1, 1e-3), (lower, 2, 100)):
                band(axis, 100 * laboratory.strain, scale * found.mean[row], scale * found.deviation[row],
                     COLOURS[contact], contact.replace("_", ", "))
        axes[-1][k % columns].set_xlabel("axial strain (%)")
        if k % columns == 0:
            upper.set_ylabel("$q$ (kPa)")
            lower.set_ylabel(r"$\varepsilon_v$ (%)")
    legend_below(figure, axes[0][0], 0.05, 5)
    save(figure, path)


def expansion_rows(store, planned):
    """The best set with other expansions, and its own."""
    for run in planned:
        if run.test not in EXPANDED or not store.is_done(run) or run.seed != FIRST_SEED:
            continue
        numbers, history = read_summary(store.folder(run)), read_table(store.folder(run) / "history.csv")
        expansion = fit_of(run.output / run.contact).drawn(0)["specimen.expansion"]
        yield {"test": run.test, "D_r": run.density,
               "expansion": expansion if run.expansion is None else run.expansion,
               "e of packing": numbers["void_ratio"], "Z of packing": history["Z"][0],
               "least p' (kPa)": history["p"].min() / 1e3,
               "cycles": cycles_of(store.folder(run)) if run.kind.startswith("cyclic") else None}


def draw_predictions(undrained, expanded, path):
    """Least p' of undrained tests (bars: range of specimens), and over the expansion."""
    figure, ((left, right),) = panels(1, 2)
    x = np.arange(len(undrained))
    mean, lowest, highest = ([row[name] for row in undrained] for name in ("least p' (kPa)", "lowest", "highest"))
    left.errorbar(x, mean, [np.subtract(mean, lowest), np.subtract(highest, mean)], color=ORANGE, fmt="o", markersize=4,
                  capsize=2, linewidth=0.8, label="predicted")
    left.plot(x, [row["laboratory (kPa)"] for row in undrained], "k*", markersize=8, label="laboratory")
    left.set_xticks(x, [f"{row['test']}\n{row['direction'][:4].rstrip('e')}.\n{row['D_r']:.2f}" for row in undrained],
                    fontsize=7)
    left.set_ylabel("least $p'$ (kPa)")
    left.legend()
    dense = EXPANDED[0]
    points = sorted((row["expansion"], row["least p' (kPa)"]) for row in expanded if row["test"] == dense)
    right.plot(*np.array(points).reshape(-1, 2).T, "o-", color=ORANGE, markersize=4, label=f"{dense}, best set")
    right.axhline(next(row["laboratory (kPa)"] for row in undrained if row["test"] == dense), color="k", linestyle="--",
                  linewidth=0.8, label="laboratory")
    right.set(xlabel="expansion", ylabel="least $p'$ (kPa)")
    right.legend()
    save(figure, path)


def report(store, planned, folder, contacts):
    fits = {contact: fit for contact in contacts if (fit := fit_of(planned[0].output / contact))}
    if not fits:
        return
    compared = {contact: drained_of(store, planned, fit, contact) for contact, fit in fits.items()}
    tables = {"parameters": list(parameter_rows(fits["opened"])) if "opened" in fits else [],
              "drained": [row for contact in fits for row in drained_rows(contact, compared[contact])],
              "small_strain": list(small_strain_rows(store, planned)),
              "undrained": list(undrained_rows(store, planned)), "cyclic": list(cyclic_rows(store, planned)),
              "expansion": list(expansion_rows(store, planned))}
    for name, rows in tables.items():
        if rows:
            write_csv(folder / f"{name}.csv", rows, 4)
    draw_drained(compared, folder / "drained.png")
    if tables["undrained"]:
        draw_predictions(tables["undrained"], tables["expansion"], folder / "predictions.png")

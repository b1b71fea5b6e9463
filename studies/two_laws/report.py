# SPDX-License-Identifier: BSD-3-Clause
"""Tables and figures of the runs that are done."""
import json

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import FixedLocator, NullFormatter

from studies.history import History
from studies.drawing import BLUE, ORANGE, RED, STYLE, panels, plain_logarithm
from studies.tables import write_csv
from studies.two_laws import plan

COLOURS = {"linear-rolling": ORANGE, "hertz-mindlin": BLUE}
LABELS = {"linear-rolling": "linear", "hertz-mindlin": "Hertz-Mindlin"}
TARGET = 15  # cycles at which resistances are compared


def rows_of(store, runs, kinds):
    """One row of each finished run of these kinds."""
    rows = []
    for run in runs:
        if run.kind not in kinds or not store.is_done(run):
            continue
        summary = json.loads((store.folder(run) / "summary.json").read_text())
        onset = summary["liquefaction"] or {}
        row = {"law": run.law, "seed": run.seed, "prepared at (deg)": run.degrees, "e": summary["void_ratio"],
               "p0' (kPa)": run.pressure}
        if run.kind == "monotonic":
            history = History(store.folder(run))
            last = int(np.argmin(np.abs(history.eps_y - history.eps_y[0] - 0.05)))
            row |= {"least p' (kPa)": history.p.min() / 1e3, "p' at 5 % (MPa)": history.p[last] / 1e6,
                    "q/p' at 5 %": history.q[last] / history.p[last]}
        else:
            row |= {"CSR": run.ratio or 0.15, "rate": run.rate, "cycles": onset.get("cycle", np.nan),
                    "cycles applied": summary["reversals"] / 2,
                    "strain before (%)": 100 * onset.get("strain_before", np.nan),
                    "I_R at onset": onset.get("IR_at_onset", np.nan), "least I_R": onset.get("IR_min", np.nan),
                    "response": summary["cyclic_response"]["name"]}
        rows.append(row)
    return rows



def resistance_at(rows):
    """CSR that liquefies in TARGET cycles: least squares of ln CSR on ln N; not a number outside of the tests by more
    than a factor of two."""
    n, ratio = (np.array([row[name] for row in rows]) for name in ("cycles", "CSR"))
    n, ratio = n[np.isfinite(n)], ratio[np.isfinite(n)]
    if len(set(ratio)) < 2 or not n.min() / 2 < TARGET < 2 * n.max():
        return np.nan
    slope, level = np.polyfit(np.log(n), np.log(ratio), 1)
    return float(np.exp(level + slope * np.log(TARGET)))


def outside(rows):
    """Whether no test needed as many cycles, or none as few."""
    n = [row["cycles"] for row in rows if np.isfinite(row["cycles"])]
    return bool(n) and not min(n) <= TARGET <= max(n)


def k_sigma(rows):
    """CSR at TARGET cycles over that of the same seed at 100 kPa."""
    table = []
    for law in plan.LAWS:
        for seed in sorted({row["seed"] for row in rows}):
            at = {pressure: [row for row in rows if (row["law"], row["seed"], row["p0' (kPa)"], row["rate"])
                             == (law, seed, pressure, 1)] for pressure in plan.PRESSURES}
            ratios = {pressure: resistance_at(some) for pressure, some in at.items() if some}
            for pressure, ratio in ratios.items():
                table.append({"law": law, "seed": seed, "p0' (kPa)": pressure, "e": at[pressure][0]["e"],
                              "CSR at 15 cycles": ratio, "extrapolated": outside(at[pressure]),
                              "K_sigma": ratio / ratios.get(100, np.nan)})
    return table


def mean(rows, column, **where):
    """(mean, standard error, number) over the seeds of the rows with these values."""
    values = [row[column] for row in rows if all(row[k] == v for k, v in where.items()) and np.isfinite(row[column])]
    error = np.std(values, ddof=1) / np.sqrt(len(values)) if len(values) > 1 else np.nan
    return (np.mean(values) if values else np.nan), error, len(values)


def draw_paper(rows, path):
    figure, axes = panels(1, 2)
    for law in plan.LAWS:
        of_law = [row for row in rows if row["law"] == law]
        e, n = (np.array([row[name] for row in of_law]) for name in ("e", "cycles"))
        spared = ~np.isfinite(n)
        axes[0, 0].plot(e, n, "o", color=COLOURS[law], markersize=4, label=LABELS[law])
        axes[0, 0].plot(e[spared], np.full(spared.sum(), plan.CYCLES), "^", color=COLOURS[law], markersize=4,
                        markerfacecolor="none")
        axes[0, 1].plot(e, [row["I_R at onset"] for row in of_law], "o", color=COLOURS[law], markersize=4)
    plain_logarithm(axes[0, 0].yaxis)
    axes[0, 0].axhline(17, color=RED, linewidth=0.8, linestyle="--", label="the paper: 17")
    axes[0, 0].set(xlabel="Void ratio (box)", ylabel="Cycles to liquefaction (triangles: none)")
    axes[0, 0].legend()
    axes[0, 1].axhline(1, color=RED, linewidth=0.8, linestyle="--")
    axes[0, 1].set(xlabel="Void ratio (box)", ylabel="$I_R$ at the onset", ylim=(0, 1.4))
    figure.savefig(path)
    plt.close(figure)


def draw_resistance(rows, ratios, path):
    figure, axes = panels(1, 2)
    for law in plan.LAWS:
        for pressure, marker in zip(plan.PRESSURES, "osD^"):
            of = [row for row in rows if (row["law"], row["p0' (kPa)"], row["rate"]) == (law, pressure, 1)]
            axes[0, 0].plot([row["cycles"] for row in of], [row["CSR"] for row in of], marker, color=COLOURS[law],
                            markersize=4, markerfacecolor="none", label=f"{LABELS[law]}, {pressure} kPa")
        found = [mean(ratios, "K_sigma", law=law, **{"p0' (kPa)": p}) for p in plan.PRESSURES]
        axes[0, 1].errorbar(plan.PRESSURES, [m for m, _, _ in found], [s for _, s, _ in found], color=COLOURS[law],
                            marker="o", markersize=4, linewidth=1, capsize=2, label=LABELS[law])
    plain_logarithm(axes[0, 0].xaxis)
    axes[0, 0].set(xlabel="Cycles to liquefaction", ylabel=r"$\tau_{amp}/\sigma_{v0}^\prime$", ylim=(0.13, 0.32))
    axes[0, 0].legend(fontsize=6, ncols=2, loc="upper right")
    axes[0, 1].set_xscale("log")
    axes[0, 1].xaxis.set_major_locator(FixedLocator(plan.PRESSURES))
    axes[0, 1].xaxis.set_major_formatter("{x:g}")
    axes[0, 1].xaxis.set_minor_formatter(NullFormatter())
    axes[0, 1].axhline(1, color="#777777", linewidth=0.6)
    axes[0, 1].set(xlabel=r"$\sigma_{v0}^\prime$ (kPa)", ylabel=r"$K_\sigma$")
    axes[0, 1].legend()
    figure.savefig(path)
    plt.close(figure)


def write(store, runs, folder):
    folder.mkdir(parents=True, exist_ok=True)
    plt.rcParams.update(STYLE)
    paper, shear, monotonic = (rows_of(store, runs, kinds) for kinds in (("cyclic",), ("shear",), ("monotonic",)))
    ratios = k_sigma(shear)
    for name, rows in (("paper_test", paper), ("shear", shear), ("monotonic", monotonic), ("k_sigma", ratios)):
        if rows:
            write_csv(folder / f"{name}.csv", rows, digits=6)
    if paper:
        draw_paper(paper, folder / "paper_test.png")
    if shear:
        draw_resistance(shear, ratios, folder / "resistance.png")
    print_tables(paper, ratios, monotonic)


def print_tables(paper, ratios, monotonic):
    """For docs/results/hertz_mindlin.md."""
    for degrees in sorted(plan.PAPER_DEGREES):
        for law in plan.LAWS:
            where = {"law": law, "prepared at (deg)": degrees}
            if any(all(row[k] == v for k, v in where.items()) for row in paper):
                print(degrees, law, *(f"{c}: {m:.3g} ± {s:.2g} ({n})" for c in
                                      ("e", "cycles", "strain before (%)", "I_R at onset", "least I_R")
                                      for m, s, n in [mean(paper, c, **where)]))
    for pressure in plan.PRESSURES:
        for law in plan.LAWS:
            print(pressure, law, *(f"{c}: {m:.3f} ± {s:.2g} ({n})" for c in ("e", "CSR at 15 cycles", "K_sigma")
                                   for m, s, n in [mean(ratios, c, law=law, **{"p0' (kPa)": pressure})]))
    for law in plan.LAWS:
        print(law, *(f"{c}: {m:.4g} ± {s:.2g} ({n})" for c in ("e", "least p' (kPa)", "p' at 5 % (MPa)", "q/p' at 5 %")
                     for m, s, n in [mean(monotonic, c, law=law)]))

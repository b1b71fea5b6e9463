# SPDX-License-Identifier: BSD-3-Clause
"""The paper's undrained tests and the liquefaction resistance under four pressures, with both contact laws."""
import dataclasses

import numpy as np
from matplotlib.ticker import FixedLocator, NullFormatter

from studies.drawing import BLUE, ORANGE, RED, panels, plain_logarithm, save
from studies.ensembles import ensemble
from studies.history import History, parsed
from studies.scenes import RESISTANCE, cyclic, scene_of
from studies.tables import write_csv

DEFAULTS, QUICK = {"seeds": 3}, {"seeds": 1}
LAWS = {"linear-rolling": {"young": "10 GPa"}, "hertz-mindlin": {"law": "hertz-mindlin"}}
BOX_GRAINS, CELL_GRAINS = 2000, 1000
PAPER_DEGREES = (9, 10, 11, 12)  # of preparation friction
DENSE_DEGREES = 2
PRESSURES = (50, 100, 200, 400)  # kPa
# tau_amp / sigma'_v0; the last bracket 15 cycles
RATIOS = {"linear-rolling": (0.16, 0.22, 0.19, 0.14), "hertz-mindlin": (0.16, 0.22, 0.19, 0.26)}
SHEAR_DEGREES = 10
CYCLES = 100
COLOURS = {"linear-rolling": ORANGE, "hertz-mindlin": BLUE}
LABELS = {"linear-rolling": "linear", "hertz-mindlin": "Hertz-Mindlin"}
TARGET = 15  # cycles at which resistances are compared


@dataclasses.dataclass(frozen=True)
class Run:
    """One run, as isostat study takes it: its specimen first (prepare), then its test."""

    kind: str  # prepare, cyclic (triaxial), monotonic, shear (cyclic simple shear)
    law: str
    seed: int
    degrees: int
    domain: str = "rigid-box"
    pressure: int = 200
    ratio: float = 0

    @property
    def specimen(self):
        return self.law, self.seed, self.degrees, self.domain, self.pressure

    @property
    def name(self):
        name = f"{self.kind}_{self.law}_{self.domain}_{self.degrees}deg_{self.pressure}kPa_s{self.seed}"
        return name + (f"_csr{self.ratio:g}" if self.ratio else "")

    @property
    def grains(self):
        return BOX_GRAINS if self.domain == "rigid-box" else CELL_GRAINS

    def scene(self):
        until = {"cycles": CYCLES, "reversals_after_liquefaction": 2}
        stages = {"prepare": [], "cyclic": [cyclic(**until)],
                  "monotonic": [{"kind": "undrained-monotonic", "strain": 0.05}],
                  "shear": [{"kind": "undrained-cyclic-simple-shear", "stress_ratio": self.ratio, "until": until}]}
        return scene_of(self.name, self.grains, self.seed, {
            "domain": self.domain, "pressure": f"{self.pressure} kPa", "preparation_friction": f"{self.degrees} deg"},
            stages[self.kind], edge=".6f", contact=LAWS[self.law] | RESISTANCE)

    def estimated_seconds(self):
        return {"prepare": 10, "cyclic": 60, "monotonic": 60, "shear": 15}[self.kind]


def with_specimens(tests):
    """The tests, each specimen before the first test that needs it."""
    seen, result = set(), []
    for run in tests:
        if run.specimen not in seen:
            seen.add(run.specimen)
            result.append(dataclasses.replace(run, kind="prepare", ratio=0))
        result.append(run)
    return result


def runs(options):
    """In an order in which a campaign cut short has a part of everything."""
    seeds = range(1, options.seeds + 1)
    both = [(law, seed) for seed in seeds for law in LAWS]
    tests = [Run("cyclic", law, seed, degrees) for degrees in PAPER_DEGREES for law, seed in both]
    tests += [Run("monotonic", law, seed, DENSE_DEGREES) for law, seed in both]
    tests += [Run("shear", law, seed, SHEAR_DEGREES, "periodic-cell", pressure, RATIOS[law][k])
              for k in range(4) for pressure in PRESSURES for law, seed in both]
    return with_specimens(tests)


def rows_of(store, runs, kinds):
    """One row of each finished run of these kinds."""
    rows = []
    for run in runs:
        if run.kind not in kinds or not store.is_done(run):
            continue
        summary = parsed(store.folder(run))
        onset = summary["liquefaction"] or {}
        row = {"law": run.law, "seed": run.seed, "prepared at (deg)": run.degrees, "e": summary["void_ratio"],
               "p0' (kPa)": run.pressure}
        if run.kind == "monotonic":
            history = History(store.folder(run))
            last = int(np.argmin(np.abs(history.eps_y - history.eps_y[0] - 0.05)))
            row |= {"least p' (kPa)": history.p.min() / 1e3, "p' at 5 % (MPa)": history.p[last] / 1e6,
                    "q/p' at 5 %": history.q[last] / history.p[last]}
        else:
            row |= {"CSR": run.ratio or 0.15, "cycles": onset.get("cycle", np.nan),
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
    for law in LAWS:
        for seed in sorted({row["seed"] for row in rows}):
            at = {pressure: [row for row in rows if (row["law"], row["seed"], row["p0' (kPa)"])
                             == (law, seed, pressure)] for pressure in PRESSURES}
            ratios = {pressure: resistance_at(some) for pressure, some in at.items() if some}
            for pressure, ratio in ratios.items():
                table.append({"law": law, "seed": seed, "p0' (kPa)": pressure, "e": at[pressure][0]["e"],
                              "CSR at 15 cycles": ratio, "extrapolated": outside(at[pressure]),
                              "K_sigma": ratio / ratios.get(100, np.nan)})
    return table


def mean(rows, column, **where):
    """(mean, standard error, number) over the seeds of the rows with these values."""
    middle, _, error, n = ensemble([row[column] for row in rows if all(row[k] == v for k, v in where.items())])
    return middle, error, n


def draw_paper(rows, path):
    figure, axes = panels(1, 2)
    for law in LAWS:
        of_law = [row for row in rows if row["law"] == law]
        e, n = (np.array([row[name] for row in of_law]) for name in ("e", "cycles"))
        spared = ~np.isfinite(n)
        axes[0, 0].plot(e, n, "o", color=COLOURS[law], markersize=4, label=LABELS[law])
        axes[0, 0].plot(e[spared], np.full(spared.sum(), CYCLES), "^", color=COLOURS[law], markersize=4,
                        markerfacecolor="none")
        axes[0, 1].plot(e, [row["I_R at onset"] for row in of_law], "o", color=COLOURS[law], markersize=4)
    plain_logarithm(axes[0, 0].yaxis)
    axes[0, 0].axhline(17, color=RED, linewidth=0.8, linestyle="--", label="the paper: 17")
    axes[0, 0].set(xlabel="Void ratio (box)", ylabel="Cycles to liquefaction (triangles: none)")
    axes[0, 0].legend()
    axes[0, 1].axhline(1, color=RED, linewidth=0.8, linestyle="--")
    axes[0, 1].set(xlabel="Void ratio (box)", ylabel="$I_R$ at the onset", ylim=(0, 1.4))
    save(figure, path)


def draw_resistance(rows, ratios, path):
    figure, axes = panels(1, 2)
    for law in LAWS:
        for pressure, marker in zip(PRESSURES, "osD^"):
            of = [row for row in rows if (row["law"], row["p0' (kPa)"]) == (law, pressure)]
            axes[0, 0].plot([row["cycles"] for row in of], [row["CSR"] for row in of], marker, color=COLOURS[law],
                            markersize=4, markerfacecolor="none", label=f"{LABELS[law]}, {pressure} kPa")
        found = [mean(ratios, "K_sigma", law=law, **{"p0' (kPa)": p}) for p in PRESSURES]
        means, errors, _ = np.transpose(found)
        axes[0, 1].errorbar(PRESSURES, means, np.nan_to_num(errors), color=COLOURS[law], marker="o", markersize=4,
                            linewidth=1, capsize=2, label=LABELS[law])
    plain_logarithm(axes[0, 0].xaxis)
    axes[0, 0].set(xlabel="Cycles to liquefaction", ylabel=r"$\tau_{amp}/\sigma_{v0}^\prime$", ylim=(0.13, 0.32))
    axes[0, 0].legend(fontsize=6, ncols=2, loc="upper right")
    axes[0, 1].set_xscale("log")
    axes[0, 1].xaxis.set_major_locator(FixedLocator(PRESSURES))
    axes[0, 1].xaxis.set_major_formatter("{x:g}")
    axes[0, 1].xaxis.set_minor_formatter(NullFormatter())
    axes[0, 1].axhline(1, color="#777777", linewidth=0.6)
    axes[0, 1].set(xlabel=r"$\sigma_{v0}^\prime$ (kPa)", ylabel=r"$K_\sigma$")
    axes[0, 1].legend()
    save(figure, path)


def report(store, planned, folder):
    paper, shear, monotonic = (rows_of(store, planned, kinds) for kinds in (("cyclic",), ("shear",), ("monotonic",)))
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
    for degrees in sorted(PAPER_DEGREES):
        for law in LAWS:
            where = {"law": law, "prepared at (deg)": degrees}
            if any(all(row[k] == v for k, v in where.items()) for row in paper):
                print(degrees, law, *(f"{c}: {m:.3g} ± {s:.2g} ({n})" for c in
                                      ("e", "cycles", "strain before (%)", "I_R at onset", "least I_R")
                                      for m, s, n in [mean(paper, c, **where)]))
    for pressure in PRESSURES:
        for law in LAWS:
            print(pressure, law, *(f"{c}: {m:.3f} ± {s:.2g} ({n})" for c in ("e", "CSR at 15 cycles", "K_sigma")
                                   for m, s, n in [mean(ratios, c, law=law, **{"p0' (kPa)": pressure})]))
    for law in LAWS:
        print(law, *(f"{c}: {m:.4g} ± {s:.2g} ({n})" for c in ("e", "least p' (kPa)", "p' at 5 % (MPa)", "q/p' at 5 %")
                     for m, s, n in [mean(monotonic, c, law=law)]))

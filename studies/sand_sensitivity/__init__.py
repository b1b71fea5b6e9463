# SPDX-License-Identifier: BSD-3-Clause
"""Which parameter of a contact law moves which observable of sand, next to the scatter of packings."""
import dataclasses
import itertools

import matplotlib.pyplot as plt
import numpy as np

from studies.drawing import GREY, save
from studies.ensembles import STUDENT, ensemble
from studies.sand_sensitivity import measure
from studies.tables import write_csv

DEFAULTS, QUICK = {"seeds": 3}, {"seeds": 1}
FACTOR = 1.4  # each parameter over and times this
SHARED = {"friction": 0.466, "rolling.stiffness": 0.3, "rolling.limit": 0.1, "twisting.stiffness": 0.3,
          "preparation": 0.268}  # frictions as tangents: 25 and 15 deg
LAWS = {"linear-rolling": SHARED | {"young": 1.0, "stiffness_ratio": 0.3},  # moduli in GPa
        "hertz-mindlin": SHARED | {"young": 38.0, "poisson": 0.25},
        "opened": {"friction": 0.466, "rolling.limit": 0.1, "young": 38.0, "preparation": 0.07,  # 4 deg
                   "expansion": 0.005}}  # of Hertz-Mindlin contacts, too, denser and fewer
PARAMETERS = {"friction": "contact friction", "rolling.limit": "rolling limit",
              "rolling.stiffness": "rolling stiffness", "twisting.stiffness": "twisting stiffness",
              "young": "modulus E", "stiffness_ratio": "$k_s/k_n$",
              "poisson": "Poisson's ratio", "preparation": "preparation friction",
              "expansion": "expansion"}
OBSERVABLES = {"e": "void ratio", "G": "G, small strain", "exponent of G": "exponent of G",
               "peak friction": "peak $\\varphi$",
               "critical friction": "critical $\\varphi$", "dilatancy": "dilatancy", "contraction": "contraction",
               "least p'": "least $p'$, undrained", "cycles": "cycles to liquefaction",
               "strain per cycle": "strain per cycle after"}
TITLES = {"linear-rolling": "linear", "hertz-mindlin": "Hertz-Mindlin", "opened": "Hertz-Mindlin, opened packings"}


@dataclasses.dataclass(frozen=True)
class Run:
    """One packing with one parameter over (-1) or times (1) FACTOR; 0 with all as they are."""

    law: str
    seed: int
    parameter: str = ""
    side: int = 0
    kind: str = "tests"

    @property
    def name(self):
        changed = f"_{self.parameter}_{'up' if self.side > 0 else 'down'}" if self.side else ""
        return f"{self.law}_s{self.seed}{changed}"

    function = staticmethod(measure.observe)

    def arguments(self):
        law = "hertz-mindlin" if self.law == "opened" else self.law
        value = LAWS[law] | {
            name: x * (FACTOR**self.side if name == self.parameter else 1) for name, x in LAWS[self.law].items()}
        stiffness = {name: value[name] for name in ("stiffness_ratio", "poisson") if name in value}
        contact = {"law": law, "young": f"{value['young']:.6g} GPa", **stiffness,
                   "friction": f"{value['friction']:.6g} tan",
                   "rolling": {"stiffness": value["rolling.stiffness"], "limit": value["rolling.limit"]},
                   "twisting": {"stiffness": value["twisting.stiffness"]}}
        return {"seed": self.seed, "contact": contact, "preparation": f"{value['preparation']:.6g} tan",
                "expansion": value.get("expansion", 0)}

    def estimated_seconds(self):
        return 10


def runs(options):
    """A seed after the other, so that a campaign cut short has all of some. Hertz-Mindlin, which costs three times as
    much, has one fewer."""
    return [run for law in LAWS for seed in range(1, max(1, options.seeds - (law != "linear-rolling")) + 1)
            for run in (Run(law, seed), *(Run(law, seed, name, side) for name in LAWS[law] for side in (-1, 1)))]


def changes_of(found, law, parameter, observable):
    """S of each seed, see sensitivities()."""
    pairs = np.array([[found[law, seed, parameter, side][observable] for side in (-1, 1)]
                      for which, seed, name, side in found
                      if (which, name, side) == (law, parameter, -1) and (law, seed, parameter, 1) in found])
    pairs = pairs[np.isfinite(pairs).all(axis=1)] if len(pairs) else np.empty((0, 2))
    return (pairs[:, 1] - pairs[:, 0]) / (2 * np.log(FACTOR) * abs(pairs.mean())) if len(pairs) else np.empty(0)


def sensitivities(found):
    """One row for each law, parameter and observable O: S = (O+ - O-)/(2 ln f (O+ + O-)/2), as a mean over the seeds,
    with half its 95 % interval; the denominator is that of all seeds. Of O ~ x^n it is
    tanh(n ln f)/ln f, nearly n, and never above 1/ln f = 2.97. The variance between seeds, of which there are few, is
    that of all parameters of the law together.

    found: observables by (law, seed, parameter, side)
    """
    rows = []
    for law, observable in itertools.product(LAWS, OBSERVABLES):
        base = [o[observable] for (which, _, _, side), o in found.items() if which == law and side == 0]
        level, spread, _, _ = ensemble(base)
        changes = {name: values for name in LAWS[law] if len(values := changes_of(found, law, name, observable))}
        freedom = sum(len(values) - 1 for values in changes.values())
        squares = sum(float(np.sum((values - values.mean())**2)) for values in changes.values())
        deviation = np.sqrt(squares / freedom) if freedom else np.nan
        student = STUDENT[max(n for n in STUDENT if n <= max(2, freedom + 1))]
        rows += [{"law": law, "observable": observable, "parameter": name, "S": values.mean(),
                  "interval": student * deviation / np.sqrt(len(values)), "seeds": len(values),
                  "observable, mean": level, "observable, s.d. over seeds": spread} for name, values in changes.items()]
    return rows


def is_seen(row):
    """Whether the sensitivity differs from 0 by more than its interval."""
    return abs(row["S"]) > row["interval"]


def draw(rows, path):
    """A map of each law: colour where a parameter is seen, grey where the interval holds 0."""
    laws = [law for law in LAWS if any(row["law"] == law for row in rows)]
    figure, axes = plt.subplots(len(laws), 1, figsize=(4.6, 3.7 * len(laws)), layout="constrained", squeeze=False)
    for axis, law in zip(axes.flat, laws):
        of_law = {(row["observable"], row["parameter"]): row for row in rows if row["law"] == law}
        names = [name for name in PARAMETERS if name in LAWS[law]]
        for y, observable in enumerate(OBSERVABLES):
            for x, name in enumerate(names):
                row = of_law.get((observable, name))
                seen = row is not None and is_seen(row)
                face = plt.cm.RdBu_r(0.5 + 0.5 * np.clip(row["S"] / 2, -1, 1)) if seen else "#e4e4e4"
                axis.add_patch(plt.Rectangle((x - 0.5, y - 0.5), 1, 1, facecolor=face, edgecolor="white"))
                dark = seen and abs(row["S"]) > 1.2
                number = "" if row is None else f"{row['S']:.2f}".replace("-0.00", "0.00")
                axis.text(x, y, number, ha="center", va="center", fontsize=7,
                          color="white" if dark else "black" if seen else GREY)
        axis.set(xlim=(-0.5, len(names) - 0.5), ylim=(len(OBSERVABLES) - 0.5, -0.5), title=TITLES[law])
        axis.set_xticks(range(len(names)), [PARAMETERS[name] for name in names], rotation=35, ha="right")
        axis.set_yticks(range(len(OBSERVABLES)), list(OBSERVABLES.values()))
        axis.grid(False)
        axis.tick_params(length=0)
    save(figure, path)


def report(store, planned, folder):
    found = {(run.law, run.seed, run.parameter, run.side): store.run(run).result["observables"]
             for run in planned if store.is_done(run)}
    rows = sensitivities(found)
    if rows:
        write_csv(folder / "sensitivities.csv", rows)
        draw(rows, folder / "sensitivities.png")
    for law in LAWS:
        for observable in OBSERVABLES:
            of = sorted((row for row in rows if (row["law"], row["observable"]) == (law, observable)),
                        key=lambda row: -abs(row["S"]))
            if of:
                level, spread = (of[0][f"observable, {which}"] for which in ("mean", "s.d. over seeds"))
                print(f"{law}, {observable} ({level:.3g} ± {spread:.2g}): " + "; ".join(
                    f"{row['parameter']} {row['S']:.2f} ± {row['interval']:.2f}" for row in of if is_seen(row)))

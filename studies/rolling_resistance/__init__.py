# SPDX-License-Identifier: BSD-3-Clause
"""Which resistance to rolling and twisting gives both the critical slope and the cycles of the paper at D_r = 0.64.

One box of each seed is prepared under the law of the paper, from which the tests are run under all laws; others are
prepared under the law of their test.
"""
import dataclasses
import pathlib

import numpy as np

import isostat
from studies.history import History
from studies.scenes import cloud_edge
from studies.tables import write_tables

DEFAULTS, QUICK = {"seeds": 5}, {"seeds": 1}
FEW, MANY = 2000, 10_000  # grains; the seed of MANY is the first
PAGE = "paper"
# eta_r (0: no moments of rolling), and whether twisting is resisted; the paper's comes first
LAWS = tuple((limit, twisting) for limit in (0.5, 0.1, 0.05, 0.02, 0) for twisting in (True, False))
PAPERS = LAWS[0]
OF_MANY = tuple(law for law in LAWS if not law[1] or law[0] in (PAPERS[0], 0))  # laws under which MANY are tested
CYCLES = 60
STAGES = {"cyclic": {"kind": "undrained-cyclic", "deviator_amplitude": "60 kPa",
                     "until": {"cycles": CYCLES, "reversals_after_liquefaction": 0}},
          "compression": {"kind": "undrained-monotonic", "strain": 0.2, "strain_rate": "7.7 1/s"}}  # I = 4e-4
SECONDS = {"prepare": 20, "cyclic": 15, "compression": 60}  # of FEW


def contact(limit, twisting):
    law = {"young": "10 GPa", "stiffness_ratio": 0.3, "friction": "18 deg"}
    if limit:
        law["rolling"] = {"stiffness": 0.3, "limit": limit}
    return law | ({"twisting": {"stiffness": 0.3}} if twisting else {})


def name_of(law):
    limit, twisting = law
    return f"{limit:g}_{'twisting' if twisting else 'free'}"


def prepare_box(results, grains, seed, law):
    """The box of a seed, of D_r = 0.64 under a law."""
    made = isostat.prepare(isostat.Scene(
        contact=contact(*law),
        grading={"curve": "karlsruhe-fine-sand", "grains": grains, "seed": seed,
                 "cloud_edge": cloud_edge(grains, ".12g")},
        specimen={"domain": "rigid-box", "pressure": "200 kPa", "relative_density": 0.64, "e_min": 0.568,
                  "e_max": 0.841}), cache=results.parent / "specimens", threads=1)
    isostat.write_specimen(results / "specimen.h5", made, overwrite=True)
    return {"void_ratio": made.numbers["void_ratio"]}


@dataclasses.dataclass(frozen=True)
class Specimen:
    output: pathlib.Path  # folder of the study
    grains: int
    seed: int
    law: tuple = PAPERS  # it is made under
    kind = "prepare"
    function = staticmethod(prepare_box)

    @property
    def name(self):
        return f"specimen{'' if self.law == PAPERS else '_' + name_of(self.law)}_n{self.grains}_s{self.seed}"

    @property
    def specimen(self):
        return self

    @property
    def file(self):
        return self.output / "runs" / self.name / "specimen.h5"

    def arguments(self):
        return {"grains": self.grains, "seed": self.seed, "law": self.law}

    def estimated_seconds(self):
        return estimate(self.kind, self.grains)


@dataclasses.dataclass(frozen=True)
class Test:
    kind: str  # cyclic, compression
    specimen: Specimen
    law: tuple

    @property
    def own(self):
        """Whether its box was made under its law, which is not the paper's."""
        return self.specimen.law != PAPERS

    @property
    def name(self):
        return (f"{self.kind}{'_own' if self.own else ''}_{name_of(self.law)}_n{self.specimen.grains}"
                f"_s{self.specimen.seed}")

    def scene(self):
        if not self.specimen.file.is_file():
            return None
        return isostat.Scene(title=self.name, contact=contact(*self.law), stage=[STAGES[self.kind]],
                             specimen={"domain": "rigid-box", "file": str(self.specimen.file)},
                             output={"snapshots": "none", "paraview": False})

    def estimated_seconds(self):
        return estimate(self.kind, self.specimen.grains)


def estimate(kind, grains):
    return SECONDS[kind] * (grains / FEW) ** 1.33


def runs(options):
    boxes = [Specimen(options.output, FEW, seed) for seed in range(1, options.seeds + 1)]
    own = [Specimen(options.output, FEW, seed, law) for seed in range(1, 1 + min(options.seeds, 3)) for law in LAWS[1:]]
    many = [] if options.quick else [Specimen(options.output, MANY, 1)]
    return [*boxes, *own, *(Test("cyclic", box, box.law) for box in own), *many,
            *(Test("cyclic", box, law) for box in boxes for law in LAWS),
            *(Test("cyclic", box, law) for box in many for law in OF_MANY),
            *(Test("compression", boxes[0], law) for law in LAWS)]


def found(store, run):
    """The number of cycles (infinite if there was no onset), or q/p' averaged over the last tenth of the strain."""
    history = History(store.folder(run))
    if run.kind == "cyclic":
        onset = history.summary["liquefaction"]
        return onset["cycle"] if onset else np.inf
    late = history.eps_y > 0.9 * history.eps_y[-1]
    return float(np.mean(history.q[late] / history.p[late]))


def report(store, planned, folder):
    values = {}
    for run in planned:
        if run.kind != "prepare" and store.is_done(run):
            law = values.setdefault((run.specimen.grains, *run.law, run.own), {})
            law.setdefault(run.kind, []).append(found(store, run))
    write_tables(folder, {"rolling_resistance": (
        ["grains", "eta_r", "twisting", "box made under", "q/p' at 18 to 20 % (one box)",
         f"liquefied in {CYCLES} cycles", "cycles, median"], [row(*case, **one) for case, one in values.items()])})


def row(grains, limit, twisting, own, cyclic, compression=()):
    median = np.median(cyclic)
    return [grains, f"{limit:g}", "yes" if twisting else "no", "this law" if own else "the paper's",
            *([f"{slope:.3f}" for slope in compression] or [""]), f"{np.isfinite(cyclic).sum()} of {len(cyclic)}",
            f"{median:.1f}" if np.isfinite(median) else f"> {CYCLES}"]

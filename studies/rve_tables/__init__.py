# SPDX-License-Identifier: BSD-3-Clause
"""Undrained simple shear of periodic packings: rotation of principal stresses, effect of the twisting stiffness."""
import dataclasses

import numpy as np

import isostat
from studies.scenes import cloud_edge
from studies.tables import write_tables

DEFAULTS, QUICK = {"seeds": 3, "grains": 1000}, {"seeds": 1, "grains": 200}
INCREMENTS, PRESSURE = 40, 200e3
CONTACT = {"young": "10 GPa", "friction": "18 deg", "rolling": {"stiffness": 0.3, "limit": 0.5}}
TWISTING = {"twisting": {"stiffness": 0.3}}  # of preparation


def accepted(response):
    if not response:
        raise RuntimeError(response.reason)


def state(rve):
    """Stresses in kPa, and the void ratio."""
    stress = rve.stress / 1e3
    return {"shear": stress[0, 1], "mean": -np.trace(stress) / 3, "vertical": -stress[1, 1], "lateral": -stress[0, 0],
            "e": rve.void_ratio}


def shear(results, sections, twisting, strains):
    """States at each gamma of u_x = gamma y, the first before shearing, and the speed of shear waves then."""
    cache = results.parent / "specimens"
    specimen = isostat.prepare(isostat.Scene(sections), cache=cache)
    if twisting is not None:
        contact = CONTACT | ({"twisting": {"stiffness": twisting}} if twisting else {})
        scene = isostat.Scene(sections, contact=contact, stage=[{"kind": "rebalance"}])
        specimen = isostat.run(scene, specimen=specimen, cache=cache, quiet=True)
    rve, controlled, gradient = isostat.Rve(specimen.snapshot), np.ones((3, 3), dtype=bool), np.zeros((3, 3))
    # preparation in an upright cell leaves shear stresses, some per cent of p'
    controlled[0, 0] = controlled[2, 2] = sections["specimen"]["consolidation"] == "isotropic"
    accepted(rve.mixed(gradient, -PRESSURE * np.eye(3), controlled))
    speed = np.sqrt(np.trace(rve.stiffness()[3:, 3:]) / 3 / rve.dry_density)
    states = [state(rve)]
    for last, gamma in zip([0, *strains], strains):
        gradient[0, 1] = (gamma - last) / INCREMENTS
        for _ in range(INCREMENTS):
            accepted(rve.undrained(gradient))
        states.append(state(rve))
    return {"states": states, "speed": float(speed)}


@dataclasses.dataclass(frozen=True)
class Run:
    kind: str  # rotation, or twisting
    grains: int
    degrees: int  # of preparation friction
    seed: int = 1
    consolidation: str = "isotropic"
    twisting: float | None = None  # alpha_t, which the paper does not give
    function = staticmethod(shear)

    @property
    def name(self):
        variant = self.consolidation if self.twisting is None else self.twisting
        return f"{self.kind}_{variant}_s{self.seed}_n{self.grains}"

    @property
    def strains(self):
        return [1e-5, 1e-4, 1e-3, 1e-2, 0.05, 0.2] if self.kind == "rotation" else [1e-3, 1e-2, 0.05]

    def arguments(self):
        return {"twisting": self.twisting, "strains": self.strains, "sections": {
            "grading": {"grains": self.grains, "cloud_edge": cloud_edge(self.grains), "seed": self.seed},
            "contact": CONTACT | TWISTING,
            "specimen": {"domain": "periodic-cell", "consolidation": self.consolidation,
                         "preparation_friction": f"{self.degrees} deg"}}}

    def estimated_seconds(self):
        return 60 * self.grains / 1000


def add_options(line):
    line.add_argument("--grains", type=int, help="of a packing (default 1000)")


def runs(options):
    rotation = [Run("rotation", options.grains, 8, consolidation=name) for name in ("isotropic", "k0")]
    return rotation + [Run("twisting", options.grains, 7, seed, twisting=alpha) for alpha in (0, 0.1, 0.3, 1, 2)
                       for seed in range(1, options.seeds + 1)]


def report(store, planned, folder):
    done = [(run, store.run(run).result) for run in planned if store.is_done(run)]
    tables = {f"rotation_{run.consolidation}": rotation(run, result) for run, result in done if run.kind == "rotation"}
    for run, first in ((run, result["states"][0]) for run, result in done if run.kind == "rotation"):
        print(f"{run.consolidation}: e = {first['e']:.3f}, K0 = {first['lateral'] / first['vertical']:.2f}")
    alphas = dict.fromkeys(run.twisting for run, _ in done if run.kind == "twisting")
    header = ["α_t", *(f"{stress} at {strain} %, kPa" for stress in ("τ", "p'") for strain in ("0.1", "1", "5")),
              "V_s, m/s"]
    tables["twisting"] = header, [twisting(alpha, [r for run, r in done if run.twisting == alpha]) for alpha in alphas]
    write_tables(folder, tables)


def rotation(run, result):
    """The tilt is that of the largest compression from the vertical; the strain increment has its own at 45 degrees."""
    rows = []
    for gamma, s in zip([0, *run.strains], result["states"]):
        difference = (s["vertical"] - s["lateral"]) / 2
        rows.append([f"{gamma:g}", f"{s['shear']:.2f}", f"{s['mean']:.1f}", f"{s['vertical']:.1f}",
                     f"{np.hypot(s['shear'], difference) / s['mean']:.3f}",
                     f"{np.degrees(np.arctan2(s['shear'], difference)) / 2:.1f}", "45"])
    return ["γ", "τ, kPa", "p', kPa", "σ'_y, kPa", "(σ'_1 − σ'_3)/2p'", "σ'_1 from vertical, °",
            "dε_1 from vertical, °"], rows


def twisting(alpha, results):
    """Mean and standard deviation over the packings."""
    values = np.array([[*(s[name] for name in ("shear", "mean") for s in result["states"][1:]), result["speed"]]
                       for result in results])
    spread = values.std(axis=0, ddof=1) if len(values) > 1 else np.zeros(values.shape[1])
    return [f"{alpha:g}", *(f"{m:.1f} ± {s:.1f}" for m, s in zip(values.mean(axis=0), spread))]

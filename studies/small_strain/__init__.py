# SPDX-License-Identifier: BSD-3-Clause
"""Stiffness against pressure, wave speed against depth, modulus reduction and damping, with both contact laws."""
import dataclasses

import matplotlib.pyplot as plt
import numpy as np

from studies.drawing import save
from studies.ensembles import mean_and_error, text_of
from studies.small_strain import measure, published
from studies.tables import write_tables

LAWS = {
    "linear-rolling": {"young": "10 GPa"},
    "hertz-mindlin": {"law": "hertz-mindlin"},
}
STIFFNESS_LAWS = {**LAWS, "asperities": {"law": "hertz-mindlin", "exponent": 1.65, "asperity": 0.1}}
DEGREES = (2, 6, 10)  # of preparation friction, in `stiffness`: dense to loose
REDUCTION_DEGREES = 8
GROUND = {  # of deposits: contact parameters that give shear waves of some 150 m/s in 5 m of depth
    "linear-rolling": {"young": "1 GPa"},
    "hertz-mindlin": {"law": "hertz-mindlin", "young": "38 GPa"},
}
REDUCTION_PRESSURES = (25, 100, 400)
AMPLITUDES = (1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3)
COLOURS = {"linear-rolling": "tab:blue", "hertz-mindlin": "tab:red", "asperities": "tab:green"}
LOST = 0.05  # G/G_max below which a cycle is that of a liquid: its damping ratio means nothing
NAMES = {"linear-rolling": "linear law, E = 10 GPa", "hertz-mindlin": "Hertz-Mindlin, quartz",
         "asperities": "quartz with asperities, n = 1.65"}


@dataclasses.dataclass(frozen=True)
class Run:
    """One packing under one loading."""
    kind: str
    law: str
    degrees: int
    seed: int
    pressure: int = 20          # kPa; of `stiffness` the first one
    amplitude: float = 0        # of gamma
    grains: int = 1000

    @property
    def name(self):
        name = f"{self.kind}_{self.law}_{self.degrees}deg_seed{self.seed}"
        if self.kind == "reduction":
            name += f"_{self.pressure}kPa_{self.amplitude:.0e}"
        return name

    @property
    def function(self):
        return getattr(measure, self.kind)

    def arguments(self):
        laws = GROUND if self.kind == "velocity" else STIFFNESS_LAWS
        return {"run": dataclasses.asdict(self), "contact": laws[self.law]}

    def estimated_seconds(self):
        seconds = {"stiffness": 15, "velocity": 10, "reduction": 5 + 60 * min(1, self.amplitude / 1e-3)}
        return seconds[self.kind] * self.grains / 1000


def stiffness(seeds, grains, _):
    return [Run("stiffness", law, degrees, seed, grains=grains) for seed in range(1, seeds + 1) for degrees in DEGREES
            for law in STIFFNESS_LAWS]


def velocity(seeds, grains, _):
    return [Run("velocity", law, 10, seed, 10, grains=grains) for seed in range(1, seeds + 1) for law in LAWS]


def reduction(seeds, grains, amplitudes):
    return [Run("reduction", law, REDUCTION_DEGREES, seed, pressure, amplitude, grains)
            for seed in range(1, seeds + 1) for amplitude in amplitudes for pressure in REDUCTION_PRESSURES
            for law in LAWS]


PARTS = {"stiffness": stiffness, "velocity": velocity, "reduction": reduction}
DEFAULTS = {"seeds": 3, "grains": 1000, "parts": list(PARTS), "amplitudes": AMPLITUDES}
QUICK = {"seeds": 1, "grains": 200, "amplitudes": [1e-4]}


def add_options(line):
    line.add_argument("--grains", type=int, help="of a packing (default 1000)")
    line.add_argument("--amplitudes", type=float, nargs="+", help="of shear strain (default: 1e-5 to 3e-3)")
    line.add_argument("--parts", nargs="+", choices=PARTS, help="default: all")


def runs(options):
    given = options.seeds, options.grains, options.amplitudes
    return [run for part in options.parts for run in PARTS[part](*given)]


def read(store, planned, kind):
    """All results of a kind, as dictionaries."""
    results = [store.run(run).result for run in planned if run.kind == kind and store.is_done(run)]
    return [{**result["call"]["arguments"]["run"], **result} for result in results]


def text(values, digits, factor=1.0):
    """"184 ± 3"."""
    return text_of(*mean_and_error(np.asarray(values) * factor), digits) if len(values) else "not run"


# ---- stiffness against pressure
def exponent(states, low, high):
    """n of G ~ p^n by least squares in logarithms between two pressures, Pa."""
    points = [(s["mean_stress"], s["shear_modulus"]) for s in states if low <= s["mean_stress"] <= high]
    p, g = np.log(np.array(points)).T
    return np.polyfit(p, g, 1)[0]


def stiffness_table(results):
    """Rows of moduli, exponent and void ratio for each law and preparation."""
    rows = []
    for law in STIFFNESS_LAWS:
        for degrees in DEGREES:
            states = [r["states"] for r in results if (r["law"], r["degrees"]) == (law, degrees)]
            if not states:
                continue
            at = [next(s for s in one if abs(s["mean_stress"] / 100e3 - 1) < 0.02) for one in states]
            published_g = [published.small_strain_modulus(s["void_ratio"], 100e3) for s in at]
            rows.append([NAMES[law], f"{degrees}°", text([s["void_ratio"] for s in at], 3),
                         text([s["coordination"] for s in at], 2), text([s["shear_modulus"] for s in at], 0, 1e-6),
                         text(published_g, 0, 1e-6), text([exponent(one, 15e3, 900e3) for one in states], 3)])
    return ["law", "prepared at", "e at 100 kPa", "Z at 100 kPa", "G at 100 kPa, MPa", "correlation, MPa",
            "n, 20 to 800 kPa"], rows


def draw_stiffness(results, path):
    """G against p' for each law and density, next to the correlation at the same void ratios."""
    figure, axes = plt.subplots(1, len(STIFFNESS_LAWS), figsize=(11, 3.6), layout="constrained", sharey=True)
    for axis, law in zip(axes, STIFFNESS_LAWS, strict=True):
        for degrees, shade in zip(DEGREES, (1.0, 0.65, 0.35), strict=True):
            states = [r["states"] for r in results if (r["law"], r["degrees"]) == (law, degrees)]
            if not states:
                continue
            p = np.array([[s["mean_stress"] for s in one] for one in states]).mean(axis=0)
            g = np.array([[s["shear_modulus"] for s in one] for one in states])
            e = np.array([[s["void_ratio"] for s in one] for one in states]).mean(axis=0)
            error = g.std(axis=0, ddof=1) / np.sqrt(len(g)) if len(g) > 1 else None
            axis.errorbar(p / 1e3, g.mean(axis=0) / 1e6, None if error is None else error / 1e6, fmt="o-", ms=3.5,
                          color=COLOURS[law], alpha=shade, label=f"e = {e[0]:.2f}")
            axis.plot(p / 1e3, published.small_strain_modulus(e, p) / 1e6, "--", color="black", lw=0.9, alpha=shade)
        axis.set(xscale="log", yscale="log", xlabel="p' (kPa)", title=NAMES[law])
        axis.legend(frameon=False, fontsize=8, title="dashed: resonant column", title_fontsize=8)
        axis.grid(alpha=0.3, which="both", lw=0.4)
    axes[0].set_ylabel("shear modulus G (MPa)")
    save(figure, path, dpi=130)


# ---- wave speed against depth
def velocity_rows(results, law):
    """Depth, V_s of each seed, and V_s of the correlation at the packings' void ratio and mean stress, m/s."""
    runs = [r["states"] for r in results if r["law"] == law]
    for at in zip(*runs, strict=True):
        target = [np.sqrt(published.small_strain_modulus(s["void_ratio"], s["mean_stress"]) / 1970) for s in at]
        yield at[0]["depth"], [s["velocity"] for s in at], target


def velocity_table(results):
    """V_s of both laws and of the correlation, one row for each depth."""
    rows = [[str(linear[0]), *(cell for _, v, target in (linear, hertz)
                               for cell in (text(v, 0), text(np.array(v) / np.array(target), 2)))]
            for linear, hertz in zip(*(velocity_rows(results, law) for law in LAWS), strict=True)]
    return ["depth, m", "linear law, 1 GPa, m/s", "over the correlation", "Hertz-Mindlin, 38 GPa, m/s",
            "over the correlation"], rows


def draw_velocity(results, path):
    """V_s over depth next to the correlation."""
    figure, axis = plt.subplots(figsize=(4.4, 4.4), layout="constrained")
    for law in LAWS:
        depth, speeds, target = (np.array(x) for x in zip(*velocity_rows(results, law), strict=True))
        axis.errorbar(speeds.mean(axis=1), depth, xerr=[mean_and_error(values)[1] for values in speeds],
                      fmt="o-", ms=3.5, color=COLOURS[law], label=f"{law}, {GROUND[law]['young']}")
    axis.plot(target.mean(axis=1), depth, "--", color="black", lw=1, label="resonant column")
    axis.fill_betweenx(depth, 0.85 * target.mean(axis=1), 1.15 * target.mean(axis=1), color="0.85", label="within 15 %")
    axis.set(xlabel="shear-wave velocity (m/s)", ylabel="depth (m)", xlim=(0, None), ylim=(21, 0))
    axis.legend(frameon=False, fontsize=8)
    axis.grid(alpha=0.3, lw=0.4)
    save(figure, path, dpi=130)


# ---- modulus reduction and damping
def chosen(results, law, pressure, amplitude):
    """Results of all seeds of one point."""
    return [r for r in results if r["law"] == law and r["pressure"] == pressure
            and abs(r["amplitude"] / amplitude - 1) < 1e-6]


def reduction_table(results):
    """G/G_max and damping ratio, one row for each amplitude."""
    columns = [(law, pressure) for law in LAWS for pressure in REDUCTION_PRESSURES]
    rows = []
    for amplitude in AMPLITUDES:
        cells = []
        for law, pressure in columns:
            runs = chosen(results, law, pressure, amplitude)
            reduction = [r["secant"] / r["shear_modulus"] for r in runs]
            damping = text([r["damping_ratio"] for r in runs], 2, 100) + " %"
            cells.append("" if not runs else text(reduction, 3) + "; " + (damping if min(reduction) > LOST else "lost"))
        if any(cells):
            rows.append([f"{amplitude:.0e}", *cells])
    heads = [f"{'linear' if law == 'linear-rolling' else 'Hertz'}, {pressure} kPa" for law, pressure in columns]
    return ["γ", *heads], rows


def curve(results, law, pressure):
    """Amplitudes that were run, G/G_max and damping with their standard errors."""
    points = []
    for amplitude in AMPLITUDES:
        if runs := chosen(results, law, pressure, amplitude):
            reduction = [r["secant"] / r["shear_modulus"] for r in runs]
            damping = mean_and_error([100 * r["damping_ratio"] for r in runs])
            points.append((amplitude, *mean_and_error(reduction),
                           *(damping if min(reduction) > LOST else (np.nan, np.nan))))
    return np.array(points).T


def draw_reduction(results, path):
    """G/G_max above, damping ratio below, one column for each pressure."""
    figure, axes = plt.subplots(2, len(REDUCTION_PRESSURES), figsize=(10, 5.6), layout="constrained", sharex=True,
                                sharey="row")
    gamma = np.logspace(-6, -2, 200)
    for column, pressure in enumerate(REDUCTION_PRESSURES):
        for name, curves, style in (("Darendeli (2001)", published.darendeli, "-"),
                                    ("Menq (2003)", published.menq, "--")):
            reduction, damping = curves(gamma, 1e3 * pressure)
            axes[0, column].semilogx(gamma, reduction, style, color="0.4", lw=1.2, label=name)
            axes[1, column].semilogx(gamma, 100 * damping, style, color="0.4", lw=1.2)
        for law in LAWS:
            points = curve(results, law, pressure)
            if points.size:
                for row, at in ((0, 1), (1, 3)):
                    axes[row, column].errorbar(points[0], points[at], points[at + 1], fmt="o-", ms=3.5, lw=1,
                                               color=COLOURS[law], label=NAMES[law])
        axes[0, column].set(title=f"p' = {pressure} kPa", ylim=(0, 1.08))
        axes[1, column].set(xlabel="amplitude of shear strain", ylim=(0, None))
        for row in (0, 1):
            axes[row, column].grid(alpha=0.3, lw=0.4)
    axes[0, 0].set_ylabel("G/G_max")
    axes[1, 0].set_ylabel("damping ratio (%)")
    axes[1, -1].legend(*axes[0, 0].get_legend_handles_labels(), loc="upper left", frameon=False, fontsize=8)
    save(figure, path, dpi=130)


def report(store, planned, folder):
    tables = {}
    if stiffness := read(store, planned, "stiffness"):
        draw_stiffness(stiffness, folder / "stiffness.png")
        tables["stiffness"] = stiffness_table(stiffness)
    if velocity := read(store, planned, "velocity"):
        draw_velocity(velocity, folder / "velocity.png")
        tables["velocity"] = velocity_table(velocity)
    if reduction := read(store, planned, "reduction"):
        draw_reduction(reduction, folder / "drained.png")
        tables["drained"] = reduction_table(reduction)
    write_tables(folder, tables)

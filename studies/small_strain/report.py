# SPDX-License-Identifier: BSD-3-Clause
"""Figures and tables of what has been run."""
import matplotlib.pyplot as plt
import numpy as np

from studies.small_strain import plan, published

COLOURS = {"linear-rolling": "tab:blue", "hertz-mindlin": "tab:red", "asperities": "tab:green"}
LOST = 0.05  # G/G_max below which a cycle is that of a liquid: its damping ratio means nothing
NAMES = {"linear-rolling": "linear law, E = 10 GPa", "hertz-mindlin": "Hertz-Mindlin, quartz",
         "asperities": "quartz with asperities, n = 1.65"}


def read(store, planned, kind):
    """All results of a kind, as dictionaries."""
    results = [store.run(run).result for run in planned if run.kind == kind and store.is_done(run)]
    return [{**result["call"]["arguments"]["run"], **result} for result in results]


def mean(values):
    """Mean and its standard error; the error of one value is not known."""
    values = np.asarray(values, dtype=float)
    error = values.std(ddof=1) / np.sqrt(len(values)) if len(values) > 1 else np.nan
    return values.mean(), error


def text(values, digits, factor=1.0):
    """"184 ± 3"."""
    if len(values) == 0:
        return "not run"
    middle, error = mean(np.asarray(values) * factor)
    return f"{middle:.{digits}f}" + ("" if np.isnan(error) else f" ± {error:.{digits}f}")


# ---- stiffness against pressure
def exponent(states, low, high):
    """n of G ~ p^n by least squares in logarithms between two pressures, Pa."""
    points = [(s["mean_stress"], s["shear_modulus"]) for s in states if low <= s["mean_stress"] <= high]
    p, g = np.log(np.array(points)).T
    return np.polyfit(p, g, 1)[0]


def stiffness_table(results):
    """Rows of moduli, exponent and void ratio for each law and preparation."""
    lines = ["| law | prepared at | e at 100 kPa | Z at 100 kPa | G at 100 kPa, MPa | correlation, MPa | "
             "n, 20 to 800 kPa |", "|---|---|---|---|---|---|---|"]
    for law in plan.STIFFNESS_LAWS:
        for degrees in plan.DEGREES:
            states = [r["states"] for r in results if (r["law"], r["degrees"]) == (law, degrees)]
            if not states:
                continue
            at = [next(s for s in one if abs(s["mean_stress"] / 100e3 - 1) < 0.02) for one in states]
            published_g = [published.small_strain_modulus(s["void_ratio"], 100e3) for s in at]
            lines.append(f"| {NAMES[law]} | {degrees}° | {text([s['void_ratio'] for s in at], 3)} | "
                         f"{text([s['coordination'] for s in at], 2)} | "
                         f"{text([s['shear_modulus'] for s in at], 0, 1e-6)} | {text(published_g, 0, 1e-6)} | "
                         f"{text([exponent(one, 15e3, 900e3) for one in states], 3)} |")
    return "\n".join(lines)


def draw_stiffness(results, path):
    """G against p' for each law and density, next to the correlation at the same void ratios."""
    figure, axes = plt.subplots(1, len(plan.STIFFNESS_LAWS), figsize=(11, 3.6), layout="constrained", sharey=True)
    for axis, law in zip(axes, plan.STIFFNESS_LAWS, strict=True):
        for degrees, shade in zip(plan.DEGREES, (1.0, 0.65, 0.35), strict=True):
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
    figure.savefig(path, dpi=130)
    plt.close(figure)


# ---- wave speed against depth
def velocity_rows(results, law):
    """Depth, V_s of each seed, and V_s of the correlation at the packings' void ratio and mean stress, m/s."""
    runs = [r["states"] for r in results if r["law"] == law]
    for at in zip(*runs, strict=True):
        target = [np.sqrt(published.small_strain_modulus(s["void_ratio"], s["mean_stress"]) / 1970) for s in at]
        yield at[0]["depth"], [s["velocity"] for s in at], target


def velocity_table(results):
    """V_s of both laws and of the correlation, one row for each depth."""
    lines = ["| depth, m | linear law, 1 GPa, m/s | over the correlation | Hertz-Mindlin, 38 GPa, m/s | "
             "over the correlation |", "|---|---|---|---|---|"]
    for linear, hertz in zip(*(velocity_rows(results, law) for law in plan.LAWS), strict=True):
        lines.append(f"| {linear[0]} | " + " | ".join(
            f"{text(v, 0)} | {text(np.array(v) / np.array(target), 2)}" for _, v, target in (linear, hertz)) + " |")
    return "\n".join(lines)


def draw_velocity(results, path):
    """V_s over depth next to the correlation."""
    figure, axis = plt.subplots(figsize=(4.4, 4.4), layout="constrained")
    for law in plan.LAWS:
        depth, speeds, target = (np.array(x) for x in zip(*velocity_rows(results, law), strict=True))
        axis.errorbar(speeds.mean(axis=1), depth, xerr=[mean(values)[1] for values in speeds], fmt="o-", ms=3.5,
                      color=COLOURS[law], label=f"{law}, {plan.GROUND[law]['young']}")
    axis.plot(target.mean(axis=1), depth, "--", color="black", lw=1, label="resonant column")
    axis.fill_betweenx(depth, 0.85 * target.mean(axis=1), 1.15 * target.mean(axis=1), color="0.85", label="within 15 %")
    axis.set(xlabel="shear-wave velocity (m/s)", ylabel="depth (m)", xlim=(0, None), ylim=(21, 0))
    axis.legend(frameon=False, fontsize=8)
    axis.grid(alpha=0.3, lw=0.4)
    figure.savefig(path, dpi=130)
    plt.close(figure)


# ---- modulus reduction and damping
def chosen(results, law, pressure, drained, amplitude, damping=plan.DAMPING):
    """Results of all seeds of one point."""
    return [r for r in results if r["law"] == law and r["pressure"] == pressure and r["drained"] == drained
            and r["damping"] == damping and abs(r["amplitude"] / amplitude - 1) < 1e-6]


def reduction_table(results, drained):
    """G/G_max and damping ratio, one row for each amplitude."""
    columns = [(law, pressure) for law in plan.LAWS for pressure in plan.REDUCTION_PRESSURES]
    lines = ["| γ | " + " | ".join(f"{'linear' if law == 'linear-rolling' else 'Hertz'}, {pressure} kPa"
                                   for law, pressure in columns) + " |", "|---|" + "---|" * len(columns)]
    for amplitude in plan.AMPLITUDES:
        cells = []
        for law, pressure in columns:
            runs = chosen(results, law, pressure, drained, amplitude)
            reduction = [r["secant"] / r["shear_modulus"] for r in runs]
            damping = text([r["damping_ratio"] for r in runs], 2, 100) + " %"
            cells.append("" if not runs else text(reduction, 3) + "; " + (damping if min(reduction) > LOST else "lost"))
        if any(cells):
            lines.append(f"| {amplitude:.0e} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def halved_table(results):
    """Damping ratio below 1e-5 with the local damping and with half of it."""
    lines = ["| law | p', kPa | γ | | damping ratio, % | with half the damping of grains | G/G_max | with half |",
             "|---|---|---|---|---|---|---|---|"]
    for law in plan.LAWS:
        for pressure in plan.REDUCTION_PRESSURES:
            for amplitude in [a for a in plan.AMPLITUDES if a <= plan.SMALL]:
                for drained in (True, False):
                    full, half = (chosen(results, law, pressure, drained, amplitude, d)
                                  for d in (plan.DAMPING, plan.DAMPING / 2))
                    if full and half:
                        lines.append(
                            f"| {law} | {pressure} | {amplitude:.0e} | {'drained' if drained else 'undrained'} | "
                            f"{text([r['damping_ratio'] for r in full], 4, 100)} | "
                            f"{text([r['damping_ratio'] for r in half], 4, 100)} | "
                            f"{text([r['secant'] / r['shear_modulus'] for r in full], 4)} | "
                            f"{text([r['secant'] / r['shear_modulus'] for r in half], 4)} |")
    return "\n".join(lines)


def curve(results, law, pressure, drained):
    """Amplitudes that were run, G/G_max and damping with their standard errors."""
    points = []
    for amplitude in plan.AMPLITUDES:
        if runs := chosen(results, law, pressure, drained, amplitude):
            reduction = [r["secant"] / r["shear_modulus"] for r in runs]
            damping = mean([100 * r["damping_ratio"] for r in runs]) if min(reduction) > LOST else (np.nan, np.nan)
            points.append((amplitude, *mean(reduction), *damping))
    return np.array(points).T


def draw_reduction(results, drained, path):
    """G/G_max above, damping ratio below, one column for each pressure."""
    figure, axes = plt.subplots(2, len(plan.REDUCTION_PRESSURES), figsize=(10, 5.6), layout="constrained", sharex=True,
                                sharey="row")
    gamma = np.logspace(-6, -2, 200)
    for column, pressure in enumerate(plan.REDUCTION_PRESSURES):
        for name, curves, style in (("Darendeli (2001)", published.darendeli, "-"),
                                    ("Menq (2003)", published.menq, "--")):
            reduction, damping = curves(gamma, 1e3 * pressure)
            axes[0, column].semilogx(gamma, reduction, style, color="0.4", lw=1.2, label=name)
            axes[1, column].semilogx(gamma, 100 * damping, style, color="0.4", lw=1.2)
        for law in plan.LAWS:
            points = curve(results, law, pressure, drained)
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
    figure.suptitle("drained" if drained else "undrained", fontsize=10)
    figure.savefig(path, dpi=130)
    plt.close(figure)


def write(store, planned, folder):
    """Figures, and tables on stdout."""
    if stiffness := read(store, planned, "stiffness"):
        draw_stiffness(stiffness, folder / "stiffness.png")
        print(stiffness_table(stiffness))
    if velocity := read(store, planned, "velocity"):
        draw_velocity(velocity, folder / "velocity.png")
        print("\n" + velocity_table(velocity))
    if reduction := read(store, planned, "reduction"):
        for drained in (True, False):
            draw_reduction(reduction, drained, folder / f"{'drained' if drained else 'undrained'}.png")
            print(f"\n{'drained' if drained else 'undrained'}: G/G_max; damping ratio\n")
            print(reduction_table(reduction, drained))
        print("\n" + halved_table(reduction))

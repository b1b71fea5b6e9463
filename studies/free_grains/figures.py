# SPDX-License-Identifier: BSD-3-Clause
"""Draws what the tables say."""
import numpy as np

from studies.drawing import panels, save
from studies.ensembles import mean_and_interval
from studies.free_grains import plan

SERIES = (  # label, colour, marker, settings
    ("default, and other rates", "#0072b2", "o", (plan.NUMERICS[0], plan.DEFAULT, plan.SLOW, plan.SLOWEST)),
    ("local damping 0.2 instead of dashpots", "#cc79a7", "v", plan.LOCAL_SETTINGS),
    ("walls push", "#009e73", "^", plan.PUSHED),
    ("rattlers left alone", "#e69f00", "D", plan.ALONE_SETTINGS),
    ("all three", "#d55e00", "s", plan.OLD_SETTINGS))

RATES = ("default rate", "#0072b2", "o"), ("a tenth of it", "#d55e00", "s")


def draw(results, folder):
    draw_cycles(results, folder / "cycles.png")
    draw_damping(results, folder / "damping.png")
    draw_hold(results, folder / "hold.png")


def title(panel, letter, domain):
    panel.set_title(f"({letter}) {domain.replace('-', ' ')}", loc="left")


def draw_cycles(results, path):
    """Cycles against the time steps of a test: mean of the default plus the mean of the paired differences."""
    figure, (axes,) = panels(1, len(plan.DOMAINS), 8.8, 3.5, sharey=True)
    for panel, domain, letter in zip(axes, plan.DOMAINS, "ab"):
        reference = domain, plan.GRAINS, plan.DEFAULT
        if reference not in results.cyclic:
            continue
        base = np.nanmean([t.cycles for t in results.cyclic[reference].values()])
        for label, colour, marker, settings in SERIES:
            keys = [(domain, plan.GRAINS, setting) for setting in settings]
            keys = [key for key in keys if len(results.cyclic.get(key, {})) > 1]
            steps = [np.mean([t.steps for t in results.cyclic[key].values()]) for key in keys]
            found = [mean_and_interval(results.differences(key, reference, lambda t: t.cycles)) for key in keys]
            if found and not (domain != "rigid-box" and "walls push" in label):
                mean, half = np.array(found).T
                panel.errorbar(steps, base + mean, yerr=half, color=colour, marker=marker, capsize=3, label=label)
        panel.set(xscale="log", xlabel="time steps to liquefaction [-]")
        title(panel, letter, domain)
    axes[0].set(ylim=(0, None), ylabel="cycles to liquefaction [-]")
    axes[0].legend(fontsize=7, loc="lower left")
    save(figure, path)


def draw_damping(results, path):
    """Cycles less those of the default on the same specimens (at least three) against local damping. Those of 0.1, of
    which there are more, on the specimens of the other values."""
    both = {**plan.DAMPING, 0.1: [plan.DEFAULT, plan.SLOW]}
    figure, (axes,) = panels(1, len(plan.DOMAINS), 8.8, 3.5, sharey=True)
    for panel, domain, letter in zip(axes, plan.DOMAINS, "ab"):
        reference = domain, plan.GRAINS, plan.DEFAULT
        for rate, (label, colour, marker) in enumerate(RATES):
            keys = {damping: (domain, plan.GRAINS, both[damping][rate]) for damping in sorted(both)}
            seeds = set(results.cyclic.get(keys[0.2], {}))
            rows = [(damping, *mean_and_interval(results.differences(key, reference, lambda t: t.cycles, seeds)))
                    for damping, key in keys.items() if len(results.cyclic.get(key, {})) > 2]
            if rows:
                damping, mean, half = np.array(rows).T
                panel.errorbar(damping, mean, yerr=half, color=colour, marker=marker, capsize=3, label=label)
        panel.axhline(0, color="#888888", lw=0.8)
        panel.set(xlabel="local damping [-]")
        title(panel, letter, domain)
    axes[0].set_ylabel("cycles less those of the default [-]")
    axes[0].legend()
    save(figure, path)


def draw_hold(results, path):
    figure, (axes,) = panels(1, 2, 8.8, 3.5)
    looks = {plan.DEFAULT: ("#0072b2", "damped"), plan.ALONE_SETTINGS[0]: ("#d55e00", "left alone")}
    runs = [run for run in results.of("hold") if run.seed == 1]
    for run in runs:
        steps, lost, energy, _, _ = results.held(run)
        colour, what = looks[run.setting]
        line = "-" if run.domain == "rigid-box" else "--"
        label = f"{run.domain.replace('-', ' ')}, rattlers {what}"
        axes[0].plot(steps, lost, line, color=colour, label=label)
        axes[1].plot(steps, energy, line, color=colour, label=label)
    axes[0].set(xlabel="time steps since loading stopped [-]", ylabel="p' lost [kPa]")
    axes[1].set(xlabel="time steps since loading stopped [-]", ylabel="kinetic energy [J]", yscale="log")
    axes[1].legend(fontsize=7, loc="center right")
    save(figure, path)

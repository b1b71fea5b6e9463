# SPDX-License-Identifier: BSD-3-Clause
"""Stress against the number of grains: scatter of p' and q between specimens, and drift of their mean.

Scatter: standard deviation s over realisations, fitted as s ~ N^-x; the n - 1 freedoms of each s are its weight,
var(ln s) = 1/(2(n-1)). Drift: mean m, fitted as m = m_inf + c N^(-1/3), the share of grains next to a wall, each m with
weight n/s^2. Misfit: the largest distance of a mean from that curve in standard errors of the mean; where it is well
above 1, m_inf is no more than a hint. Both need three N; x, m_inf and c come with their standard errors.
"""
import collections
import dataclasses
import math

import numpy as np

from studies.drawing import panels, save
from studies.history import History
from studies.scenes import scene_of
from studies.tables import write_tables

DEFAULTS = {"seeds": 10, "grains": [500, 1000, 2000], "rate": 0.8}
QUICK = {"seeds": 3, "grains": [200, 400, 800], "rate": 2}
STRAINS = (0.0002, 0.0005, 0.001, 0.002, 0.005)  # axial, of the table
COLLAPSED = 0.05  # p'/p0' below which a run counts as one that has lost its strength
Quantity = collections.namedtuple("Quantity", "key title scale digits")
QUANTITIES = [Quantity("e", "void ratio e", 1, 4), Quantity("Z", "coordination Z", 1, 3)]
QUANTITIES += [Quantity(f"{stress}_{strain:g}", f"{label} at {100 * strain:g} % (kPa)", 1e-3, 2) for strain in STRAINS
               for stress, label in (("p", "p'"), ("q", "q"))]


@dataclasses.dataclass(frozen=True)
class Run:
    """A specimen and its test in one."""

    grains: int
    seed: int
    rate: float  # 1/s
    kind = "monotonic"

    @property
    def specimen(self):
        return self.grains, self.seed

    @property
    def name(self):
        return f"n{self.grains:06d}_seed{self.seed:02d}"

    def scene(self):
        stage = {"kind": "undrained-monotonic", "direction": "compression", "strain": STRAINS[-1]}
        return scene_of(f"Stress against N: {self.grains} grains, realisation {self.seed}", self.grains, self.seed,
                        {"pressure": "200 kPa", "preparation_friction": "10 deg"}, [stage], edge=".12g",
                        motion={"damping": 0.2, "strain_rate": f"{self.rate:g} 1/s"}, record_stress="2 kPa",
                        record_strain=5e-5, checkpoint="2 min")

    def estimated_seconds(self):
        return self.grains / 2000 * (10 + 11 / self.rate)


def add_options(line):
    line.add_argument("--grains", type=int, nargs="+", help="of the specimens (default: 500, 1000, 2000)")
    line.add_argument("--rate", type=float, help="of axial strain, 1/s (default 0.8)")


def runs(options):
    return [Run(grains, seed, options.rate) for seed in range(1, options.seeds + 1)
            for grains in sorted(set(options.grains))]


def figures_of(history):
    """Of one run: void ratio and coordination before shear, p' and q at the strains, quality of the run."""
    figures = {"e": history.e[0], "Z": history.Z[0], "steps": history.summary["steps"],
               "seconds": history.summary["seconds"], "indicator": np.mean(history.indicator[history.eps_y > 0]),
               "collapsed": float(np.min(history.p) < COLLAPSED * history.p0)}
    return figures | {f"{stress}_{strain:g}": np.interp(strain, history.eps_y, getattr(history, stress))
                      for strain in STRAINS for stress in "pq"}


def line_fit(x, y, variance):
    """Weighted least squares y = a + b x: (a, its standard error), (b, its standard error); None below three points."""
    if len(x) < 3:
        return None
    (b, a), covariance = np.polyfit(x, y, 1, w=1 / np.sqrt(variance), cov="unscaled")
    slope_error, error = np.sqrt(np.diag(covariance))
    return (a, error), (b, slope_error)


class Sample:
    """One quantity: realisations, mean and standard deviation at every N, and what both do with N."""

    def __init__(self, quantity, by_grains):
        self.quantity = quantity
        self.grains = np.array(sorted(by_grains))
        self.values = [quantity.scale * np.array([run[quantity.key] for run in by_grains[n]]) for n in self.grains]
        self.count = np.array([len(v) for v in self.values])
        self.mean = np.array([v.mean() for v in self.values])
        self.deviation = np.array([v.std(ddof=1) if len(v) > 1 else math.nan for v in self.values])
        self.error = self.deviation / np.sqrt(self.count)  # of the mean
        self.scatter = self.drift = None
        if (self.count > 1).all() and (self.deviation > 0).all():
            self.scatter = line_fit(np.log(self.grains), np.log(self.deviation), 1 / (2 * (self.count - 1)))
            self.drift = line_fit(self.grains ** (-1 / 3), self.mean, self.error ** 2)
        if self.drift:
            self.misfit = np.max(np.abs(self.mean - self.drifted(self.grains)) / self.error)

    def drifted(self, grains):
        return self.drift[0][0] + self.drift[1][0] * grains ** (-1 / 3)


def with_error(value, error):
    digits = max(0, 1 - math.floor(math.log10(error))) if error > 0 else 3
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def means(samples, by_grains):
    rows = [["realisations", *samples[0].count]]
    for s in samples:
        digits = s.quantity.digits
        rows.append([s.quantity.title, *(f"{m:.{digits}f} ± {d:.{digits}f}" for m, d in zip(s.mean, s.deviation))])
    rows.append([f"runs with p' below {COLLAPSED:g} p0'",
                 *(f"{sum(run['collapsed'] for run in by_grains[n]):.0f}" for n in samples[0].grains)])
    return ["quantity", *(f"N = {n:,}" for n in samples[0].grains)], rows


def fits(samples):
    first, last = samples[0].grains[[0, -1]]
    change = f"mean at N = {last:,} minus mean at {first:,}"
    return (["quantity", "x in scatter ~ N^-x", change, "m_inf", "c", "misfit"],
            [[s.quantity.title, with_error(-s.scatter[1][0], s.scatter[1][1]),
              with_error(s.mean[-1] - s.mean[0], math.hypot(s.error[0], s.error[-1])), with_error(*s.drift[0]),
              with_error(*s.drift[1]), f"{s.misfit:.1f}"] for s in samples if s.scatter and s.drift])


def costs(by_grains):
    rows = []
    for n, runs in sorted(by_grains.items()):
        steps, seconds, indicator = ([run[key] for run in runs] for key in ("steps", "seconds", "indicator"))
        rows.append([f"{n:,}", f"{np.mean(steps):,.0f}", f"{np.mean(seconds):.0f}", f"{np.mean(indicator):.4f}",
                     f"{max(indicator):.4f}"])
    return ["N", "steps of shear", "s of shear", "indicator, mean", "indicator of the worst run"], rows


def draw(samples, path):
    by_key = {s.quantity.key: s for s in samples}
    colours = dict(zip(STRAINS, ("#7f7f7f", "#1a1a1a", "#0072b2", "#009e73", "#d55e00")))
    figure, axes = panels(2, 2, 8.2, 6.4)
    for axis, stress, label in ((axes[0, 0], "p", "p' (kPa)"), (axes[0, 1], "q", "q (kPa)")):
        for number, strain in enumerate(STRAINS):  # side by side, so that none hides another
            shift = 1.05 ** (number - 2)
            draw_mean(axis, by_key[f"{stress}_{strain:g}"], colours[strain], f"{100 * strain:g} %", shift)
        axis.set(ylabel=label)
    axes[0, 0].legend(title="axial strain", ncol=2)
    for strain in STRAINS:
        for stress, marker in (("p", "o"), ("q", "s")):
            s = by_key[f"{stress}_{strain:g}"]
            axes[1, 0].plot(s.grains, s.deviation, marker=marker, color=colours[strain], lw=0.8, ms=4)
    axes[1, 0].plot([], [], "o", color="grey", label="p'")
    axes[1, 0].plot([], [], "s", color="grey", label="q")
    least = by_key[f"p_{STRAINS[0]:g}"].deviation[0]
    axes[1, 0].plot(s.grains, 0.7 * least * (s.grains / s.grains[0]) ** -0.5, "--", color="grey", label=r"$N^{-1/2}$")
    axes[1, 0].set(yscale="log", ylabel="standard deviation (kPa)")
    axes[1, 0].legend(ncol=3)
    draw_mean(axes[1, 1], by_key["e"], "#1a1a1a", "")
    axes[1, 1].set(ylabel="void ratio e of the box")
    for axis in axes.flat:
        axis.set(xscale="log", xlabel="N")
        axis.set_xticks(s.grains, [f"{n:,}" for n in s.grains])
        axis.minorticks_off()
    save(figure, path)


def draw_mean(axis, s, colour, label, shift=1.0):
    """Realisations as dots, mean with its standard error, the fit of the drift as a line."""
    for n, values in zip(s.grains, s.values):
        axis.plot(np.full(len(values), n * shift), values, ".", color=colour, alpha=0.3, ms=5, mew=0)
    axis.errorbar(s.grains * shift, s.mean, s.error, fmt="o", color=colour, capsize=2, ms=3.5, lw=1, label=label)
    if s.drift:
        n = np.geomspace(s.grains[0], s.grains[-1], 50)
        axis.plot(n * shift, s.drifted(n), color=colour, lw=0.7)


def report(store, planned, folder):
    by_grains = collections.defaultdict(list)
    for run in filter(store.is_done, planned):
        by_grains[run.grains].append(figures_of(History(store.folder(run))))
    if not by_grains:
        return
    samples = [Sample(quantity, by_grains) for quantity in QUANTITIES]
    write_tables(folder, {"means": means(samples, by_grains), "fits": fits(samples), "costs": costs(by_grains)})
    draw(samples, folder / "fig_stress_against_n.png")

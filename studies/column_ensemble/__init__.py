# SPDX-License-Identifier: BSD-3-Clause
"""What a column of grains that liquefies depends on: mesh, packings of a point, the same at all depths or not, seeds.

The scene is apps/scenes/column/quick_ensemble.toml; a seed is a member of the ensemble.
"""
import dataclasses
import pathlib

import h5py
import numpy as np

import isostat
from figures.common import BLACK, BLUE, GREEN, GREY, ORANGE, RED, panel_letter, plt
from isostat.column import ColumnScene
from isostat.results import read_table
from studies.columns import SCENES, library
from studies.drawing import save
from studies.ensembles import ensemble, text_of
from studies.history import parsed
from studies.tables import write_tables

DEFAULTS, QUICK, PAGE = {"seeds": 8}, {"seeds": 1}, "ensemble"
GRAINS = 300  # of a packing
LARGE, LARGE_SEEDS = 3000, 2  # one packing of as many grains as ten have
SEEDS = 40  # of the library; those that miss their density are not in it
MIXED = 38  # seeds of which a packing draws one at random, where depths differ


@dataclasses.dataclass(frozen=True)
class Run:
    """A column of this many points (two in each element) and packings at each; `mixed`: each depth has others."""

    folder: pathlib.Path  # of the study
    mixed: bool
    points: int
    realisations: int
    member: int
    viscosity: float = 0.1  # ms, of the skeleton
    length: float = 0  # m; points so near to each other have the same seeds
    grains: int = GRAINS
    kind, specimen, program = "column", None, "soil_column"

    @property
    def sample(self):
        grains = [] if self.grains == GRAINS else [self.grains]
        return self.mixed, self.realisations, self.viscosity, self.length, *grains

    @property
    def group(self):
        depths = (f"blocks{self.length:g}" if self.length else "mixed") if self.mixed else "same"
        grains = "" if self.grains == GRAINS else f"_n{self.grains}"
        return f"{depths}_p{self.points}_m{self.realisations}_v{self.viscosity:g}{grains}"

    @property
    def name(self):
        return f"{self.group}_{self.member}"

    @property
    def settings(self):
        """Those of `isostat ensemble`: a member has other seeds, or another draw of the same ones."""
        keys = {"layer.0.cells": self.points // 2, "grains.realisations": self.realisations,
                "grains.library": library_of(self.folder, self.grains),
                "grains.cache": self.folder / f"in_situ_{self.grains}.h5",
                "analysis.viscosity": f"{self.viscosity:g} ms"}
        if self.mixed:
            return {**keys, "layer.0.mixed_realisations": MIXED, "layer.0.lot": self.member,
                    **({"layer.0.lot_length": f"{self.length:g} m"} if self.length else {})}
        return {**keys, "layer.0.realisation": self.member * self.realisations}

    def scene(self):
        if library_of(self.folder, self.grains).is_file():
            return ColumnScene(SCENES / "column/quick_ensemble.toml", set=self.settings)
        return None

    def estimated_seconds(self):
        return 25 * (self.points / 10) ** 1.6 * self.realisations * self.grains / GRAINS


def library_of(folder, grains):
    return folder / f"library_{grains}.h5"


# (mixed, realisations, viscosity in ms, length in m); samples with their points and members, the most telling first
SAME, OTHER, BLOCKS, WITHOUT, MORE = ((False, 1, 0.1, 0), (True, 1, 0.1, 0), (True, 1, 0.1, 0.8), (False, 1, 0, 0),
                                       (False, 3, 0.1, 0))
MIXED_MORE, TEN, MIXED_TEN = (True, 3, 0.1, 0), (False, 10, 0.1, 0), (True, 10, 0.1, 0)
STAGES = [
    [(SAME, 10, range(3)), (OTHER, 10, range(3)), (WITHOUT, 10, range(3)), (SAME, 4, range(3)), (OTHER, 4, range(3))],
    [(SAME, 20, range(3)), (OTHER, 20, range(3)), (BLOCKS, 10, range(3)), (BLOCKS, 20, range(3)), (MORE, 10, range(3))],
    [(SAME, 10, range(3, 8)), (OTHER, 10, range(3, 8)), (BLOCKS, 10, range(3, 8)), (TEN, 10, range(1)),
     (MIXED_MORE, 10, range(1)), (MIXED_TEN, 10, range(1)), (OTHER, 40, range(1))],
    [(SAME, 40, range(1)), (BLOCKS, 40, range(1)), (TEN, 10, range(1, 3)), (MIXED_MORE, 10, range(1, 3)),
     (MIXED_TEN, 10, range(1, 3)), (MORE, 10, range(3, 8)), (SAME, 20, range(3, 8)), (OTHER, 20, range(3, 8)),
     (BLOCKS, 20, range(3, 8)), (SAME, 4, range(3, 8)), (OTHER, 4, range(3, 8))],
    [(OTHER, 80, range(1)), (SAME, 80, range(1)), (BLOCKS, 80, range(1)), (SAME, 40, range(1, 3)),
     (OTHER, 40, range(1, 3)), (BLOCKS, 40, range(1, 3))],
    [((False, 1, 1, 0), 10, range(3)), (OTHER, 160, range(1)), (SAME, 160, range(1)), (BLOCKS, 160, range(1))],
]


def prepare(options, executor):
    """Specimens at 20 kPa."""
    for grains, n in ((GRAINS, SEEDS), (LARGE, LARGE_SEEDS))[:1 if options.quick else 2]:
        library(library_of(options.output, grains), executor, n, ["20 kPa"], {
            "contact.young": "1 GPa", "grading.grains": grains,
            "grading.cloud_edge": f"{3.107 * (grains / 300) ** (1 / 3):.3f} mm"})


def runs(options):
    """Stage by stage, member by member over the samples of a stage, so that a campaign that ends early has some of
    each."""
    folder, n_members = options.output, options.seeds
    small = [Run(folder, mixed, points, realisations, member, viscosity, length) for stage in STAGES
             for member in range(n_members) for (mixed, realisations, viscosity, length), points, members in stage
             if member in members]
    return small + [Run(folder, False, 10, 1, member, grains=LARGE) for member in range(min(n_members, LARGE_SEEDS))]


# --- tables and figures ----------------------------------------------------------------------------------------------

LIQUEFIED, STRAINED = 0.95, 0.01
# name, what it is, unit, factor, digits
QUANTITIES = (("thickness", "liquefied thickness", "m", 1, 2), ("strained", "thickness above 1 % strain", "m", 1, 2),
              ("gamma", "largest strain", "%", 100, 1), ("onset", "first r_u > 0.95", "s", 1, 2),
              ("pga", "peak surface below 25 Hz", "m/s2", 1, 2), ("sa", "S_a(0.3 s)", "m/s2", 1, 2),
              ("arias", "Arias intensity", "m/s", 1, 3), ("settlement", "settlement", "mm", 1000, 1),
              ("redundancy", "mean I_R at the end", "-", 1, 2))


@dataclasses.dataclass
class Result:
    run: Run
    numbers: dict
    depth: np.ndarray
    max_ru: np.ndarray
    max_gamma: np.ndarray
    history: isostat.History


def tributary(depth, height):
    """Thickness of the soil that is nearer to each point than to any other, m."""
    return np.diff(np.concatenate(([0], 0.5 * (depth[1:] + depth[:-1]), [height])))


def read(run, folder):
    summary, history = parsed(folder), isostat.read(folder).history
    spectra, grains = read_table(folder / "spectra.csv"), read_table(folder / "grain_profiles/history.csv")
    with h5py.File(folder / "profiles.h5") as file:
        depth, ru, gamma = file["depth"][()], file["ru"][()], file["peak_gamma"][()]
    weight, a = tributary(depth, summary["height"]), history["surface_ax"]
    late = history["time"][history["max_ru"] > LIQUEFIED]
    numbers = {
        "thickness": weight[ru.max(axis=0) > LIQUEFIED].sum(), "strained": weight[gamma > STRAINED].sum(),
        "gamma": summary["peak_gamma"], "onset": late[0] if len(late) else np.nan, "pga": summary["peak_surface_below"],
        "sa": np.interp(0.3, spectra["period"], spectra["surface_x_SA"]),
        "arias": np.pi / (2 * 9.80665) * np.trapz(a**2, history["time"]), "settlement": summary["settlement"],
        "redundancy": np.mean([grains[f"p{k}_IR"][-1] for k in range(len(depth))])}
    return Result(run, numbers, depth, ru.max(axis=0), gamma, history)


def finished(store, runs):
    """{sample: results by member}"""
    samples = {}
    for run in filter(store.is_done, runs):
        samples.setdefault(run.group, []).append(read(run, store.folder(run)))
    return {group: sorted(found, key=lambda r: r.run.member) for group, found in samples.items()}


def label(run):
    packings = "one packing" if run.realisations == 1 else f"{run.realisations} packings"
    viscosity = "" if run.viscosity == 0.1 else f", viscosity {run.viscosity:g} ms"
    depths = f"others every {run.length:g} m" if run.length else "others at each depth" if run.mixed else "the same"
    grains = "" if run.grains == GRAINS else f" of {run.grains} grains"
    return f"{depths}, {run.points} points, {packings}{grains}{viscosity}"


def columns_table(samples):
    heads = [f"{what}, {unit}" if unit != "-" else what for _, what, unit, _, _ in QUANTITIES]
    rows = []
    for results in samples.values():
        cells = []
        for name, _, _, factor, digits in QUANTITIES:
            values = [factor * r.numbers[name] for r in results]
            mean, _, error, n = ensemble(values)  # n: those that liquefied, say
            cells.append(text_of(mean, error, digits) + (f" ({n} of {len(values)})" if n < len(values) else ""))
        rows.append([label(results[0].run), len(results), *cells])
    return ["column", "n", *heads], rows


def scatter(samples):
    """Standard deviation between members: what more packings at a point should lower."""
    return ["column", "n", *(what for _, what, _, _, _ in QUANTITIES)], [
        [label(results[0].run), len(results),
         *(f"{factor * np.std([r.numbers[name] for r in results], ddof=1):.{digits}f}".replace("nan", "-")
           for name, _, _, factor, digits in QUANTITIES)] for results in samples.values() if len(results) > 2]


def differences(samples, one, other):
    """Mean difference of the members that both samples have."""
    found = {group: {r.run.member: r for r in samples.get(group, [])} for group in (one, other)}
    both = sorted(found[one].keys() & found[other].keys())
    rows = []
    for name, what, unit, factor, digits in QUANTITIES if both else ():
        ours, theirs = ([factor * found[group][k].numbers[name] for k in both] for group in (other, one))
        (mean, _, error, _), (base, *_) = ensemble(np.subtract(ours, theirs)), ensemble(theirs)
        rows.append([f"{what}, {unit}", f"{mean:+.{digits}f} ± {error:.{digits}f}", f"{base:.{digits}f}"])
    return [f"{other} less {one}, n = {len(both)}", "difference", "of"], rows


def meshes(samples):
    """The same seeds on several meshes: liquefied thickness, settlement and S_a of each."""
    found = {n: {r.run.member: r for r in samples.get(f"same_p{n}_m1_v0.1", [])} for n in POINTS}
    found = {points: results for points, results in found.items() if results}
    return ["realisation", *(f"{points} points" for points in found)], [
        [member, *(", ".join(f"{factor * results[member].numbers[name]:.{digits}f} {unit}"
                             for name, _, unit, factor, digits in QUANTITIES
                             if name in ("thickness", "settlement", "sa"))
                   if member in results else "" for results in found.values())]
        for member in sorted(set().union(*found.values()))]


SERIES = ((SAME, BLUE, "o-", "same packing at all depths"), (OTHER, RED, "s-", "others at each depth"),
          (BLOCKS, GREEN, "^-", "others every 0.8 m"), (MORE, ORANGE, "D-", "same, 3 a point"),
          (TEN, ORANGE, "*-", "same, 10 a point"), (MIXED_TEN, BLACK, "*-", "others, 10 a point"),
          ((*SAME, LARGE), GREY, "P-", "same, one of 3,000"))
POINTS = (4, 10, 20, 40, 80, 160)


def against_mesh(samples):
    """Numbers against the points of the mesh: means with standard errors, and the members."""
    shown = [q for q in QUANTITIES if q[0] in ("thickness", "strained", "gamma", "sa", "settlement", "redundancy")]
    figure, panels = plt.subplots(2, 3, figsize=(8.4, 5.4), layout="constrained")
    for axes, (name, what, unit, factor, _), letter in zip(panels.flat, shown, "abcdef"):
        for k, (sample, colour, line, text) in enumerate(SERIES):
            rows = [results for results in samples.values() if results[0].run.sample == sample]
            rows.sort(key=lambda results: results[0].run.points)
            if not rows:
                continue
            shift = 1.04**(k - 2)
            x = [shift * results[0].run.points for results in rows]
            means, _, errors, _ = zip(*(ensemble([factor * r.numbers[name] for r in results]) for results in rows))
            axes.errorbar(x, means, yerr=np.nan_to_num(errors), fmt=line,
                          color=colour, markersize=4.5, capsize=2.5, label=text)
            for at, results in zip(x, rows):
                axes.plot([at] * len(results), [factor * r.numbers[name] for r in results], ".", color=colour,
                          markersize=2.5, alpha=0.5)
        axes.set_xscale("log")
        present = [n for n in POINTS if any(results[0].run.points == n for results in samples.values())]
        axes.set_xticks(present, [str(n) for n in present])
        axes.minorticks_off()
        axes.set_ylim(bottom=0)
        text = what.replace("S_a", "$S_a$").replace("I_R", "$I_R$")
        axes.set_ylabel(text if unit == "-" else f"{text} ({unit.replace('m/s2', 'm/s$^2$')})")
        panel_letter(axes, letter)
    for axes in panels[1]:
        axes.set_xlabel("points over 4 m")
    panels[1, 2].legend(fontsize=5.8, ncols=2, loc="lower left", columnspacing=0.6, handlelength=1.2, borderpad=0)
    return figure


KINDS = {"same": ("same", BLUE), "mixed": ("others", RED), "blocks0.8": ("blocks", GREEN)}


def over_depth(samples):
    """Largest r_u and strain over the depth, one packing a point: members and median."""
    groups = [(kind, points) for kind in KINDS for points in (4, 10, 20) if f"{kind}_p{points}_m1_v0.1" in samples]
    if not groups:
        return None
    figure, panels = plt.subplots(2, len(groups), figsize=(1.35 * len(groups) + 0.8, 5.6), sharey=True, squeeze=False,
                                  layout="constrained")
    for column, (kind, points) in enumerate(groups):
        results, (word, colour) = samples[f"{kind}_p{points}_m1_v0.1"], KINDS[kind]
        for axes, values, factor in ((panels[0, column], "max_ru", 1), (panels[1, column], "max_gamma", 100)):
            for r in results:
                axes.plot(factor * getattr(r, values), r.depth, color=GREY, linewidth=0.7)
            axes.plot(factor * np.median([getattr(r, values) for r in results], axis=0), results[0].depth, color=colour)
        panels[0, column].set_title(f"{word}, {points} points\nn = {len(results)}", fontsize=8.5)
        panels[0, column].axvline(LIQUEFIED, color=BLACK, linewidth=0.7, linestyle="--")
        panels[0, column].set_xlim(0, 1.1)
        panels[1, column].set(xscale="log", xlim=(0.02, 40))
        panels[0, column].set_xlabel("largest $r_u$")
        panels[1, column].set_xlabel("largest strain (%)")
    for axes in panels[:, 0]:
        axes.set_ylabel("Depth (m)")
    panels[0, 0].set_ylim(4, 0)
    return figure


def viscosities(samples):
    """Surface, largest r_u and settlement with and without the viscosity, member by member."""
    groups = [(name, colour) for name, colour in (("same_p10_m1_v0", ORANGE), ("same_p10_m1_v0.1", BLUE),
                                                  ("same_p10_m1_v1", GREEN)) if name in samples]
    members = [{r.run.member for r in samples[name]} for name, _ in groups]
    members = sorted(set.intersection(*members))[:3] if members else []
    if not members:
        return None
    figure, panels = plt.subplots(3, len(members), figsize=(2.9 * len(members) + 0.6, 5.4), sharex=True, sharey="row",
                                  squeeze=False, layout="constrained")
    for column, member in enumerate(members):
        for name, colour in groups:
            result = next(r for r in samples[name] if r.run.member == member)
            h, text = result.history, f"{result.run.viscosity:g} ms"
            for axes, values in zip(panels[:, column], (h["surface_ax"], h["max_ru"], 1000 * h["settlement"])):
                axes.plot(h["time"], values, color=colour, linewidth=0.8, label=text)
        panels[0, column].set_title(f"member {member}", fontsize=9)
        panels[2, column].set_xlabel("Time (s)")
    for axes, text in zip(panels[:, 0], ("$a_x$ of the surface (m/s$^2$)", "largest $r_u$", "settlement (mm)")):
        axes.set_ylabel(text)
    panels[0, 0].legend(title="viscosity", fontsize=7.5, title_fontsize=7.5)
    return figure


def report(store, planned, folder):
    samples = finished(store, planned)
    if not samples:
        return
    write_tables(folder, {"columns": columns_table(samples), "scatter": scatter(samples), "meshes": meshes(samples),
                          **{f"viscosity_{name}": differences(samples, "same_p10_m1_v0.1", f"same_p10_m1_v{name}")
                             for name in (0, 1)}})
    for name, draw in (("mesh", against_mesh), ("depth", over_depth), ("viscosity", viscosities)):
        figure = draw(samples)
        if figure is not None:
            save(figure, folder / f"{name}.png", dpi=150)

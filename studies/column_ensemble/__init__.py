# SPDX-License-Identifier: BSD-3-Clause
"""What a column of grains that liquefies depends on: seeds, packings that vary over the depth, mesh, viscosity, rate.

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

DEFAULTS, QUICK, PAGE = {"seeds": 6}, {"seeds": 1}, "ensemble"
SEEDS = 40  # of the library; those that miss their density are not in it
MIXED = 38  # seeds of which a packing draws one at random, where depths differ
LENGTH = {"layer.0.lot_length": "0.8 m"}  # over which points have the same seed
FINE = {"layer.0.cells": 10}


@dataclasses.dataclass(frozen=True)
class Sample:
    """Columns that differ in their seeds alone."""

    text: str
    label: str  # short
    colour: str
    mixed: bool = False  # each depth draws its packing
    keys: tuple = ()  # items of what differs from the scene
    members: int = 100  # at most
    cost: float = 1
    base: str = ""  # the sample with which it is compared, member by member


SAMPLES = {
    "same": Sample("one packing at all depths", "same", BLUE),
    "drawn": Sample("another at each depth", "drawn", RED, True),
    "blocks": Sample("another every 0.8 m", "blocks", GREEN, True, tuple(LENGTH.items())),
    "same_fine": Sample("one packing, 20 points", "same,\n20 points", BLUE, False, tuple(FINE.items()), 3, 3, "same"),
    "blocks_fine": Sample("another every 0.8 m, 20 points", "blocks,\n20 points", GREEN, True,
                          tuple((LENGTH | FINE).items()), 3, 3, "blocks"),
    "no_viscosity": Sample("one packing, no viscosity", "no\nviscosity", ORANGE, False,
                           (("analysis.viscosity", "0 ms"),), 3, 1, "same"),
    "slow": Sample("one packing, 0.4 of the rate", "0.4 of\nthe rate", GREY, False,
                   (("grains.inertial_number", 4e-5), ("grains.min_steps", 60)), 3, 2.8, "same"),
}


@dataclasses.dataclass(frozen=True)
class Run:
    folder: pathlib.Path  # of the study
    sample: str  # of SAMPLES
    member: int
    kind, specimen, program = "column", None, "soil_column"

    @property
    def name(self):
        return f"{self.sample}_{self.member}"

    def scene(self):
        if not library_of(self.folder).is_file():
            return None
        sample = SAMPLES[self.sample]
        seeds = ({"layer.0.mixed_realisations": MIXED, "layer.0.lot": self.member} if sample.mixed else
                 {"layer.0.realisation": self.member})
        return ColumnScene(SCENES / "column/quick_ensemble.toml", set={
            "grains.library": library_of(self.folder), "grains.cache": self.folder / "in_situ.h5", **seeds,
            **dict(sample.keys)})

    def estimated_seconds(self):
        return 18 * SAMPLES[self.sample].cost


def library_of(folder):
    return folder / "library_300.h5"


def prepare(options, executor):
    """Specimens at 20 kPa."""
    library(library_of(options.output), executor, SEEDS, ["20 kPa"], {
        "contact.young": "1 GPa", "grading.grains": 300, "grading.cloud_edge": "3.107 mm"})


def runs(options):
    """Member by member, so that a campaign that ends early has some of each sample."""
    return [Run(options.output, name, member) for member in range(options.seeds)
            for name, sample in SAMPLES.items() if member < sample.members]


# --- tables and figures ----------------------------------------------------------------------------------------------

LIQUEFIED, STRAINED = 0.95, 0.01
# name, what it is, unit, factor, digits
QUANTITIES = (("thickness", "liquefied thickness", "m", 1, 2), ("strained", "thickness above 1 % strain", "m", 1, 2),
              ("gamma", "largest strain", "%", 100, 1), ("onset", "first r_u > 0.95", "s", 1, 2),
              ("pga", "peak surface below 25 Hz", "m/s2", 1, 2), ("sa", "S_a(0.3 s)", "m/s2", 1, 2),
              ("arias", "Arias intensity", "m/s", 1, 3), ("settlement", "settlement", "mm", 1000, 1),
              ("redundancy", "mean I_R at the end", "", 1, 2),
              ("steps", "time steps of a packing", "", 1, 0))


@dataclasses.dataclass
class Result:
    member: int
    numbers: dict
    depth: np.ndarray
    max_ru: np.ndarray
    max_gamma: np.ndarray


def tributary(depth, height):
    """Thickness of the soil that is nearer to each point than to any other, m."""
    return np.diff(np.concatenate(([0], 0.5 * (depth[1:] + depth[:-1]), [height])))


def read(run, folder):
    summary, history = parsed(folder), isostat.read(folder).history
    spectra, grains = (read_table(folder / name) for name in ("spectra.csv", "grain_profiles/history.csv"))
    with h5py.File(folder / "profiles.h5") as file:
        depth, ru, gamma = file["depth"][()], file["ru"][()], file["peak_gamma"][()]
    weight, a = tributary(depth, summary["height"]), history["surface_ax"]
    late = history["time"][history["max_ru"] > LIQUEFIED]
    numbers = {
        "thickness": weight[ru.max(axis=0) > LIQUEFIED].sum(), "strained": weight[gamma > STRAINED].sum(),
        "gamma": summary["peak_gamma"], "onset": late[0] if len(late) else np.nan, "pga": summary["peak_surface_below"],
        "sa": np.interp(0.3, spectra["period"], spectra["surface_x_SA"]),
        "arias": np.pi / (2 * 9.80665) * np.trapz(a**2, history["time"]), "settlement": summary["settlement"],
        "redundancy": np.mean([grains[f"p{k}_IR"][-1] for k in range(len(depth))]),
        "steps": parsed(folder, "times")["packing_steps"] / len(depth)}
    return Result(run.member, numbers, depth, ru.max(axis=0), gamma)


def finished(store, runs):
    """{sample: {member: result}}"""
    found = {name: {run.member: read(run, store.folder(run)) for run in runs
                    if run.sample == name and store.is_done(run)} for name in SAMPLES}
    return {name: results for name, results in found.items() if results}


def heads():
    return [f"{what}, {unit}" if unit else what for _, what, unit, _, _ in QUANTITIES]


def columns_table(samples):
    """Means ± standard errors, with the standard deviation in brackets, of the members of each sample."""
    rows = []
    for name, results in samples.items():
        cells = []
        for quantity, _, _, factor, digits in QUANTITIES:
            values = [factor * r.numbers[quantity] for r in results.values()]
            mean, deviation, error, n = ensemble(values)  # n: those that liquefied, say
            cells.append(text_of(mean, error, digits) + (f" ({deviation:.{digits}f})" if n > 1 else "")
                         + (f", {n} of {len(values)}" if n < len(values) else ""))
        rows.append([SAMPLES[name].text, len(results), *cells])
    return ["column", "n", *heads()], rows


def differences(samples):
    """Mean difference from the sample with which each is compared, of the members that both have."""
    rows = []
    for name, results in samples.items():
        base = samples.get(SAMPLES[name].base, {})
        both = sorted(results.keys() & base.keys())
        if both:
            cells = []
            for quantity, _, _, factor, digits in QUANTITIES:
                mean, _, error, n = ensemble([factor * (results[k].numbers[quantity] - base[k].numbers[quantity])
                                              for k in both])
                cells.append(f"{mean:+.{digits}f}" + (f" ± {error:.{digits}f}" if n > 1 else ""))
            rows.append([SAMPLES[name].text, SAMPLES[SAMPLES[name].base].text, len(both), *cells])
    return ["column", "less", "n", *heads()], rows


def draw_samples(samples):
    """Members, and means with standard errors, of each sample; a line between columns of the same seed."""
    shown = [q for q in QUANTITIES if q[0] in ("thickness", "onset", "gamma", "sa", "settlement", "redundancy")]
    figure, panels = plt.subplots(3, 2, figsize=(7.2, 7.6), layout="constrained", sharex=True)
    place = {name: k for k, name in enumerate(SAMPLES)}
    for axes, (quantity, what, unit, factor, _), letter in zip(panels.flat, shown, "abcdef"):
        for name, results in samples.items():
            sample, x = SAMPLES[name], place[name]
            values = {k: factor * r.numbers[quantity] for k, r in results.items()}
            axes.plot([x] * len(values), list(values.values()), ".", color=sample.colour, markersize=4, alpha=0.5)
            mean, _, error, _ = ensemble(values.values())
            axes.errorbar(x + 0.2, mean, np.nan_to_num(error), fmt="D", color=sample.colour, markersize=4, capsize=2.5)
        axes.set_xticks(list(place.values()), [sample.label for sample in SAMPLES.values()], fontsize=6.5)
        axes.set_ylim(bottom=0)
        text = what.replace("S_a", "$S_a$").replace("I_R", "$I_R$").replace("r_u", "$r_u$")
        axes.set_ylabel(f"{text} ({unit.replace('m/s2', 'm/s$^2$')})" if unit else text)
        panel_letter(axes, letter)
    return figure


def over_depth(samples):
    """Largest r_u and strain over the depth: members and median."""
    shown = [name for name in ("same", "same_fine", "drawn", "blocks", "blocks_fine") if name in samples]
    figure, panels = plt.subplots(2, len(shown), figsize=(7.2, 5.2), sharey=True, squeeze=False, layout="constrained")
    for (above, below), name in zip(panels.T, shown):
        results, sample = samples[name].values(), SAMPLES[name]
        for axes, values, factor in ((above, "max_ru", 1), (below, "max_gamma", 100)):
            for r in results:
                axes.plot(factor * getattr(r, values), r.depth, color=GREY, linewidth=0.7)
            median = factor * np.median([getattr(r, values) for r in results], axis=0)
            axes.plot(median, next(iter(results)).depth, color=sample.colour)
        above.set_title(f"{sample.label}\nn = {len(results)}".replace(",\n", ", "), fontsize=8.5)
        above.axvline(LIQUEFIED, color=BLACK, linewidth=0.7, linestyle="--")
        above.set(xlim=(0, 1.1), xlabel="largest $r_u$")
        below.set(xscale="log", xlim=(0.02, 40), xlabel="largest strain (%)")
    for axes in panels[:, 0]:
        axes.set_ylabel("Depth (m)")
    panels[0, 0].set_ylim(4, 0)
    return figure


def report(store, planned, folder):
    samples = finished(store, planned)
    if not samples:
        return
    write_tables(folder, {"columns": columns_table(samples), "differences": differences(samples)})
    for name, draw in (("samples", draw_samples), ("depth", over_depth)):
        save(draw(samples), folder / f"{name}.png", dpi=150)

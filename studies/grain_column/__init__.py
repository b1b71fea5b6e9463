# SPDX-License-Identifier: BSD-3-Clause
"""A deposit of packings, ten metres that liquefy: one realisation."""
import h5py
import numpy as np

from figures import soil_column
from isostat.results import read_table
from studies.columns import SCENES, Run, library
from studies.drawing import draw_figure
from studies.tables import write_tables

DEFAULTS, QUICK = {}, {}
LIQUEFIED = 0.95  # r_u


def library_of(options):
    return options.output / "library_1000.h5"


def prepare(options, executor):
    library(library_of(options), executor, 1, ["20 kPa", "100 kPa"], {"contact.young": "1 GPa"})


def runs(options):
    file, duration, seconds = library_of(options), *(("0.2 s", 15) if options.quick else ("2 s", 110))
    return [Run(("grains_10m",), SCENES / "column/grains_10m.toml", (
        ("grains.library", file), ("grains.cache", options.output / "in_situ_grains_10m.h5"),
        ("motion.0.duration", "2 s"), ("analysis.duration", duration)), seconds, (file,))]


def levels(folder):
    """Of each packing: largest r_u and strain, when r_u first exceeds 0.95, I_R then, and the least I_R."""
    grains = read_table(folder / "grain_profiles/history.csv")
    with h5py.File(folder / "profiles.h5") as file:
        depth, time, ru, gamma = (file[name][()] for name in ("depth", "time", "ru", "peak_gamma"))
    rows = []
    for k, z in enumerate(depth):
        late, index = np.flatnonzero(ru[:, k] > LIQUEFIED), grains[f"p{k}_IR"]
        first = time[late[0]] if late.size else None
        onset = [f"{first:.2f}", f"{np.interp(first, grains['time'], index):.2f}"] if late.size else ["", ""]
        rows.append([f"{z:.2f}", float(ru[:, k].max()), f"{100 * gamma[k]:.2g}", *onset, f"{index.min():.2f}"])
    return ["depth (m)", "largest r_u", "largest strain (%)", "r_u > 0.95 at (s)", "I_R then", "least I_R"], rows


def report(store, planned, folder):
    for run in filter(store.is_done, planned):
        results = store.folder(run)
        write_tables(folder, {"levels": levels(results)})
        draw_figure(soil_column.DRAWING, "fig_grains_map", results, folder / "deposit.png")

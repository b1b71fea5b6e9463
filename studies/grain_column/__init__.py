# SPDX-License-Identifier: BSD-3-Clause
"""Deposits of packings: ten metres that liquefy, and four that are shaken twice. One realisation of each."""
import h5py
import numpy as np

from figures import soil_column
from isostat.results import read_table
from studies.columns import SCENES, Run, library
from studies.drawing import draw_figure
from studies.history import parsed
from studies.tables import write_tables

DEFAULTS, QUICK = {}, {}
LIQUEFIED = 0.95  # r_u
SMALL = {"grading.grains": 300, "grading.cloud_edge": "3.107 mm"}
CASES = {  # scene: (keys, CPU seconds, figure and its name)
    "grains_10m": ({"motion.0.duration": "2 s", "analysis.duration": "2 s"}, 250, "fig_grains_map", "deposit"),
    "grains_twice": ({}, 100, "fig_grains_map", "twice")}


def library_of(options, scene):
    return options.output / ("library_1000.h5" if scene == "grains_10m" else "library_300.h5")


def prepare(options, executor):
    for scene, more in (("grains_10m", {}), ("grains_twice", SMALL)):
        library(library_of(options, scene), executor, 1, ["20 kPa", "100 kPa"], {"contact.young": "1 GPa"} | more)


def runs(options):
    found = []
    for scene, (keys, seconds, _, _) in CASES.items():
        if options.quick:
            keys, seconds = keys | {"analysis.duration": "0.2 s"}, 15
        file = library_of(options, scene)
        found.append(Run((scene,), SCENES / f"column/{scene}.toml", (("grains.library", file), (
            "grains.cache", options.output / f"in_situ_{scene}.h5"), *keys.items()), seconds, (file,)))
    return found


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
    found = {run.case[0]: store.folder(run) for run in planned if store.is_done(run)}
    names = ("settlement", "peak_gamma", "peak_surface", "peak_input", "max_ru")
    summaries = {scene: parsed(results) for scene, results in found.items()}
    write_tables(folder, {"columns": (["scene", *names, "CPU minutes"], [
        [scene, *(float(s.get(name) or np.nan) for name in names), store.cpu_seconds(run) / 60]
        for run in planned for scene, s in summaries.items() if run.case == (scene,)]), **{
        f"levels_{scene}": levels(results) for scene, results in found.items()}})
    for scene, results in found.items():
        draw_figure(soil_column.DRAWING, CASES[scene][2], results, folder / f"{CASES[scene][3]}.png")

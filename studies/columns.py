# SPDX-License-Identifier: BSD-3-Clause
"""What the studies of soil columns share: their runs, and libraries of specimens.

tested: tests/studies/columns_test.py
"""
import dataclasses
import json
import pathlib

import isostat
from isostat.campaign.runs import Run as Process, complete
from isostat.column import ColumnScene

ROOT = pathlib.Path(__file__).resolve().parents[1]
SCENES = ROOT / ("apps/scenes" if (ROOT / "apps").is_dir() else "scenes")


@dataclasses.dataclass(frozen=True)
class Run:
    """A run of soil_column."""

    case: tuple  # what it is of its study
    source: str | pathlib.Path  # of a ColumnScene
    keys: tuple = ()  # (key, value) that differ from it
    seconds: float = 5  # of CPU
    needs: tuple = ()  # files that the study makes first
    kind, specimen, program = "column", None, "soil_column"

    @property
    def name(self):
        return "_".join(map(str, self.case)).replace(", ", "_").replace(" ", "_")

    def scene(self):
        return ColumnScene(self.source, set=dict(self.keys)) if all(path.is_file() for path in self.needs) else None

    def estimated_seconds(self):
        return self.seconds


def histories(store, planned):
    """{case: history} of what has been run."""
    return {run.case: isostat.read(store.folder(run)).history for run in planned if store.is_done(run)}


def parsed(folder, name="summary"):
    """summary.json or times.json of a run."""
    return json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))


def library(path, executor, n, pressures, settings):
    """Makes a library of apps/scenes/rve_library.toml with other settings, if it does not exist: n seeds at each
    pressure, less those that cannot be prepared, which miss their density."""
    if path.exists():
        return
    cache = path.parent / "specimens"
    scenes = [isostat.Scene(SCENES / "rve_library.toml", set=settings | {
        "specimen.pressure": pressure, "specimen.cache": cache, "grading.seed": seed, "output.folder": "runs",
        "output.snapshots": "none", "output.paraview": False}) for pressure in pressures for seed in range(1, n + 1)]
    runs = [Process.below(path.with_suffix(""), f"specimen_{k}", scene) for k, scene in enumerate(scenes, 1)]
    print(f"{path.name}: preparing {len(runs)} specimens", flush=True)
    complete(executor, [run for run in runs if not run.is_finished])
    for run in runs:
        if not run.is_finished:
            print(f"{run.name} is not in {path.name}: {run.last_line}", flush=True)
    isostat.write_library(path, [isostat.prepare(scene, cache=cache, threads=1)
                                 for run, scene in zip(runs, scenes) if run.is_finished])

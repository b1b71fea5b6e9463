# SPDX-License-Identifier: BSD-3-Clause
"""What the studies of soil columns share: their runs, and libraries of specimens.

tested: tests/studies/columns_test.py
"""
import dataclasses
import pathlib

import isostat
from isostat.campaign.library import make_library, parse
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


def library(path, executor, n, pressures, settings):
    """Makes a library of apps/scenes/rve_library.toml with other settings, if it does not exist: n seeds at each
    pressure, less those that cannot be prepared, which miss their density."""
    if path.exists():
        return
    words = [f"--set={key}={value}" for key, value in settings.items()]
    try:
        make_library(parse([str(SCENES / "rve_library.toml"), "-n", str(n), "--pressures", ",".join(pressures), "-o",
                            str(path), *words]), executor)
    except isostat.RunFailure as error:
        print(error, flush=True)

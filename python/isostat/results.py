# SPDX-License-Identifier: BSD-3-Clause
"""Results of a run as arrays.   tested: tests/python/run_test.py"""
import collections.abc
import csv
import importlib
import os
import pathlib
import re
import subprocess
import sys
from typing import Any

import numpy as np

from isostat import _core
from isostat.calls import path_text
from isostat.scene import Scene


class History(collections.abc.Mapping[str, np.ndarray]):
    """Columns by name, in SI, compression positive: history["p"]. `units` has their units."""

    def __init__(self, columns: dict[str, np.ndarray], units: dict[str, str]):
        self._columns, self.units = dict(columns), dict(units)

    def __getitem__(self, name: str) -> np.ndarray:
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"{name}: no such column; there are {', '.join(self._columns)}") from None

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        """Number of columns; rows are len(history["step"])."""
        return len(self._columns)

    def __repr__(self):
        rows = len(next(iter(self._columns.values()), ()))
        return f"<isostat.History of {rows} rows: {', '.join(self._columns)}>"

    def to_pandas(self) -> Any:
        """A DataFrame; its attrs["units"] has the units. Needs pandas."""
        import pandas  # only who asks for it needs it

        frame = pandas.DataFrame(self._columns)
        frame.attrs["units"] = self.units
        return frame


def read_table(path: str | os.PathLike[str]) -> History:
    """A CSV table whose header has `name (unit)`, as a History."""
    with open(path_text("path", path), newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    if not rows:
        raise _core.InputError(f"{path}: is empty.")
    names, units = zip(*(re.fullmatch(r"(.*?)(?: \(([^()]*)\))?", cell).groups() for cell in rows[0]))
    whole = [row for row in rows[1:] if len(row) == len(names)]
    body = np.array([[float(cell) if cell else np.nan for cell in row] for row in whole]).reshape(-1, len(names))
    return History({name: body[:, k] for k, name in enumerate(names)},
                   {name: unit or "-" for name, unit in zip(names, units)})


def draw(folder: str | os.PathLike[str], name: str, program: str = "element_test") -> list[Any]:
    """Draws one of the figures that a program leaves, fig_redundancy say, and returns its axes.

    isostat.draw("results/mine", "fig_redundancy")[0].figure.savefig("mine.pdf"). Needs matplotlib.
    Raises InputError (no such figure, a folder that holds no results, nothing to draw).
    """
    figures = importlib.import_module("isostat.figures.common")
    try:
        drawing = importlib.import_module(f"isostat.figures.{program}").DRAWING
    except ModuleNotFoundError as error:
        if error.name != f"isostat.figures.{program}":
            raise
        raise _core.InputError(f"{program}: no program of that name leaves figures.") from error
    if name not in drawing.figures:
        raise _core.InputError(f"{name}: no figure of {program}; there are {', '.join(drawing.figures)}.")
    try:
        results = drawing.results(pathlib.Path(path_text("folder", folder)))
    except figures.BadInput as error:
        raise _core.InputError(f"{error}.") from error
    with figures.plt.rc_context(figures.STYLE):
        figure = drawing.figures[name](results)
    if figure is None:
        raise _core.InputError(f"{folder}: has nothing that {name} shows.")
    return figure.axes


class Results:
    """A results folder of element_test or run().

    history     History                            scene       Scene, with every key resolved
    summary     numbers of summary.json            snapshots   paths of the stored packings; packing(k) reads one
    provenance  text: version, compiler, seed ...  finished    whether the run came to its end
    snapshot    the packing at the end, and warnings, texts: where run() gave this; else None and none

    A run that is under way or was interrupted has a history as far as it came; its summary is None, finished False.
    """

    program = "element_test"

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = pathlib.Path(path_text("folder", folder))
        if not (self.folder / "history.csv").is_file():
            raise _core.InputError(f"{self.folder}: holds no history.csv. Give the folder of a run of element_test.")
        self.history = read_table(self.folder / "history.csv")
        if (self.folder / "history.h5").is_file():  # all digits, of a run under way perhaps of fewer rows
            for name, values in _core.read_series(self.folder / "history.h5").items():
                self.history[name][:len(values)] = values[:len(self.history[name])]
        self.snapshot: _core.Snapshot | None = None
        self.warnings: list[str] = []
        self.snapshots = sorted((self.folder / "snapshots").glob("snapshot_*.h5"))

    @property
    def scene(self) -> Scene:
        """The Scene that was run, with every key resolved."""
        return Scene((self.folder / "scene.toml").read_text(encoding="utf-8"))

    @property
    def summary(self) -> dict[str, Any] | None:
        """Of a run that has finished; else None.   Raises InputError (a damaged file)"""
        files = importlib.import_module("isostat.figures.files")
        try:
            return files.read_parsed(self.folder / "summary.json") if self.finished else None
        except files.Damaged as error:
            raise _core.InputError(str(error)) from error

    @property
    def finished(self) -> bool:
        """Whether the run came to its end: it writes summary.json last."""
        return (self.folder / "summary.json").is_file()

    @property
    def provenance(self) -> str:
        """Text: version, compiler, seed, command."""
        return (self.folder / "provenance.txt").read_text(encoding="utf-8")

    def packing(self, number: int) -> _core.Snapshot:
        """The stored Snapshot of this number, from 0; negative numbers count from the last."""
        n = len(self.snapshots)
        if not -n <= number < n:
            raise _core.InputError(f"{self.folder}: has {n} stored packings, numbered from 0; there is no number {number}.")
        return _core.read_snapshot(str(self.snapshots[number]))

    def draw(self, name: str) -> list[Any]:
        """The axes of one of the figures that the program leaves: results.draw("fig_stress_path")."""
        return draw(self.folder, name, self.program)

    def report(self) -> pathlib.Path:
        """Leaves figures and report.html in the folder, as the program does, and returns the path of the report.

        Needs matplotlib and h5py.   Raises RunFailure with what went wrong
        """
        done = subprocess.run([sys.executable, "-m", "report", "leave", self.program, self.folder.resolve()],
                              env={**os.environ, "PYTHONPATH": str(pathlib.Path(__file__).parent)},
                              capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise _core.RunFailure(done.stderr.strip())
        return self.folder / "report.html"

    def __repr__(self):
        return f"<isostat.Results of {self.folder}>"


def read(folder: str | os.PathLike[str]) -> Results:
    """The Results of a run, finished or not: `finished` tells, and the summary of an unfinished one is None."""
    return Results(folder)

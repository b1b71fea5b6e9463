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
import warnings
from typing import Any

import numpy as np

from isostat import _core
from isostat.calls import depth_of_caller, path_text
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
    """A CSV table whose header has `name (unit)`, as a History. A last row that is not complete, of a run that was killed
    while it wrote, is left out.   Raises InputError (a file that cannot be read, or is damaged, with its line)
    """
    try:
        with open(path_text("path", path), newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
    except OSError as error:
        raise _core.InputError(f"{path}: cannot be read: {error.strerror}.") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise _core.InputError(f"{path}: is damaged (it holds bytes that are no text).") from error
    if not rows or not rows[0]:
        raise _core.InputError(f"{path}: is damaged (it is empty).")
    names, units = zip(*(re.fullmatch(r"(.*?)(?: \(([^()]*)\))?", cell, re.DOTALL).groups() for cell in rows[0]))
    if len(rows) > 1 and len(rows[-1]) != len(names):
        rows.pop()
    body = np.empty((len(rows) - 1, len(names)))
    for line, row in enumerate(rows[1:], 2):
        try:
            body[line - 2] = [float(cell) if cell else np.nan for cell in row]
        except ValueError as error:
            raise _core.InputError(f"{path}:{line}: is damaged (it holds no row of {len(names)} numbers).") from error
    return History({name: body[:, k] for k, name in enumerate(names)},
                   {name: unit or "-" for name, unit in zip(names, units)})


def read_history(folder: pathlib.Path) -> tuple[History, list[str]]:
    """The history of a results folder, and warnings. history.h5 has all digits, history.csv ten of them, and of a run under
    way perhaps more rows; where one of them is damaged, the other one counts.

    Raises InputError (there is no history, or none that can be read)
    """
    table, series = folder / "history.csv", folder / "history.h5"
    exact = rounded = None
    faults = []
    if not table.is_file() and not series.is_file():
        raise _core.InputError(f"{folder}: holds no history.csv. Give the folder of a run of element_test.")
    try:
        exact = History(*_core.read_series(series)) if series.is_file() else None  # first: rows may be added meanwhile
    except _core.InputError as error:
        faults.append(f"{error}.")
    try:
        rounded = read_table(table)
    except _core.InputError as error:
        faults.append(str(error))
    if exact is None and rounded is None:
        files = importlib.import_module("isostat.figures.files")
        raise _core.InputError("\n".join([*faults, f"No history is left. {files.REMEDY}"]))
    if rounded is None:
        return exact, [f"{faults[0]} The history is that of {series}; rows are missing that the run had not yet written there."]
    if exact is None:
        lost = f"The history is that of {table}, to ten digits."
        return rounded, [f"{fault} {lost}" for fault in faults]
    if set(exact) != set(rounded):
        return rounded, [f"{series}: has other columns than {table}. The history is that of the latter, to ten digits."]
    rows, more = len(next(iter(exact.values()))), len(next(iter(rounded.values())))
    if rows > more:
        return exact, [f"{table}: is damaged (it ends after {more} of {rows} rows). The history is that of {series}."]
    for name, values in exact.items():
        rounded[name][:rows] = values
    return rounded, []


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
        pages = importlib.import_module("isostat.figures.drawing").pages_of(drawing.figures[name](results))
    if not pages:
        raise _core.InputError(f"{folder}: has nothing that {name} shows.")
    return [axes for figure in pages for axes in figure.axes]


class Results:
    """A results folder of element_test or run().

    history     History                            scene       Scene, with every key resolved
    summary     numbers of summary.json            snapshots   paths of the stored packings; packing(k) reads one
    provenance  text: version, compiler, seed ...  finished    whether the run came to its end
    snapshot    the packing at the end where run() gave this; else None
    warnings    texts: of run(), and of files that are damaged while others of the folder hold the same

    A run that is under way or was interrupted has a history as far as it came; its summary is None, finished False.
    """

    program = "element_test"

    def __init__(self, folder: str | os.PathLike[str]):
        self.folder = pathlib.Path(path_text("folder", folder))
        self.history, self.warnings = read_history(self.folder)
        for text in self.warnings:
            warnings.warn(text, _core.IsostatWarning, stacklevel=depth_of_caller())
        self.snapshot: _core.Snapshot | None = None
        self.snapshots = sorted((self.folder / "snapshots").glob("snapshot_*.h5"))

    @property
    def scene(self) -> Scene:
        """The Scene that was run, with every key resolved."""
        return Scene(self._text("scene.toml"))

    def _text(self, name: str) -> str:
        path = self.folder / name
        try:
            return path.read_text(encoding="utf-8")
        except OSError as error:
            raise _core.InputError(f"{path}: cannot be read: {error.strerror}.") from error
        except UnicodeDecodeError as error:
            raise _core.InputError(f"{path}: is damaged (it holds bytes that are no text). Restore it from a copy.") from error

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
        return self._text("provenance.txt")

    def packing(self, number: int) -> _core.Snapshot:
        """The stored Snapshot of this number, from 0; negative numbers count from the last."""
        n = len(self.snapshots)
        if not -n <= number < n:
            raise _core.InputError(f"{self.folder}: has {n} stored packings, numbered from 0; there is no number {number}.")
        path = self.snapshots[number]
        try:
            return _core.read_snapshot(str(path))
        except _core.InputError as error:
            grains = self.folder / "paraview" / path.name.replace("snapshot_", "grains_").replace(".h5", ".vtp")
            raise _core.InputError(f"{error}; isostat.read_packing({str(grains)!r}) has its grains, without the history of "
                                   "their contacts.") from error if grains.is_file() else error

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
    """The Results of a run, finished or not: `finished` says which, and the summary of an unfinished one is None."""
    return Results(folder)

# SPDX-License-Identifier: BSD-3-Clause
"""Preparing specimens and running scenes.   tested: tests/python/run_test.py"""
import csv
import json
import os
import pathlib
import tempfile
from collections.abc import Callable
from typing import Any

from isostat import _core
from isostat.calls import check_use, path_text, stopped_by_signals, warned
from isostat.results import History, Results, draw
from isostat.scene import Scene

CACHE = os.path.join("results", "specimens")


SceneLike = Scene | str | os.PathLike[str] | dict[str, Any]
Callback = Callable[[_core.Moment], object]


def as_scene(scene: SceneLike) -> Scene:
    """The Scene itself, or one that is made from what is given."""
    if scene is None:
        raise _core.InputError("scene: must be a Scene, a path, TOML text or a dictionary, but is None.")
    return scene if isinstance(scene, Scene) else Scene(scene)


def prepare(scene: SceneLike, *, cache: str | os.PathLike[str] = CACHE, threads: int = 0,
            quiet: bool | None = None) -> _core.Specimen:
    """The specimen that a scene asks for: from its file, from the cache, or prepared and put into the cache.

    cache: folder of prepared specimens. threads: that share a step; 0: as many as the packing can feed; changes no bit.
    quiet: as in run(). Returns a Specimen. Raises InputError (a density that cannot be reached).
    """
    scene = as_scene(scene)
    with warned(scene.title, quiet) as listed, stopped_by_signals():
        return _core.prepare(scene, path_text("cache", cache), threads, quiet is not False, listed)


def run(scene: SceneLike, output: str | os.PathLike[str] | None = None, *,
        specimen: _core.Specimen | _core.Snapshot | None = None, cache: str | os.PathLike[str] | None = None,
        overwrite: bool = False, resume: bool = False, threads: int = 0, quiet: bool | None = None,
        on_record: Callback | None = None, on_step: Callback | None = None, every: int = 1000) -> "Results | Run":
    """Runs the stages of a scene, to the same bits as the program element_test does.

    scene       a Scene, or what one is made from: a path, text or a dictionary
    output      folder for history, snapshots, ParaView files, checkpoints and summary; None: nothing is written but
                prepared specimens
    specimen    a Specimen or Snapshot to start from. Its grains, their number, sizes and density, its void ratio and its
                stress replace those of the scene; a difference is a warning and is not in the scene of the results. Its
                domain and the stiffness of its contacts must be the scene's (a test that begins with `rebalance` may
                have another stiffness). It is kept in `output` as specimen.h5, which the scene there names
    cache       folder of prepared specimens; None: next to the output folder, as the program does
    overwrite   replaces existing results; excludes resume
    resume      continues from the newest checkpoint of `output`. The scene is that of the run, but may say that a stage
                that is not over ends later, also of a run that has finished: strain, max_steps, times, and below until
                cycles, reversals_after_liquefaction, strain and volumetric_strain. The bits are those of one long run
    threads     0: as many as the packing can feed; changes no bit of the result
    quiet       None: warns, as IsostatWarning with the folder or the title of the run; True: only keeps the warnings;
                False: progress on stderr as well
    on_record   called with a Moment whenever a row of the history is due; return False to stop
    on_step     the same after every `every` steps

    Returns Results of the folder, or a Run with history, summary and snapshot if there is none. Ctrl-C writes a
    checkpoint and raises KeyboardInterrupt, and so does SIGTERM (SIGHUP, SIGUSR1, SIGXCPU) unless the program handles it;
    `resume=True` continues. An exception in a callback ends the run. Callbacks observe and must not change the packing.
    Raises InputError, and RunFailure with the step, the grain and the last checkpoint.
    """
    scene = as_scene(scene)
    if isinstance(specimen, _core.Snapshot):
        specimen = _core.Specimen(specimen)
    if not isinstance(specimen, _core.Specimen | None):
        raise _core.InputError(f"specimen: must be a Specimen or a Snapshot, but is {specimen!r}. Read a file with "
                               "read_specimen() or read_packing().")
    for name, function in (("on_record", on_record), ("on_step", on_step)):
        if function is not None and not callable(function):
            raise _core.InputError(f"{name}: must be a function of a Moment, but is {function!r}.")
    check_use(overwrite, resume)
    if (resume or overwrite) and output is None:
        raise _core.InputError("resume and overwrite need the output folder. Give output.")
    folder = path_text("output", output) if output is not None else ""
    if cache is None:
        cache = os.path.join(os.path.dirname(os.path.normpath(folder)), "specimens") if folder else CACHE
    with warned(folder or scene.title, quiet) as listed, stopped_by_signals():
        done = _core.run(scene, folder, path_text("cache", cache), specimen, overwrite, resume, threads,
                         quiet is not False, listed, on_record, on_step, every)
        if not folder:
            return Run(scene, done, listed)
        results = Results(folder)
        results.snapshot, results.warnings = done.snapshot, listed + results.warnings
        return results


class Run:
    """Results of run() in memory.

    history     History: a row whenever one was due        finished  False: a callback stopped it
    summary     as summary.json of a run with a folder; None of a run that was stopped
    snapshot    the packing at the end                     warnings  texts
    """

    def __init__(self, scene: Scene, done: _core.Result, warnings: list[str]):
        self.scene, self.snapshot, self.finished, self.warnings = scene, done.snapshot, done.finished, warnings
        self.history = History(done.history, done.units)
        self.summary: dict[str, Any] | None = json.loads(done.summary) if done.finished else None

    def draw(self, name: str) -> list[Any]:
        """The axes of one of the figures of element_test: run.draw("fig_stress_path")."""
        with tempfile.TemporaryDirectory() as name_of_folder:
            folder = pathlib.Path(name_of_folder)
            (folder / "summary.json").write_text(json.dumps(self.summary or {"title": self.scene.title}), encoding="utf-8")
            (folder / "scene.toml").write_text(self.scene.text, encoding="utf-8")
            with open(folder / "history.csv", "w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file)
                writer.writerow(f"{column} ({self.history.units[column]})" for column in self.history)
                writer.writerows(zip(*(column.tolist() for column in self.history.values())))
            return draw(folder, name)

    def __repr__(self):
        return f"<isostat.Run {self.scene.title!r}, {len(next(iter(self.history.values()), ()))} rows>"

# SPDX-License-Identifier: BSD-3-Clause
"""isostat study: the runs, tables and figures behind a page of results.

A study is a package of the folder studies, with

    runs(options) -> list        what is run: objects with name, kind, estimated_seconds(), scene(), and program if it is not
                                 element_test. Those of kind "prepare" come first and make what others of the same
                                 `specimen` need. In place of scene(): function, called in a separate process with the
                                 folder of results and arguments(), a dictionary; it returns one, too
    prepare(options, executor)   makes what several runs share, before runs(); scene() is None where it is still missing
    report(store, runs, folder)  leaves tables and figures of what has been run
    add_options(line)            its options, if it has any
    DEFAULTS, QUICK              of its options, and what `--quick` sets instead, with which long runs are left out
    PAGE                         the folder of docs/results that gets tables and figures, if its name is another

or with do(options, executor) in place of the first two.

tested: tests/apps/study_test.py, tests/studies/columns_test.py
"""
import argparse
import ast
import concurrent.futures
import contextlib
import functools
import hashlib
import importlib
import json
import os
import pathlib
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from typing import Any

from isostat import _core
from isostat.campaign import command
from isostat.campaign.folder import CampaignFolder, write_replacing
from isostat.campaign.functions import FunctionRun
from isostat.campaign.runs import Run, complete, program
from isostat.figures.command_line import meant
from isostat.running import as_scene

FREE_OPTIONS = ("jobs", "engine", "output", "overwrite", "quiet", "dry_run", "tables")  # change no table
QUICK_SECONDS = 20  # of CPU by estimate: of runs that `--quick` leaves in


def studies_folder() -> pathlib.Path:
    """The one of the repository, or the installed one.   Raises InputError"""
    package = pathlib.Path(__file__).parents[1]
    for parent in (pathlib.Path.cwd(), *package.parents):
        for folder in (parent / "studies", parent / "share/isostat/studies"):
            if (folder / "__init__.py").is_file():
                return folder
    raise _core.InputError("the folder studies is not in this installation. Call isostat study in the repository.")


def as_run(folder: pathlib.Path, planned: Any) -> Run:
    if hasattr(planned, "function"):
        return FunctionRun.of(folder, planned.name, planned.function, planned.arguments())
    scene = planned.scene()
    if scene is None:
        raise _core.InputError(f"{planned.name}: what it starts from has not been prepared.")
    return Run.below(folder, planned.name, scene if hasattr(scene, "text") else as_scene(scene),
                     program=getattr(planned, "program", "element_test"))


class Store:
    """What has been run in a folder, by the runs of a study."""

    def __init__(self, folder: pathlib.Path):
        self._folder = folder
        self._runs: dict[str, Run] = {}

    def run(self, planned: Any) -> Run:
        """Raises InputError where its scene needs what has not been prepared yet"""
        if planned.name not in self._runs:
            self._runs[planned.name] = as_run(self._folder, planned)
        return self._runs[planned.name]

    def folder(self, planned: Any) -> pathlib.Path:
        return self.run(planned).results

    def is_done(self, planned: Any) -> bool:
        with contextlib.suppress(_core.InputError):
            return self.run(planned).is_finished
        return False

    def cpu_seconds(self, planned: Any) -> float:
        """That have been spent on a run, as far as the next call continues what it left."""
        with contextlib.suppress(_core.InputError):
            run = self.run(planned)
            return run.cpu_seconds if run.is_finished or run.is_of_this_scene else 0
        return 0


def what_is_left(store: Store, planned: list[Any]) -> tuple[list[Any], float]:
    """The runs that have not ended, and their CPU seconds: those estimated, at the speed of what has been run, less those
    that interrupted runs have had."""
    done: list[Any] = []
    left: list[Any] = []
    for run in planned:
        (done if store.is_done(run) else left).append(run)
    estimated = sum(run.estimated_seconds() for run in done)
    speed = (sum(map(store.cpu_seconds, done)) / estimated if estimated else 1) or 1
    return left, sum(max(0, speed * run.estimated_seconds() - store.cpu_seconds(run)) for run in left)


def do_runs(study: Any, options: argparse.Namespace, executor: concurrent.futures.Executor) -> None:
    if not options.dry_run:
        CampaignFolder(options.output, {"scene.toml": f'title = "{options.name}"\n'}, owner="study",
                       overwrite=options.overwrite)
        getattr(study, "prepare", lambda *_: None)(options, executor)
    planned = study.runs(options)
    if options.quick:
        long = [run for run in planned if run.estimated_seconds() > QUICK_SECONDS]
        missing = {run.specimen for run in long if run.kind == "prepare"}
        planned = [run for run in planned if run not in long and getattr(run, "specimen", None) not in missing]
    store = Store(options.output)
    left, seconds_left = what_is_left(store, planned)
    print(f"{len(planned)} runs, {len(left)} to do, some {seconds_left / 60:.0f} CPU minutes", flush=True)
    if options.dry_run:
        return
    failed = []

    def state():
        to_do, seconds = what_is_left(store, planned)
        return (f"{len(planned) - len(to_do)} of {len(planned)} runs, ETA "
                f"{command.duration_text(seconds / max(1, options.jobs))}")

    progress = command.Progress(state, options.quiet)

    def ended(run, code, seconds):
        progress.say(f"  {run.name}: {'done' if code == 0 else f'exit code {code}: {run.reason}'}, {seconds:.0f} s")
        if code not in (0, 130):
            failed.append(run)

    try:
        for is_specimen in (True, False):
            complete(executor, [store.run(run) for run in left if (run.kind == "prepare") == is_specimen], ended,
                     progress.waiting)
    finally:
        folder = tables_folder(study, options, all(map(store.is_done, planned)))
        folder.mkdir(parents=True, exist_ok=True)
        study.report(store, planned, folder)
        if not options.tables and folder == page_of(study, options):
            stamp(options.name, study, sum(map(store.cpu_seconds, planned)) / 60)
        print(f"tables and figures in {folder}")
    if failed:
        raise _core.RunFailure(f"{len(failed)} of {len(planned)} runs failed, the first of them {failed[0].name}: "
                               f"{failed[0].reason}. The others are kept, the same command tries again.")


def settings_of(scene: str) -> list[tuple[str, str]]:
    """(key, value) of a scene's text, in its order; entries of lists of tables have the key of the list."""
    def leaves(key: str, value: Any) -> Iterator[tuple[str, str]]:
        if isinstance(value, dict):
            for name, inner in value.items():
                yield from leaves(f"{key}.{name}" if key else name, inner)
        elif isinstance(value, list) and any(isinstance(entry, dict) for entry in value):
            for entry in value:
                yield from leaves(key, entry)
        else:
            yield key, repr(value)
    return list(leaves("", tomllib.loads(scene)))


def fingerprint(name: str, study: Any, known: str | None = None) -> dict[str, str]:
    """`scenes`: SHA-256 of what a whole study runs: its scenes with every default. Of those that need something prepared
    it is the module that makes them, and the defaults of all programs. `keys`: those of these scenes. If `known` keys are
    given, others count only with a value that is not their default: a key that is newer than a page is off by default."""
    options = parse([], name, study)
    options.output = pathlib.Path("/nowhere")  # scenes name files in it
    scenes, modules = set(), set()
    for planned in study.runs(options):
        try:
            run = as_run(options.output, planned)
            is_scene = not isinstance(run, FunctionRun)
            (scenes if is_scene else modules).add(run.text)
        except _core.InputError:
            modules.add(repr(planned))
            is_scene = False
        if not is_scene:
            module = sys.modules[type(planned).__module__]
            modules.add(pathlib.Path(str(module.__file__)).read_text(encoding="utf-8"))
            scenes |= set(default_scenes())
    settings = [settings_of(scene) for scene in scenes]
    keys = set(known.split()) if known is not None else {key for of_scene in settings for key, _ in of_scene}
    defaults = set() if known is None else {line for scene in default_scenes() for line in settings_of(scene)}
    modules |= {"\n".join(f"{key} = {value}" for key, value in of_scene
                          if key in keys or (key, value) not in defaults) for of_scene in settings}
    text = "\n".join(sorted(modules)).replace(str(studies_folder().parent), "")
    return {"scenes": hashlib.sha256(text.encode()).hexdigest(), "keys": " ".join(sorted(keys))}


@functools.cache
def default_scenes() -> list[str]:
    """Of element tests and of columns."""
    column = subprocess.run([program("soil_column"), "--print-defaults"], check=True, capture_output=True, text=True)
    return [_core.default_scene(), column.stdout]


def stamps_in(folder: pathlib.Path) -> dict[str, dict[str, Any]]:
    path = folder / "stamps.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def stamp(name: str, study: Any, minutes: float) -> None:
    """Notes by which program, from what scenes, and in how many CPU minutes a page was made, in studies/stamps.json and
    the table of studies/README.md: tests/studies/stamps_test.py finds it stale."""
    path, readme = (studies_folder() / file for file in ("stamps.json", "README.md"))
    stamps = stamps_in(studies_folder())
    stamps[name] = {"revision": _core.__version__, "minutes": round(minutes), **fingerprint(name, study)}
    write_replacing(path, json.dumps(dict(sorted(stamps.items())), indent=1) + "\n")
    if readme.is_file():
        write_replacing(readme, re.sub(rf"^(\| `{name}` \|.*)\|[^|]*\|[^|]*\|$", rf"\1| {cells_of(stamps[name])} |",
                                       readme.read_text(encoding="utf-8"), flags=re.M))


def cells_of(stamp: dict[str, Any]) -> str:
    """The last two of the table: CPU minutes and revision."""
    return f"{stamp['minutes']} | {stamp['revision'].split('(')[-1].rstrip(')')}"


def page_of(study: Any, options: argparse.Namespace) -> pathlib.Path:
    return studies_folder().parent / "docs/results" / getattr(study, "PAGE", options.name)


def tables_folder(study: Any, options: argparse.Namespace, is_complete: bool) -> pathlib.Path:
    """Where tables and figures go: into the page's folder only if they are those of the whole study."""
    if options.tables:
        return options.tables
    page = page_of(study, options)
    whole = vars(parse([], options.name, study))
    asked = {key: value for key, value in vars(options).items() if key not in FREE_OPTIONS}
    of_page = is_complete and page.is_dir() and all(whole[key] == value for key, value in asked.items())
    return page if of_page else options.output / "tables"


def title_of(module: pathlib.Path) -> str:
    """The first line of its docstring; it is not imported."""
    return (ast.get_docstring(ast.parse(module.read_text(encoding="utf-8"))) or "").partition("\n")[0]


def listing() -> str:
    """A row of each study: name, CPU minutes that it took when its page was made, title."""
    folder = studies_folder()
    stamps = stamps_in(folder)
    rows = [f"  {'study':<20}{'CPU minutes':>11}  what"]
    for path in sorted(folder.glob("*/__init__.py")):
        name = path.parent.name
        rows.append(f"  {name:<20}{stamps.get(name, {}).get('minutes', '-'):>11}  {title_of(path)}")
    return "\n".join(rows) + "\nMinutes were measured, on one core, for the page; --dry-run estimates what remains."


def load(name: str) -> Any:
    folder = studies_folder()
    known = sorted(path.parent.name for path in folder.glob("*/__init__.py"))
    if name not in known:
        raise _core.InputError(f"{name}: unknown study. {meant(name, known, 'None is like it.')} There are: {', '.join(known)}.")
    sys.path[:0] = [str(folder.parent), str(pathlib.Path(__file__).parents[1])]  # studies, figures
    os.environ.setdefault("MPLBACKEND", "Agg")  # figures are only saved
    return importlib.import_module(f"studies.{name}")


def parse(words: list[str], name: str, study: Any) -> argparse.Namespace:
    line = line_of(name, study.__doc__)
    getattr(study, "add_options", lambda _: None)(line)
    line.set_defaults(name=name, **study.DEFAULTS)
    if "--quick" in words:
        line.set_defaults(**study.QUICK)
    options = line.parse_args(words)
    options.output = (options.output or pathlib.Path("results/studies") / (name + "_quick" * options.quick)).absolute()
    return options


def line_of(name: str, description: str) -> argparse.ArgumentParser:
    """With the options of every study."""
    line = command.line_of(f"study {name}", description, formatter_class=argparse.RawDescriptionHelpFormatter)
    command.add_campaign(line, "results/studies/NAME, with --quick results/studies/NAME_quick", figures=False)
    line.add_argument("--seeds", type=command.count(1, 1000), help="specimens of each kind")
    line.add_argument("--quick", action="store_true", help="a small part of it, in minutes")
    line.add_argument("--dry-run", action="store_true", help="only say how many runs there are, and how long they take")
    line.add_argument("--tables", type=pathlib.Path, help="folder of tables and figures (default: docs/results/NAME of the "
                      "repository when all is done with default options, else tables below the results)")
    return line


def main(words: list[str]) -> int:
    def with_study():
        if not words or words[0] in ("-h", "--help", "--list"):
            print("usage: isostat study NAME ...\n\n" + listing())
            if words and words[0] != "--list":
                options = line_of("NAME", "").format_help().partition("\n\n")[2]
                print(f"\n{options}\nSome studies have more: isostat study NAME --help")
            return
        study = load(words[0])
        options = parse(words[1:], words[0], study)
        command.with_engine(options, lambda executor: getattr(study, "do", lambda *given: do_runs(study, *given))(
            options, executor))
    return command.run(with_study)

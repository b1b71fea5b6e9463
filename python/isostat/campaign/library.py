# SPDX-License-Identifier: BSD-3-Clause
"""isostat library: realisations of one periodic specimen, at several pressures and densities, in one file.

     scene --+-- seeds                   s0001 --->  [specimen] file = "library.h5#s0001"
             +-- pressures           --> s0002
             +-- relative densities      ...         library.h5

Each specimen is prepared by a run of element_test without stages, into the cache next to the library; the library is
written from the cache. library_preparation/ has the logs of these runs, until all specimens are there.

tested: tests/apps/library_test.py
"""
import argparse
import concurrent.futures
import dataclasses
import pathlib
import shutil
import sys
import time

from isostat import _core
from isostat.campaign import command
from isostat.campaign.folder import CampaignFolder
from isostat.campaign.runs import Run, complete
from isostat.campaign.scenes import below_campaign
from isostat.scene import Scene

DENSITIES = {"relative_density": "D_r {}", "void_ratio": "e {}", "preparation_friction": "prepared at {}"}


@dataclasses.dataclass(frozen=True)
class Request:
    """A specimen for the library."""

    name: str  # "seed 3, isotropic 50 kPa, D_r 0.5"
    scene: Scene

    @classmethod
    def of(cls, scene: Scene) -> "Request":
        sections = scene.to_dict()
        specimen = sections["specimen"]
        density = next(text.format(specimen[key]) for key, text in DENSITIES.items() if key in specimen)
        return cls(f"seed {sections['grading']['seed']}, {specimen['consolidation']} {specimen['pressure']}, {density}",
                   scene)

    def preparation(self, folder: pathlib.Path) -> Run:
        """A run that puts it into the cache."""
        sections = self.scene.to_dict()
        sections.pop("stage", None)
        below_campaign(sections)
        return Run.below(folder, self.name.replace(", ", "_").replace(" ", ""), Scene(sections))


def checked_scene(options: argparse.Namespace) -> Scene:
    consolidation = {"specimen.consolidation": options.consolidation} if options.consolidation else {}
    scene = Scene(options.scene, set=command.overrides(options.set) | consolidation)
    specimen = scene.to_dict()["specimen"]
    if specimen["domain"] != "periodic-cell":
        raise _core.InputError(f"{options.scene}: specimen.domain = \"{specimen['domain']}\", but a library is for volume "
                               "elements, which are periodic. Give domain = \"periodic-cell\" in [specimen], or --set "
                               "specimen.domain=periodic-cell.")
    if specimen.get("file"):
        raise _core.InputError(f"{options.scene}: specimen.file = \"{specimen['file']}\", but a library is prepared, not "
                               "read. Give relative_density = 0.5 instead.")
    return scene


def with_each(scenes: list[Scene], key: str, option: str, items: str | None) -> list[Scene]:
    """The scenes with each value that an option lists for a key of [specimen].   Raises InputError"""
    if items is None:
        return scenes
    found = []
    for scene in scenes:
        sections = scene.to_dict()
        for other in DENSITIES if key in DENSITIES else ():
            sections["specimen"].pop(other, None)
        for item in map(str.strip, items.split(",")):
            try:
                found.append(Scene(sections, set={f"specimen.{key}": item}))
            except _core.InputError as error:
                text = str(error).removeprefix(f"--set specimen.{key}: ")
                raise _core.InputError(f"{option}: \"{item}\": {text}") from error
    return found


def requests_of(scene: Scene, options: argparse.Namespace) -> list[Request]:
    """Every combination of pressure, density and seed, the seed running fastest.   Raises InputError"""
    scenes = with_each([scene], "pressure", "--pressures", options.pressures)
    scenes = with_each(scenes, "relative_density", "--relative-densities", options.relative_densities)
    first = scene.to_dict()["grading"]["seed"]
    requests: dict[str, Request] = {}
    for one in scenes:
        for seed in range(first, first + options.realisations):
            request = Request.of(one.with_(**{"grading.seed": seed}))
            if requests.setdefault(request.scene.recipe, request) is not request:
                raise _core.InputError(f"{request.name}: asked for twice. Name every pressure and density once.")
    return list(requests.values())


def check_output(path: pathlib.Path, options: argparse.Namespace) -> None:
    """Raises InputError where no library may be written."""
    if path.suffix != ".h5":
        raise _core.InputError(f"--output {path}: must end in .h5, because scenes recognise a library by it. Give for example "
                               "--output results/library.h5.")
    if path.is_dir():
        raise _core.InputError(f"{path}: is a folder, not a file. Choose another --output.")
    if path.exists() and not (options.append or options.overwrite):
        raise _core.InputError(f"{path}: the library exists. Give --append to add what it lacks, --overwrite to replace "
                               "it, or --output for another one.")


def prepare(requests: list[Request], folder: pathlib.Path, cache: pathlib.Path, executor: concurrent.futures.Executor,
            quiet: bool) -> dict[Request, tuple[int, str]]:
    """Brings specimens into the cache.   Returns those that failed, with exit code and reason"""
    runs = {request.preparation(folder): request for request in requests
            if not _core._cached_specimen(request.scene, cache).is_file()}
    failures: dict[Request, tuple[int, str]] = {}
    start, n_ended = time.monotonic(), 0

    def state():
        done, left = len(requests) - len(runs) + n_ended, len(runs) - n_ended
        eta = f", ETA {command.duration_text((time.monotonic() - start) * left / n_ended)}" if left and n_ended else ""
        return f"{100 * done / len(requests):3.0f} %  {done} of {len(requests)} specimens{eta}"

    def ended(run, code, seconds):
        nonlocal n_ended
        n_ended += 1
        if code:
            said = run.reason.removeprefix("error: ").removeprefix("failed: ")
            failures[runs[run]] = code, said or f"exit code {code}, see {run.log}"
        progress.say(f"  {runs[run].name}: {'FAILED' if code else 'ready'}, {seconds:.0f} s")

    progress = command.Progress(state, quiet)
    if len(runs) < len(requests):
        progress.say(f"  {len(requests) - len(runs)} taken from {cache}")
    complete(executor, runs, ended, progress.waiting)
    return failures


def from_cache(requests: list[Request], cache: pathlib.Path) -> list[_core.Specimen]:
    """Prints the warnings of the specimens, each text once."""
    specimens, reported = [], set()
    for request in requests:
        warnings: list[str] = []
        specimens.append(_core.prepare(request.scene, str(cache), 1, True, warnings))
        for text in warnings:
            if text not in reported:
                print(f"warning: {request.name}: {text}", file=sys.stderr)
        reported.update(warnings)
    return specimens


def print_library(path: pathlib.Path) -> None:
    table, recipes, remarks = _core._describe_library(path)
    print(f"{path}: {len(recipes)} specimens\n{table}", end="")
    for remark in remarks:
        print(f"warning: {remark}", file=sys.stderr)


def make_library(options: argparse.Namespace, executor: concurrent.futures.Executor) -> None:
    if options.scene is None:
        raise _core.InputError("no scene given. Try isostat library apps/scenes/rve_library.toml, or --help.")
    scene = checked_scene(options)
    requests = requests_of(scene, options)
    path = options.output or pathlib.Path(f"{scene.folder}.h5")
    check_output(path, options)
    there = set(_core._describe_library(path)[1] if options.append and path.exists() else ())
    requests = [request for request in requests if request.scene.recipe not in there]
    failures = {}
    if requests:
        folder, cache = path.with_name(f"{path.stem}_preparation"), path.parent / scene.to_dict()["specimen"]["cache"]
        CampaignFolder(folder, {"scene.toml": scene.text}, overwrite=True)  # what counts is in the cache
        failures = prepare(requests, folder, cache, executor, options.quiet)
        specimens = from_cache([request for request in requests if request not in failures], cache)
        if specimens:
            _core.write_library(path, specimens, overwrite=options.overwrite, append=options.append)
        if not failures:
            shutil.rmtree(folder)
    if len(failures) < len(requests) or not requests:
        print_library(path)
    if failures:
        text = (f"{len(failures)} of {len(requests)} specimens could not be prepared and are not in the library (logs in "
                f"{folder / 'logs'}):" + "".join(f"\n  {request.name}: {failures[request][1]}" for request in requests
                                                 if request in failures))
        bad_input = all(code == 2 for code, _ in failures.values())
        raise _core.InputError(text) if bad_input else _core.RunFailure(text)


def list_library(options: argparse.Namespace) -> None:
    path = options.output or pathlib.Path(options.scene or "")
    if path.suffix != ".h5":
        raise _core.InputError("--list: no library given. Give --list --output results/library.h5.")
    print_library(path)


def parse(words: list[str]) -> argparse.Namespace:
    line = command.line_of("library", "A library of periodic specimens: realisations at several pressures and "
                           "densities in one file")
    command.add_scene(line, "scene file (TOML) in a periodic cell; its stages are not run", nargs="?")
    line.add_argument("-n", "--realisations", type=command.count(1, 1000000), default=1,
                      help="seeds at each pressure and density, from grading.seed of the scene on (default 1)")
    line.add_argument("--pressures", help="instead of specimen.pressure, e.g. \"20 kPa,50 kPa\"; with k0 the vertical "
                      "stress")
    line.add_argument("--relative-densities", help="instead of the density or preparation friction of the scene, e.g. "
                      "0.5,0.64")
    line.add_argument("--consolidation", choices=("isotropic", "k0"), help="instead of specimen.consolidation")
    command.add_engine(line, jobs=0)
    line.add_argument("-o", "--output", type=pathlib.Path, help="library (default: results/<scene name>.h5)")
    line.add_argument("--list", action="store_true", help="print what is in the library, and stop")
    use = line.add_mutually_exclusive_group()
    use.add_argument("--append", action="store_true", help="add what an existing library lacks")
    use.add_argument("--overwrite", action="store_true", help="replace an existing library")
    return line.parse_args(words)


def main(words: list[str]) -> int:
    options = parse(words)
    if options.list:
        return command.run(lambda: list_library(options))
    return command.run_campaign(options, lambda executor: make_library(options, executor))

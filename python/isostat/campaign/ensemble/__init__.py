# SPDX-License-Identifier: BSD-3-Clause
"""isostat ensemble: a column of soil with many sets of packings, with many records, and the bands of all.

    FOLDER/scene.toml           what all share: distinguishes this ensemble from others
    FOLDER/scenes/NAME.toml     scene of a member       FOLDER/members/NAME/   its results, kept by the next call
    FOLDER/logs/NAME.log        what it printed         FOLDER/ensemble.json, members.csv, bands_*.csv   results of all

tested: tests/apps/column_ensemble_test.py
"""
import argparse
import concurrent.futures
import pathlib

from isostat import _core
from isostat.campaign import command
from isostat.campaign.ensemble.members import ensemble_members, read_scene, validated_text
from isostat.campaign.ensemble.report import report
from isostat.campaign.ensemble.results import read_member
from isostat.campaign.folder import CampaignFolder
from isostat.campaign.runs import Run, complete


def do_runs(runs: list[Run], executor: concurrent.futures.Executor, quiet: bool, failures: dict[str, str]) -> None:
    """Those that have not finished. What fails is noted and does not stop the rest."""
    progress = command.Progress(lambda: f"{sum(run.is_finished for run in runs)} of {len(runs)} members", quiet)

    def ended(run, code, seconds):
        if code not in (0, 130):
            failures[run.name] = f"exit code {code}: {run.reason}"
        progress.say(f"  {run.name}: {'done' if code == 0 else 'not finished'}, {seconds:.0f} s")

    complete(executor, [run for run in runs if not run.is_finished], ended, progress.waiting)


def find_ensemble(options: argparse.Namespace, executor: concurrent.futures.Executor) -> None:
    scene, members = asked_members(options)
    folder = options.output or pathlib.Path(f"{scene.folder}_ensemble")
    runs = {member.name: member.run(folder, options.threads) for member in members}
    failures: dict[str, str] = {}
    held = CampaignFolder(folder, {"scene.toml": scene.with_(**{"output.folder": "members"}).text},
                          overwrite=options.overwrite, program="soil_column")
    try:
        do_runs(list(runs.values()), executor, options.quiet, failures)
    finally:
        results = []
        for member in members:
            if runs[member.name].is_finished:
                try:
                    results.append(read_member(member, runs[member.name].results))
                except _core.InputError as error:
                    failures[member.name] = str(error)
        if results:
            report(scene, results, len(members), failures, held.path, not options.no_figures)
    if failures:
        name, why = min(failures.items())
        raise _core.RunFailure(f"{len(failures)} of {len(members)} members failed, the first of them, {name}, with {why}. "
                               "The others are kept, the same command tries again")


def asked_members(options: argparse.Namespace) -> tuple:
    """The scene and its members.   Raises InputError"""
    if not options.members and not options.records:
        raise _core.InputError("-n and --records are missing: give how many members, each with packings of its own, or the "
                               "records that they have. A single run is one of soil_column.")
    scene = read_scene(options)
    return scene, ensemble_members(scene, options.members or 1, options.records)


def main(words: list[str]) -> int:
    line = command.line_of("ensemble", "A soil column with many sets of packings, or with many records, side by side: "
                           "bands of all")
    command.add_scene(line, "scene file (TOML) of soil_column; see docs/column_scene_reference.md")
    line.add_argument("-n", "--members", type=command.count(1, 10000),
                      help="this many members, each with other packings of the library; the same command continues with those "
                           "that are missing")
    line.add_argument("--records", type=lambda text: text.split(","), action="extend", default=[], metavar="FILES",
                      help="files between commas whose motions take the place of the scene's record: this many members, or "
                           "with -n this many times as many")
    line.add_argument("-t", "--threads", type=command.count(0, 1024), default=1,
                      help="threads of each member that share its packings, 0: all the process may use (default 1). Results "
                           "do not depend on it")
    line.add_argument("--validate", action="store_true",
                      help="check scenes, libraries and records of all members, print the scene with every key, and stop")
    command.add_campaign(line, "results/<scene name>_ensemble")
    options = line.parse_args(words)
    if options.validate:
        return command.run(lambda: print(validated_text(*asked_members(options))))
    return command.run_campaign(options, lambda executor: find_ensemble(options, executor))

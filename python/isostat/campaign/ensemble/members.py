# SPDX-License-Identifier: BSD-3-Clause
"""The members of an ensemble: one column, run with other packings and other records.

tested: tests/apps/column_ensemble_test.py
"""
import argparse
import dataclasses
import importlib
import os
import pathlib
from typing import Any

from isostat import _core
from isostat.campaign import command
from isostat.campaign.runs import Run


@dataclasses.dataclass(frozen=True)
class Member:
    """A run of the scene."""

    name: str  # of its folder: number of its packings, "04", or of record and packings, "r01_04"
    packings: int  # its number among those of the same record
    record: str  # absolute path; empty: that of the scene
    scene: Any  # isostat.column.ColumnScene, which needs deal.II

    def run(self, folder: pathlib.Path, threads: int = 1) -> Run:
        return Run.below(folder, self.name, self.scene, program="soil_column", results="members", threads=threads)


def read_scene(options: argparse.Namespace):
    """The ColumnScene of the command line.   Raises InputError"""
    try:
        column = importlib.import_module("isostat.column")  # loads deal.II
    except ImportError as error:
        raise _core.InputError(str(error)) from error
    return column.ColumnScene(options.scene, set=command.overrides(options.set))


def check_kind(scene, n: int) -> None:
    """Raises InputError where members cannot be run or compared, or would all be the same."""
    sections = scene.to_dict()
    layers, realisations = sections["layer"], sections["grains"]["realisations"]
    grains = [layer for layer in layers if layer["material"] == "grains"]
    if sections["analysis"]["kind"] == "consolidation":
        raise _core.InputError("analysis.kind = \"consolidation\": an ensemble of it has neither packings nor motions "
                               "that could differ. Run it alone, with soil_column.")
    if sections["mesh"]["distributed"]:
        raise _core.InputError("mesh.distributed = true: leaves no profiles to compare. Give distributed = false; members, "
                               "not parts of the mesh, are shared out then.")
    for k, layer in enumerate(layers):
        if layer["material"] == "user":
            raise _core.InputError(f"layer.{k}.material = \"user\": members run in separate processes, which do not have "
                                   "materials of Python. Run them there with isostat.column.run(), seed by seed.")
    if n > 1 and not grains:
        raise _core.InputError(f"-n {n}: without a layer of grains, whose seeds differ, all members would be the same. "
                               "Leave it out and give --records, one motion for each member.")
    if n > 1 and all(1 < layer["mixed_realisations"] == realisations for layer in grains):
        raise _core.InputError(f"-n {n}: all members would have the same packings, because every point has all seeds that "
                               f"it draws from: mixed_realisations = grains.realisations = {realisations}. Give layers more "
                               "mixed_realisations, or 1.")


def check_records(scene, records: list[str]) -> None:
    """Raises InputError"""
    if records and [motion["kind"] for motion in scene.to_dict().get("motion", [])].count("record") != 1:
        raise _core.InputError("--records: the scene must have exactly one [[motion]] of kind = \"record\", whose place they "
                               "take. Give it one, or leave --records out.")
    for k, record in enumerate(records):
        if not record or records.count(record) > 1:
            raise _core.InputError(f"--records: file {k + 1} of {len(records)}, \"{record}\", "
                                   f"{'appears twice' if record else 'has no name'}. Give files that differ between "
                                   "commas, such as --records first.txt,second.AT2; they count from the working directory.")


def make_member(scene, k: int, record: str, name: str) -> Member:
    """The k-th member with a record. It has a cache of packings of its own: members do not wait for each other."""
    sections = scene.member(k).to_dict()
    sections["title"] = "; ".join(filter(None, (scene.title, f"member {name}")))
    sections["output"]["folder"] = f"members/{name}"
    if record:
        next(motion for motion in sections["motion"] if motion["kind"] == "record")["file"] = record
    if "cache" in sections["grains"]:
        stem, extension = os.path.splitext(sections["grains"]["cache"])
        sections["grains"]["cache"] = f"{stem}_{name}{extension}"
    return Member(name, k, record, type(scene)(sections))


def ensemble_members(scene, n: int, records: list[str]) -> list[Member]:
    """All members, record by record.   Raises InputError; libraries and records have been read"""
    check_kind(scene, n)
    check_records(scene, records)
    members = []
    for r, record in enumerate(records or [""]):
        for k in range(n):
            name = "_".join(([f"r{r:02d}"] if record else []) + ([f"{k:02d}"] if n > 1 or not record else []))
            try:
                members.append(make_member(scene, k, record and os.path.abspath(record), name))
                if k == n - 1:  # it needs the last seeds of the library
                    members[-1].scene.check_inputs()
            except _core.InputError as error:
                raise _core.InputError(f"member {name}: {error}") from error
    return members


def validated_text(scene, members: list[Member]) -> str:
    """The scene with every key, and in comments how each member differs from it."""
    lines = [f"{scene.text}\n# {len(members)} member{'s' if len(members) > 1 else ''} of an ensemble, whose scenes, "
             "libraries and records are valid:"]
    for member in members:
        changed = [f"layer.{k}.{key} = {layer[key]}" for k, layer in enumerate(member.scene.to_dict()["layer"])
                   if layer["material"] == "grains"
                   for key in ["lot" if layer["mixed_realisations"] > 1 else "realisation"]]
        lines.append(" ".join([f"# {member.name}:", *changed, *[f"record {member.record}"] * bool(member.record)]))
    return "\n".join(lines)

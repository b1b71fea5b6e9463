# SPDX-License-Identifier: BSD-3-Clause
"""isostat vtkhdf: what a run has stored over time as one file for ParaView, instead of a file for each moment.

VTKHDF 2.0, PolyData and UnstructuredGrid with the group Steps, as docs.vtk.org describes them.

tested: tests/apps/view_test.py
"""
import pathlib
import re
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from typing import Any

import h5py
import numpy as np

from isostat import _core
from isostat.campaign import command
from isostat.figures.files import check_results, check_target, replacing
from isostat.packings.vtp import Arrays

Moments = list[tuple[float, pathlib.Path]]  # time in s, file
CELLS = {"PolyData": {"Vertices": "Verts", "Lines": "Lines", "Polygons": "Polys", "Strips": "Strips"},
         "UnstructuredGrid": {".": "Cells"}}  # groups of a VTKHDF file, elements of a VTK XML file
SHAPES: dict[str, Callable[..., None]] = {"grains": _core.write_vtp, "force_chains": _core.write_force_chains_vtp}


def collection(path: pathlib.Path) -> Moments:
    """Times and files of a .pvd."""
    found = re.findall(r'timestep="([^"]+)".*?file="([^"]+)"', path.read_text(encoding="utf-8"))
    return [(float(time), path.parent / name) for time, name in found]


def packings(folder: pathlib.Path) -> dict[str, Moments]:
    """The packings that a run has stored: of a test "", of a column "d0", "d1", ... for each snapshot depth."""
    taken = {path.stem: [(time, file.with_suffix(".h5")) for time, file in collection(path)]
             for path in sorted((folder / "grains").glob("d*.pvd"))}
    if files := sorted((folder / "snapshots").glob("snapshot_*.h5")):
        taken[""] = []
        for path in files:
            with h5py.File(path) as file:
                taken[""].append((float(file["snapshot"].attrs["time"]), path))
    return {name: moments for name, moments in taken.items() if moments}


def meshes(folder: pathlib.Path) -> dict[pathlib.Path, Moments]:
    """The .pvd of a mesh, and its moments."""
    return {path: collection(path) for path in sorted((folder / "paraview").glob("*.pvd"))}


def draw(shape: str, packing: pathlib.Path, path: pathlib.Path) -> pathlib.Path:
    """Writes the grains or force_chains of a stored packing as .vtp; the path."""
    SHAPES[shape](str(path), _core.read_snapshot(str(packing)), overwrite=True)
    return path


class Writer:
    """A VTKHDF file that grows by one moment at a time. A mesh stays where it is, so it is stored once."""

    def __init__(self, file: h5py.File, kind: str) -> None:
        self.root, self.kind = file.create_group("VTKHDF"), kind
        self.root.attrs["Version"] = [2, 0]
        self.root.attrs["Type"] = np.bytes_(kind)
        self.root.create_group("Steps").attrs["NSteps"] = 0

    def append(self, name: str, values: Any) -> int:
        """Adds rows to a dataset; how many it had."""
        rows = np.asarray(values)
        if name not in self.root:
            self.root.create_dataset(name, data=rows, maxshape=(None, *rows.shape[1:]), chunks=True, compression="gzip",
                                     compression_opts=1)
            return 0
        n = len(self.root[name])
        self.root[name].resize(n + len(rows), axis=0)
        self.root[name][n:] = rows
        return n

    def _add_cells(self, piece: ET.Element, arrays: Arrays) -> tuple[list[int], list[int]]:
        """Where the cells of each group begin, and where their points."""
        begins, ends = [], []
        for group, element in CELLS[self.kind].items():
            cells = piece.find(element)
            points, offsets = (arrays.named(cells, name).astype(np.int64) for name in ("connectivity", "offsets"))
            part = self.append(f"{group}/NumberOfCells", [len(offsets)])
            self.append(f"{group}/NumberOfConnectivityIds", [len(points)])
            ends.append(self.append(f"{group}/Connectivity", points))
            begins.append(self.append(f"{group}/Offsets", [0, *offsets]) - part)  # one more than cells in each part
            if self.kind == "UnstructuredGrid":
                self.append("Types", arrays.named(cells, "types").astype(np.uint8))
        return begins, ends

    def add(self, time: float, path: pathlib.Path) -> None:
        """The one piece of a .vtp or .vtu of Isostat."""
        file = ET.parse(path).getroot()
        piece, arrays, steps = file.find("*/Piece"), Arrays(path, file), self.root["Steps"]
        assert piece is not None
        row: dict[str, Any] = {"Values": time, "NumberOfParts": 1}
        if self.kind == "UnstructuredGrid" and steps.attrs["NSteps"]:
            row |= {name: steps[name][0] for name in
                    ("PartOffsets", "PointOffsets", "CellOffsets", "ConnectivityIdOffsets")}
        else:
            points = arrays.stored(piece.find("Points/DataArray")).reshape(-1, 3)
            row |= {"PartOffsets": self.append("NumberOfPoints", [len(points)]),
                    "PointOffsets": self.append("Points", points)}
            row["CellOffsets"], row["ConnectivityIdOffsets"] = self._add_cells(piece, arrays)
        for array in piece.findall("PointData/DataArray"):
            name, width = array.get("Name"), int(array.get("NumberOfComponents", 1))
            values = arrays.stored(array)
            row[f"PointDataOffsets/{name}"] = self.append(f"PointData/{name}",
                                                          values.reshape(-1, width) if width > 1 else values)
        for name, value in row.items():
            self.append(f"Steps/{name}", np.array([value]))
        steps.attrs["NSteps"] += 1


Film = tuple[pathlib.Path, str, Iterator[tuple[float, pathlib.Path]]]


def films(folder: pathlib.Path, aside: pathlib.Path) -> Iterator[Film]:
    """File, kind and moments of each film of a run; .vtp of packings are made in the folder `aside`."""
    for name, moments in packings(folder).items():
        for shape in SHAPES:
            path = folder / (f"grains/{name}_{shape}.vtkhdf" if name else f"{shape}.vtkhdf")
            yield path, "PolyData", ((time, draw(shape, file, aside / "one.vtp")) for time, file in moments)
    for pvd, moments in meshes(folder).items():
        yield pvd.with_suffix(".vtkhdf"), "UnstructuredGrid", iter(moments)


def convert(folder: pathlib.Path) -> None:
    """Writes a .vtkhdf for the grains, the force chains and the mesh, where the run has stored them.

    Raises InputError if it has stored nothing.
    """
    check_results(folder)
    target = None
    with tempfile.TemporaryDirectory() as aside:
        for target, kind, moments in films(folder, pathlib.Path(aside)):
            check_target(target, {".vtkhdf": b"HDF"})
            with replacing(target) as path, h5py.File(path, "w") as file:
                writer = Writer(file, kind)
                for time, moment in moments:
                    writer.add(time, moment)
                print(f"{target}: {file['VTKHDF/Steps'].attrs['NSteps']} moments", flush=True)
    if not target:
        raise nothing_stored(folder)


def nothing_stored(folder: pathlib.Path) -> Exception:
    return _core.InputError(f"{folder}: has no stored packings and no mesh. Run it with output.snapshots = \"strain\", "
                            "a column with grains.snapshot_depths or output.paraview_interval.")


def main(words: list[str]) -> int:
    line = command.line_of("vtkhdf", "Grains, force chains and mesh over time as one VTKHDF file each, for ParaView "
                           "5.12 and later: RESULTS/grains.vtkhdf, force_chains.vtkhdf, of a column "
                           "grains/dK_grains.vtkhdf, grains/dK_force_chains.vtkhdf, paraview/column.vtkhdf")
    line.add_argument("results", metavar="RESULTS", type=pathlib.Path,
                      help="results folder of element_test or soil_column")
    folder = line.parse_args(words).results
    return command.run(lambda: convert(folder))

# SPDX-License-Identifier: BSD-3-Clause
"""isostat vtkhdf and isostat view of an element test and of a column of packings: every moment as it was stored;
pictures; what they refuse."""
import importlib.util
import os
import shutil

import h5py
import numpy as np
from PIL import Image

from grain_column_test import GrainColumnTest
from support import AppTest, tiny_scene

NO_VIEWER = ("" if importlib.util.find_spec("vtkmodules") and (os.environ.get("DISPLAY") or shutil.which("xvfb-run"))
             else "python3-vtk9, or xvfb for pictures without a display, is not installed")


def moment(film, k, kind, name):
    """Points, indices of the points of cells, and a field at moment k, found by the offsets of VTKHDF 2.0."""
    steps, group = film["Steps"], film[kind]
    column = ["Vertices", "Lines", "Polygons", "Strips"].index(kind)
    part = steps["PartOffsets"][k]
    first, n = steps["PointOffsets"][k], film["NumberOfPoints"][part]
    begin = steps["ConnectivityIdOffsets"][k, column]
    ids = group["Connectivity"][begin:begin + group["NumberOfConnectivityIds"][part]]
    begin = steps["CellOffsets"][k, column] + part
    ends = group["Offsets"][begin:begin + group["NumberOfCells"][part] + 1]
    at = steps[f"PointDataOffsets/{name}"][k]
    return film["Points"][first:first + n], np.split(ids, ends[1:-1]), film[f"PointData/{name}"][at:at + n]


def differing(one, other):
    """Share of the pixels that differ between two pictures, in the left and in the right half."""
    there = (np.array(one) != np.array(other)).any(axis=2)
    return [float(half.mean()) for half in np.array_split(there, 2, axis=1)]


class Tests(AppTest):
    def setUp(self):
        super().setUp()
        if not (self.cache / "run").exists():
            scene = tiny_scene(output='snapshots = "reversals"\nparaview = false')
            self.assert_done(self.run_test(self.write("tiny.toml", scene), "-o", self.cache / "run", "-q"))
        shutil.copytree(self.cache / "run", self.folder / "run")

    def isostat(self, *words, **environment):
        return self.run_command(self.command("isostat", *words), env=os.environ | environment)

    def test_films_hold_what_was_stored(self):
        self.assert_done(self.isostat("vtkhdf", "run"))
        paths = sorted((self.folder / "run/snapshots").glob("*.h5"))
        self.assertGreater(len(paths), 2)
        with (h5py.File(self.folder / "run/grains.vtkhdf") as grains,
              h5py.File(self.folder / "run/force_chains.vtkhdf") as chains):
            grains, chains = grains["VTKHDF"], chains["VTKHDF"]
            self.assertEqual((list(grains.attrs["Version"]), grains.attrs["Type"]), ([2, 0], b"PolyData"))
            self.assertEqual([film["Steps"].attrs["NSteps"] for film in (grains, chains)], 2 * [len(paths)])
            for k, path in enumerate(paths):
                with h5py.File(path) as file:
                    stored = file["snapshot"]
                    self.assertEqual(grains["Steps/Values"][k], stored.attrs["time"])
                    points, cells, radius = moment(grains, k, "Vertices", "radius")
                    np.testing.assert_array_equal(np.column_stack([points, radius]), stored["grains/position"])
                    np.testing.assert_array_equal(np.ravel(cells), np.arange(len(points)))
                    np.testing.assert_array_equal(moment(grains, k, "Vertices", "velocity")[2],
                                                  stored["grains/velocity"][:, :3])
                    points, cells, force = moment(chains, k, "Lines", "normal_force")
                    self.assertEqual({len(cell) for cell in cells}, {2})
                    self.assertEqual(set(force), set(stored["contacts/normal_force"]))

    def test_pictures(self):
        if NO_VIEWER:
            self.skipTest(NO_VIEWER)
        self.assert_done(self.isostat("view", "run", "--picture", "end.png"))  # is replaced
        for name, words in (("start", ("--time", 0)), ("end", ()), ("velocity", ("--colour", "velocity"))):
            self.assert_done(self.isostat("view", "run", "--picture", f"{name}.png", *words))
        start, end, velocity = (Image.open(self.folder / f"{name}.png").convert("RGB")
                                for name in ("start", "end", "velocity"))
        self.assertEqual(start.size, (1400, 760))
        white = Image.new("RGB", start.size, "white")
        self.assertGreater(min(differing(start, white)), 0.1)  # loose: grains and chains cover a third of a half
        self.assertGreater(min(differing(start, end)), 0.01)  # loose: every contact has another force
        self.assertGreater(differing(end, velocity)[0], 0.01)  # loose: nearly every grain has another colour
        self.assertEqual(differing(end, velocity)[1], 0)

    def test_what_they_refuse(self):
        (self.folder / "empty").mkdir()
        self.write("mine.png", "precious")
        self.write("run/grains.vtkhdf", "precious")
        self.assert_refused(self.isostat("vtkhdf", "run"),
                            "run/grains.vtkhdf: exists and is not a file of this command")
        for command in ("vtkhdf", "view"):  # without a display, too
            for words, said in ((["empty"], "empty: has no stored packings and no mesh. Run it with"),
                                (["none"], "none: does not exist. Give the results folder of a run"),
                                (["mine.png"], "mine.png: is a file, not a results folder")):
                self.assert_refused(self.isostat(command, *words, DISPLAY=""), said)
        for words, said in ((("--picture", "mine.png"), "mine.png: exists and is not a file of this command"),
                            (("--picture", "scene.toml"), "scene.toml: must end with .png"),
                            (("--picture", "none/a.png"), "none/a.png: cannot be written: there is no folder"),
                            (("--time", "9"), "--time 9: run has stored moments from 0 to 0.")):
            self.assert_refused(self.isostat("view", "run", *words, DISPLAY=""), said)
        self.assertEqual((self.folder / "mine.png").read_text(), "precious")
        (self.folder / "none/vtkmodules").mkdir(parents=True)
        self.write("none/vtkmodules/__init__.py", "raise ImportError\n")
        self.assert_refused(self.isostat("view", "run", PYTHONPATH=str(self.folder / "none")),
                            "isostat view: needs VTK for this Python: apt-get install python3-vtk9")
        if not NO_VIEWER:
            self.assert_refused(self.isostat("view", "run", DISPLAY=""), "there is no display (DISPLAY is not set)")


class Columns(GrainColumnTest):
    def check_fields(self, film):
        from vtkmodules.util.numpy_support import vtk_to_numpy  # pylint: disable=import-outside-toplevel
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader  # pylint: disable=import-outside-toplevel
        for k, path in enumerate(sorted((self.folder / "whole/paraview").glob("*.vtu"))):
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(str(path))
            reader.Update()
            fields = reader.GetOutput().GetPointData()
            for name in film["PointData"]:
                values = vtk_to_numpy(fields.GetArray(name))
                at = film[f"Steps/PointDataOffsets/{name}"][k]
                np.testing.assert_array_equal(film[f"PointData/{name}"][at:at + len(values)], values)

    def test_film_and_picture(self):
        """The mesh is stored once. Its fields are those of the profiles at the start, and those that VTK reads."""
        self.whole()
        self.assert_done(self.run_app("isostat", "vtkhdf", "whole"))
        with (h5py.File(self.folder / "whole/paraview/column.vtkhdf") as file,
              h5py.File(self.folder / "whole/profiles.h5") as profiles):
            film = file["VTKHDF"]
            steps, n = film["Steps"], len(film["Points"])
            self.assertEqual((n, list(film["NumberOfCells"]), set(film["Types"])), (10, [5], {3}))
            self.assertEqual((set(steps["PointOffsets"]), steps["CellOffsets"].shape), ({0}, (3, 1)))
            np.testing.assert_array_equal(np.sort(film["PointData/sigma_v"][:n:2]),
                                          np.sort(profiles["sigma_v"][0]).astype(np.float32))
            if not NO_VIEWER:
                self.check_fields(film)
        for name in ("d0_grains", "d1_force_chains"):
            with h5py.File(self.folder / f"whole/grains/{name}.vtkhdf") as file:
                self.assertEqual(file["VTKHDF/Steps"].attrs["NSteps"], 3)
        if NO_VIEWER:
            self.skipTest(NO_VIEWER)
        self.assert_done(self.run_app("isostat", "view", "whole", "--picture", "picture.png"))
        picture = Image.open(self.folder / "picture.png").convert("RGB")
        white = Image.new("RGB", (1400, 1000), "white")
        self.assertGreater(min(differing(picture, white)), 0.05)  # loose: it is not empty

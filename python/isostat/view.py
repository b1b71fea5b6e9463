# SPDX-License-Identifier: BSD-3-Clause
"""isostat view: grains, force chains and the mesh of a run in a window, or as a picture.

Needs VTK's module for Python (python3-vtk9), and xvfb for a picture without a display.

tested: tests/apps/view_test.py
"""
import os
import pathlib
import shutil
import sys
import tempfile
import tomllib
from collections.abc import Callable
from time import sleep
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.ticker import MaxNLocator

from isostat import _core
from isostat.campaign import command
from isostat.figures.column_results import quantity
from isostat.figures.common import Run
from isostat.figures.files import check_results, check_target, read_parsed
from isostat.vtkhdf import Moments, draw, meshes, nothing_stored, packings

try:
    import vtkmodules.all as vtk
    from vtkmodules.util.numpy_support import vtk_to_numpy
except ImportError:
    vtk = None

Read = Callable[[pathlib.Path], Any]
GRAINS = {"pressure": ("pressure of grains (kPa)", 1e-3), "velocity": ("velocity of grains (mm/s)", 1e3)}
CHAINS = {"normal_force": ("normal force (N)", 1.0)}
MESH = {"ru": ("r_u (-)", 1.0), "mean_shear_strain": ("shear strain (%)", 1e2),
        "shear_strain": ("shear strain (%)", 1e2),
        "gamma_xz": ("shear strain xz, magnitude (%)", 1e2)}  # the first that there is and is not zero
NEAR = 1e-4  # relative: of a time as the caption has it, and as it is stored
SAMPLES = 8  # moments that the range of colours is taken from
HIGH = 95  # percentile that is its upper end: few carry much more
TUBE = 0.12  # radius of the tube of a contact with this force, against the mean radius of grains
ROWS = 3  # of packings
BOTTOM, TOP = 0.08, 0.94  # of the panels; below is the slider, above the time
OURS = b"isostat view"  # among the first bytes of its pictures
MM = 1e3  # unit of packings: VTK makes flat tubes of lengths as small as those in m


def in_ink(letters: Any, size: int) -> None:
    """Makes letters black, of a size in points."""
    letters.SetFontSize(size)
    letters.SetColor(0.1, 0.1, 0.1)
    letters.ItalicOff()
    letters.BoldOff()
    letters.ShadowOff()


def text_in(renderer: Any, y: float, text: str = "") -> Any:
    """Text at the left of a part of the window; y from its bottom, of one."""
    actor = vtk.vtkTextActor()
    actor.SetInput(text)
    actor.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    actor.SetPosition(0.02, y)
    in_ink(actor.GetTextProperty(), 17)
    renderer.AddActor2D(actor)
    return actor


def part(left: float, bottom: float, right: float, top: float) -> Any:
    """A part of the window."""
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(left, bottom, right, top)
    renderer.SetBackground(1, 1, 1)
    return renderer


def colour_bar(palette: str, high: float, label: str) -> Any:
    """Colours from 0 on."""
    table, bar = vtk.vtkLookupTable(), vtk.vtkScalarBarActor()
    table.SetVectorModeToMagnitude()
    table.SetNumberOfTableValues(256)
    for k in range(256):
        table.SetTableValue(k, *mpl.colormaps[palette](k))
    table.SetRange(0, high)
    bar.SetLookupTable(table)
    bar.SetTitle(label)
    bar.SetOrientationToHorizontal()
    bar.SetNumberOfLabels(2)
    bar.SetLabelFormat("%.4g")
    bar.UnconstrainedFontSizeOn()
    in_ink(bar.GetTitleTextProperty(), 15)
    in_ink(bar.GetLabelTextProperty(), 15)
    bar.SetPosition(0.15, 0.01)
    bar.SetWidth(0.7)
    bar.SetHeight(0.11)
    return bar


class Panel:
    """A part of the window with a shape in the colours of one field, at any of its moments."""

    def __init__(self, renderer: Any, moments: Moments, read: Read, fields: dict[str, tuple[str, float]],
                 palette: str) -> None:
        self.renderer, self.moments, self.read = renderer, moments, read
        self.times = np.array([time for time, _ in moments])
        self.shape = read(moments[0][1])
        points, taken = self.shape.GetPointData(), moments[::-(-len(moments) // SAMPLES)]
        for self.field in [name for name in fields if points.HasArray(name)] or [points.GetArrayName(0)]:
            label, self.scale = fields.get(self.field, (self.field, 1.0))
            samples = [self.values(read(path)) for _, path in taken]
            if any(values.any() for values in samples):  # r_u of dry soil is zero
                break
        self.high = max([np.percentile(values, HIGH) for values in samples if values.size], default=0) or 1.0
        self.bar = colour_bar(palette, 1.0 if self.field == "ru" else self.high, label)
        renderer.AddActor2D(self.bar)
        self.show(self.times[0])

    def values(self, shape: Any) -> np.ndarray:
        """What is coloured, from now on in the unit of the bar."""
        values = vtk_to_numpy(shape.GetPointData().GetArray(self.field))
        values[...] = np.abs(values) * self.scale
        return np.linalg.norm(values, axis=1) if values.ndim > 1 else values

    def show(self, time: float) -> None:
        """The last moment until a time."""
        shape = self.read(self.moments[max(0, np.searchsorted(self.times, time, "right") - 1)][1])
        self.values(shape)
        shape.GetPointData().SetActiveScalars(self.field)
        self.shape.ShallowCopy(shape)

    def add(self, mapper: Any) -> Any:
        """The actor that shows what a mapper draws."""
        mapper.SetLookupTable(self.bar.GetLookupTable())
        mapper.UseLookupTableScalarRangeOn()
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray(self.field)
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        self.renderer.AddActor(actor)
        return actor

    def look(self, upwards: str, turned: float, zoom: float) -> None:
        """From the side, x to the right, y or z upwards. turned: how far from there, degrees"""
        camera = self.renderer.GetActiveCamera()
        camera.ParallelProjectionOn()
        camera.SetFocalPoint(0, 0, 0)
        camera.SetPosition(*((0, 0, 1) if upwards == "y" else (0, -1, 0)))
        camera.SetViewUp(*((0, 1, 0) if upwards == "y" else (0, 0, 1)))
        camera.Azimuth(turned)
        camera.Elevation(0.6 * turned)
        self.renderer.ResetCamera()
        camera.Zoom(zoom)
        camera.SetWindowCenter(0, -0.12)  # the bar is below


def reader_of(shape: str, aside: pathlib.Path) -> Read:
    """Reads grains or force_chains of a packing with VTK, lengths in mm; without a shape a .vtu."""
    def read(path: pathlib.Path) -> Any:
        reader = vtk.vtkXMLGenericDataObjectReader()
        reader.SetFileName(str(draw(shape, path, aside / "one.vtp") if shape else path))
        reader.Update()
        found = reader.GetOutput()
        if shape and found.GetNumberOfPoints():
            points = vtk_to_numpy(found.GetPoints().GetData())
            points *= MM
        return found
    return read


def grains_panel(renderer: Any, moments: Moments, aside: pathlib.Path, colour: str) -> Panel:
    panel = Panel(renderer, moments, reader_of("grains", aside), {colour: GRAINS[colour]}, "YlGnBu")
    sphere, spheres = vtk.vtkSphereSource(), vtk.vtkGlyph3DMapper()
    sphere.SetRadius(1)
    sphere.SetThetaResolution(20)
    sphere.SetPhiResolution(14)
    spheres.SetInputData(panel.shape)
    spheres.SetSourceConnection(sphere.GetOutputPort())
    spheres.SetScaleArray("radius")
    spheres.SetScaleModeToScaleByMagnitude()
    spheres.SetScaleFactor(MM)
    panel.add(spheres)
    return panel


def chains_panel(renderer: Any, moments: Moments, aside: pathlib.Path, radius: float) -> Panel:
    """radius: mean one of the grains"""
    panel = Panel(renderer, moments, reader_of("force_chains", aside), CHAINS, "YlOrRd")
    tubes, mapper = vtk.vtkTubeFilter(), vtk.vtkPolyDataMapper()
    tubes.SetInputData(panel.shape)
    tubes.SetVaryRadiusToVaryRadiusByAbsoluteScalar()
    tubes.SetRadius(MM * TUBE * radius / panel.high)
    tubes.SetNumberOfSides(10)
    mapper.SetInputConnection(tubes.GetOutputPort())
    panel.add(mapper)
    return panel


def mesh_panel(renderer: Any, moments: Moments, depths: list[float]) -> Panel:
    """depths: of packings, which get a mark at the right; at the left is a scale of depth"""
    panel = Panel(renderer, moments, reader_of("", pathlib.Path()), MESH, "YlGnBu")
    surface, tubes, mapper = vtk.vtkDataSetSurfaceFilter(), vtk.vtkTubeFilter(), vtk.vtkPolyDataMapper()
    left, right, _, _, bottom, top = panel.shape.GetBounds()
    surface.SetInputData(panel.shape)
    tubes.SetInputConnection(surface.GetOutputPort())
    tubes.SetRadius(0.05 * (top - bottom))
    tubes.SetNumberOfSides(30)
    lines = panel.shape.GetCellType(0) == vtk.VTK_LINE
    mapper.SetInputConnection((tubes if lines else surface).GetOutputPort())
    panel.add(mapper).GetProperty().SetEdgeVisibility(not lines)
    scale = [depth for depth in MaxNLocator(5).tick_values(0, top - bottom) if depth <= top - bottom]
    aside = 0.07 * (top - bottom) if lines else 0.0  # of what is drawn around lines
    marks = [(f"– {depth:g} m", max(right, left + aside), depth) for depth in depths]
    marks += [(f"{depth:g} m –", left - aside, depth) for depth in scale]
    for k, (text, x, depth) in enumerate(marks):
        mark = vtk.vtkBillboardTextActor3D()
        mark.SetInput(text)
        mark.SetPosition(x, 0, top - depth)
        in_ink(mark.GetTextProperty(), 15)
        mark.GetTextProperty().SetVerticalJustificationToCentered()
        if k >= len(depths):
            mark.GetTextProperty().SetJustificationToRight()
        renderer.AddActor(mark)
    panel.look("z", 0 if right > left else 15, 0.84)
    return panel


class Window:
    """All panels at one time, with a line of text above them."""

    def __init__(self, folder: pathlib.Path, aside: pathlib.Path, colour: str) -> None:
        taken, drawn = packings(folder), meshes(folder)
        self.run = Run(folder) if "" in taken else None
        self.strained = any(path.name == "block.pvd" for path in drawn)  # the time of a block is its strain
        scene = read_parsed(folder / "scene.toml", tomllib.loads)
        asked = scene.get("grains", {}).get("snapshot_depths", [])
        depths = {f"d{k}": quantity(depth) for k, depth in enumerate(asked)}
        rows, self.panels = list(taken.items())[:ROWS], []
        left = 0.3 if drawn and taken else 1.0 if drawn else 0.0
        for moments in drawn.values():
            self.panels.append(mesh_panel(part(0, BOTTOM, left, TOP), moments, [depths[name] for name, _ in rows]))
        for k, (name, moments) in enumerate(rows):
            height, middle = (TOP - BOTTOM) / len(rows), (left + 1) / 2
            low, high = TOP - (k + 1) * height, TOP - k * height
            grains = grains_panel(part(left, low, middle, high), moments, aside, colour)
            radius = float(vtk_to_numpy(grains.shape.GetPointData().GetArray("radius")).mean())
            chains = chains_panel(part(middle, low, 1, high), moments, aside, radius)
            grains.look("z" if name else "y", 25, 1.2)
            chains.renderer.SetActiveCamera(grains.renderer.GetActiveCamera())  # both turn together
            text_in(grains.renderer, 0.9, f"{depths[name]:g} m" if name else "")
            self.panels += [grains, chains]
        self.times = np.unique(np.concatenate([panel.times for panel in self.panels]))
        self.window, self.whole = vtk.vtkRenderWindow(), part(0, 0, 1, 1)
        self.whole.InteractiveOff()
        self.caption = text_in(self.whole, 0.955)
        self.window.SetWindowName(f"isostat view {folder}")
        self.window.SetSize(1400, 760 if len(rows) < 2 else 1000)
        for renderer in (self.whole, *(panel.renderer for panel in self.panels)):
            self.window.AddRenderer(renderer)

    def show(self, time: float) -> None:
        for panel in self.panels:
            panel.show(time)
        text = f"axial strain {100 * time:.3g} %" if self.strained else f"t = {time:.4g} s"
        if self.run:
            row = int(np.argmin(np.abs(self.run["time"] - time)))
            text += (f"     {'shear' if self.run.shear else 'axial'} strain {100 * self.run.strain[row]:.3g} %"
                     f"     p' = {self.run['p'][row] / 1e3:.3g} kPa")
        self.caption.SetInput(text)
        self.window.Render()

    def save(self, path: pathlib.Path) -> None:
        picture, writer = vtk.vtkWindowToImageFilter(), vtk.vtkPNGWriter()
        picture.SetInput(self.window)
        picture.ReadFrontBufferOff()
        writer.SetInputConnection(picture.GetOutputPort())
        writer.WriteToMemoryOn()
        writer.AddText("Software", OURS.decode())
        writer.Write()
        path.write_bytes(vtk_to_numpy(writer.GetResult()).tobytes())

    def open(self, time: float) -> None:
        """Returns when the window is closed. The slider and the arrow keys move in time."""
        interactor, widget = vtk.vtkRenderWindowInteractor(), vtk.vtkSliderWidget()
        slider = vtk.vtkSliderRepresentation2D()
        interactor.SetRenderWindow(self.window)
        interactor.SetInteractorStyle(vtk.vtkInteractorStyleTrackballCamera())
        slider.SetMinimumValue(-0.5)  # at an end of its range the mouse would not catch it
        slider.SetMaximumValue(len(self.times) - 0.5)
        slider.SetValue(np.searchsorted(self.times, time))
        slider.ShowSliderLabelOff()
        slider.SetSliderLength(0.02)
        slider.SetTubeWidth(0.005)
        slider.SetEndCapLength(0.002)
        for lines in (slider.GetTubeProperty(), slider.GetCapProperty()):
            lines.SetColor(0.8, 0.8, 0.8)
        slider.GetSliderProperty().SetColor(0.3, 0.3, 0.3)
        for point, x in ((slider.GetPoint1Coordinate(), 0.1), (slider.GetPoint2Coordinate(), 0.9)):
            point.SetCoordinateSystemToNormalizedViewport()
            point.SetValue(x, BOTTOM / 2)
        widget.SetInteractor(interactor)
        widget.SetRepresentation(slider)
        widget.SetCurrentRenderer(self.whole)
        widget.EnabledOn()

        def move(step: int) -> None:
            k = min(max(round(slider.GetValue()) + step, 0), len(self.times) - 1)
            slider.SetValue(k)
            self.show(self.times[k])

        widget.AddObserver("InteractionEvent", lambda *_: move(0))
        steps = {"Left": -1, "Right": 1}
        interactor.AddObserver("KeyPressEvent", lambda *_: move(steps.get(interactor.GetKeySym(), 0)))
        closed: list[bool] = []
        interactor.AddObserver("ExitEvent", lambda *_: closed.append(True))  # Start() of VTK 9.1 crashes at its end
        interactor.Initialize()
        while not closed:
            interactor.ProcessEvents()
            sleep(0.01)


def check(folder: pathlib.Path, picture: pathlib.Path | None, time: float | None, colour: str | None) -> None:
    """Raises BadInput or InputError where there is nothing to show, or no place for the picture."""
    check_results(folder)
    if picture:
        check_target(picture, {".png": OURS}, "--picture")
    taken, drawn = packings(folder), meshes(folder)
    if not taken and not drawn:
        raise nothing_stored(folder)
    if colour and not taken:
        raise _core.InputError(f"{folder}: has no stored packings, so --colour {colour} has no grains to colour.")
    times = [stored for moments in [*taken.values(), *drawn.values()] for stored, _ in moments]
    if time is not None and not min(times) * (1 - NEAR) <= time <= max(times) * (1 + NEAR):
        raise _core.InputError(f"--time {time:g}: {folder} has stored moments from {min(times):.6g} to {max(times):.6g}.")


def view(folder: pathlib.Path, picture: pathlib.Path | None, time: float | None, colour: str | None) -> None:
    """Raises InputError where there is nothing to show, or nothing to show it with."""
    check(folder, picture, time, colour)
    if vtk is None:
        raise _core.InputError("isostat view: needs VTK for this Python: apt-get install python3-vtk9. isostat "
                               "animate does without it.")
    if not os.environ.get("DISPLAY"):
        if not picture:
            raise _core.InputError("isostat view: there is no display (DISPLAY is not set). Give --picture FILE.png, "
                                   "or open the files of isostat vtkhdf with ParaView elsewhere.")
        if not shutil.which("xvfb-run"):
            raise _core.InputError("isostat view: a picture without a display needs xvfb: apt-get install xvfb xauth")
        os.execvp("xvfb-run", ["xvfb-run", "-a", *sys.orig_argv])
    with tempfile.TemporaryDirectory() as aside:
        window = Window(folder, pathlib.Path(aside), colour or "pressure")
        shown = len(window.times) if time is None else np.searchsorted(window.times, time * (1 + NEAR), "right")
        time = window.times[max(shown - 1, 0)]
        window.window.SetOffScreenRendering(bool(picture))
        window.window.SetMultiSamples(8)
        window.show(time)
        if picture:
            window.save(picture)
            print(picture)
        else:
            window.open(time)


def main(words: list[str]) -> int:
    line = command.line_of("view", "Grains, force chains and mesh of a run in a window. The mouse turns them, the "
                           "slider and the keys left and right move in time, q ends. Needs VTK's module for Python: "
                           "python3-vtk9")
    line.add_argument("results", metavar="RESULTS", type=pathlib.Path,
                      help="results folder of element_test or soil_column")
    line.add_argument("--picture", metavar="FILE.png", type=pathlib.Path, help="write a picture instead of opening a "
                      "window; without a display it needs xvfb")
    line.add_argument("--time", metavar="SECONDS", type=float, help="begin at this time, of a block at this axial "
                      "strain (default: the end)")
    line.add_argument("--colour", choices=tuple(GRAINS), help="of grains (default: pressure, the "
                      "mean stress from contact forces)")
    asked = line.parse_args(words)
    return command.run(lambda: view(asked.results, asked.picture, asked.time, asked.colour))

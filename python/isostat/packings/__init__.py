# SPDX-License-Identifier: BSD-3-Clause
"""Packings in and out: HDF5 of Isostat, and files of LAMMPS, YADE, CSV and VTP.   tested: tests/python/packings_test.py"""
import dataclasses
import gzip
import math
import numbers
import os
import pathlib
import re
import warnings
import zlib

import numpy as np

from isostat import _core
from isostat.calls import depth_of_caller, path_text
from isostat.packings import lammps, sphere_text, vtp
from isostat.packings.spheres import refuse, text as number_text

FORMATS = {"specimen": (".h5",), "lammps-dump": (".dump", ".lammpstrj"), "lammps-data": (".data", ".lmp"),
           "yade": (".txt", ".xyzr"), "csv": (".csv",), "vtp": (".vtp",)}
QUARTZ = 2650.0  # kg/m3


@dataclasses.dataclass
class Reading:
    """How a file of another program is read: what it does not say itself."""
    scale: float = 1  # metres in its unit of length; also of velocities
    metres_named: bool = False  # the user has said that it is in m
    density: float = QUARTZ  # kg/m3
    density_named: bool = False
    domain: str = ""  # "periodic-cell", "rigid-box"; empty: as the file says
    law: _core.Law | None = None
    anyway: bool = False  # what the checks refuse is a note

    def __post_init__(self):
        if not (self.density > 0 and math.isfinite(self.density)):
            raise _core.InputError(f"grain density = {self.density} kg/m3; expected > 0, such as 2650 for quartz")
        if not (self.scale > 0 and math.isfinite(self.scale)):
            raise _core.InputError(f"scale = {self.scale}; expected > 0, such as 1e-3 for a file in mm")
        if self.domain not in ("", "rigid-box", "periodic-cell"):
            raise _core.InputError(f"domain: must be rigid-box or periodic-cell, but is {self.domain!r}.")


def read_text(path):
    """All of a file, unpacked if it is gzipped."""
    try:
        if not os.path.isfile(path):
            refuse(path, 0, "cannot be opened: there is no such file; check path and permissions")
        data = pathlib.Path(path).read_bytes()
    except OSError as error:
        refuse(path, 0, f"cannot be opened: {error.strerror}; check path and permissions")
    if data.startswith(b"\x1f\x8b"):
        try:
            data = gzip.decompress(data)
        except (EOFError, OSError, zlib.error):
            refuse(path, 0, "the gzip data are damaged or cut off; copy the file again")
    data = data.removeprefix(b"\xef\xbb\xbf")
    if data[:2] in (b"\xff\xfe", b"\xfe\xff") or (len(data) > 3 and (data[1] == data[3] == 0 or data[0] == data[2] == 0)):
        refuse(path, 1, "the text is UTF-16; only UTF-8 and ASCII are read. Save it as UTF-8 (in a terminal: iconv -f UTF-16 "
                        "-t UTF-8)")
    return data.decode("utf-8", "replace")


def reader_of(text):
    """By the first lines."""
    if text.startswith("ITEM:"):
        return lammps.read_dump
    if text.lstrip(" \t\r\n").startswith("<"):
        return vtp.read
    head = text[:4000]
    return lammps.read_data if "xlo xhi" in head and "atoms" in head else sphere_text.read


def read_foreign(path, how):
    """(Snapshot, notes) of a file of another program, or of a folder of tables with contact history."""
    law = {} if how.law is None else {"law": how.law}
    if os.path.isdir(path):
        if how.scale != 1:
            refuse(path, 0, "a folder of tables holds forces and is in SI; expected a scale of 1")
        return _core._import_tables(path, density=how.density, **law), []
    text = read_text(path)
    lines = [line.removesuffix("\r") for line in text.removesuffix("\n").split("\n")] if text else []
    found = reader_of(text)(path, lines, how.scale, how.domain)
    spheres, box = found.spheres, found.box
    spheres.check()
    density = spheres.density(how.density, how.scale)
    if not (density > 0 and math.isfinite(density)):
        refuse(path, 0, f"grain density = {density} kg/m3; expected > 0")
    if found.cell is None:
        box = spheres.bounding_box() if box is None else box
        spheres.check_inside(box)
    with np.errstate(all="ignore"):
        volume = (np.linalg.det(found.cell) if found.cell is not None else np.prod(box[1] - box[0])) * how.scale**3
    if not (volume > 0 and math.isfinite(volume)):
        refuse(path, 0, f"the {'box' if found.cell is None else 'periodic cell'} has a volume of {volume} m3; expected a "
                        "finite one above 0")

    def scaled(lengths):
        return None if lengths is None else how.scale * lengths
    ids = None if spheres.ids is None else spheres.ids.astype(np.uint32)
    return _core._spheres(scaled(spheres.centres), scaled(spheres.radii), density=density, box=scaled(box),
                          cell=scaled(found.cell), ids=ids, velocities=scaled(spheres.velocities), spins=spheres.spins,
                          **law), found.notes


def read_any(file, how):
    """(Specimen, notes) of any file that Isostat can read, as `specimen.file` of a scene or `isostat convert` names it."""
    if re.search(r"\.h5(#[^/]*)?$", file):
        if how.scale != 1:
            refuse(file, 0, "a file of Isostat is in SI and holds forces; expected a scale of 1")
        specimen, notes = _core._with_domain(_core._read_stored(file), file, how.domain), []
    else:
        packing, notes = read_foreign(file, how)
        specimen = _core._with_domain(_core._converted(packing, file), file, how.domain)
        try:
            notes = notes + _core._check_packing(specimen.snapshot, file, lambda unit: f"give --length-unit {unit}",
                                                 how.metres_named)
        except _core.InputError as error:
            if not how.anyway:
                raise
            notes = [*notes, str(error)]
    density = specimen.snapshot.density
    if how.density_named and abs(density - how.density) > 1e-3 * how.density:
        notes.append(f"The file says a grain density of {density:g} kg/m3, which is taken: {how.density:g} kg/m3 has no "
                     "effect.")
    return specimen, notes


def format_of(path, name=""):
    """A name of FORMATS: this one, or that of the ending."""
    if name in FORMATS:
        return name
    ending = os.path.splitext(path)[1]
    found = next((known for known, endings in FORMATS.items() if ending in endings and not name), None)
    if found is None:
        problem = f"format {name}" if name else f"{path}: its ending does not say what to write"
        every = ", ".join(f"{known} ({', '.join(endings)})" for known, endings in FORMATS.items())
        raise _core.InputError(f"{problem}; expected one of: {every}." + ("" if name else " Or name the format."))
    return found


def check_target(path, overwrite):
    if not overwrite and os.path.lexists(path):
        refuse(path, 0, _core._in_python("the file exists; give --overwrite to replace it, or another name"))
    folder = os.path.dirname(os.path.abspath(path))
    if not os.path.isdir(folder):
        refuse(path, 0, f"there is no folder {folder}. Make it, or give another name.")


def write_any(path, specimen, kind):
    """Writes aside and renames.   Returns notes: what the format cannot hold or had to change"""
    if kind == "specimen":
        _core.write_specimen(path, specimen, overwrite=True)
        return []
    packing, notes = specimen.snapshot, []
    if len(packing.contact_pairs) or packing.wall_contacts:
        notes.append("Contacts with their forces are not kept by this format: a packing that comes back starts without shear "
                     "forces, so let a stage `rebalance` come first.")
    if packing.density != QUARTZ and kind != "lammps-data":
        notes.append(_core._in_python(
            f"The grain density, {number_text(packing.density)} kg/m3, is not kept by this format: name it where the file is "
            f"read, --density \"{number_text(packing.density)} kg/m3\"."))
    if kind.startswith("lammps") and not lammps.fits(packing):
        notes.append("LAMMPS wants the first edge of a cell along x and the second in the plane xy: the packing is turned into "
                     "this position, which costs the last digits.")
    if kind == "yade" and packing.cell is not None:
        notes.append("YADE's text has no place for a periodic cell: it is in the comment `# cell`, which Isostat reads and "
                     "YADE does not; give O.cell.hSize there.")
    if kind == "vtp":
        _core.write_vtp(path, packing, overwrite=True)
    else:
        text = {"lammps-dump": lammps.dump_text, "lammps-data": lammps.data_text, "yade": sphere_text.yade,
                "csv": sphere_text.table}[kind](packing)
        _core._write_replacing(path, text)
    return notes


def convert_any(source, target, how, kind, overwrite):
    """(Specimen, notes); grains of another program are stored along a curve through space, on which runs are fast."""
    kind = format_of(target, kind)
    check_target(target, overwrite)
    specimen, notes = read_any(source, how)
    if kind == "specimen" and not re.search(r"\.h5(#[^/]*)?$", source):
        specimen = _core._along_curve(specimen)
    return specimen, notes + write_any(target, specimen, kind)


def warn(notes):
    for note in notes:
        warnings.warn(note, _core.IsostatWarning, stacklevel=depth_of_caller())


def given(name, value, kind, words):
    if not isinstance(value, kind):
        raise _core.InputError(f"{name}: must be {words}, but is {value!r}.")
    return value


def quantity(name, text, dimension):
    """Of a quantity as text, in SI.   Raises InputError with the name"""
    try:
        return _core._quantity(text, dimension)
    except _core.InputError as error:
        raise _core.InputError(f"{name}: {error}") from None


def reading(length_unit, density, domain, law, anyway):
    unit = given("length_unit", length_unit, str, "text")
    return Reading(quantity("length_unit", f"1 {unit}", "length"), False, given("density", density, numbers.Real, "a number"),
                   density != QUARTZ, given("domain", domain, str, "text"), law, given("anyway", anyway, bool, "True or False"))


def read_packing(path: str | os.PathLike[str], *, length_unit: str = "m", density: float = QUARTZ, domain: str = "",
                 law: _core.Law | None = None, anyway: bool = False) -> _core.Specimen:
    """A packing as a Specimen, whatever wrote it: HDF5 of Isostat, LAMMPS dump or data file (units si, atom_style sphere), text
    of YADE, CSV, VTP, or a folder of tables with contact history.

    Refuses what cannot be meant (spheres in mm read as metres, deep overlaps, spheres outside the box) unless `anyway`; what
    had to be assumed is a warning.

    length_unit: of the file, "mm" ... density: kg/m3, where the file does not say it. domain: "periodic-cell" where the file
    has a box that repeats itself. law: of the contacts; None: the default law.
    """
    path = path_text("path", path)
    specimen, notes = read_any(path, reading(length_unit, density, domain, law, anyway))
    warn(notes)
    return specimen


def write_packing(path: str | os.PathLike[str], specimen: _core.Specimen, *, format: str = "", overwrite: bool = False) -> None:
    """Writes a packing by the ending of the file: .h5 .dump .data .txt .csv .vtp.

    format: "specimen", "lammps-dump", "lammps-data", "yade", "csv" or "vtp", where the ending is another. What the format
    cannot hold is a warning. An existing file is replaced only with `overwrite`.
    """
    path = path_text("path", path)
    given("specimen", specimen, _core.Specimen, "an isostat.Specimen")
    kind = format_of(path, given("format", format, str, "text"))
    check_target(path, given("overwrite", overwrite, bool, "True or False"))
    warn(write_any(path, specimen, kind))


def convert(source: str | os.PathLike[str], target: str | os.PathLike[str], *, length_unit: str = "m", density: float = QUARTZ,
            domain: str = "", format: str = "", anyway: bool = False, overwrite: bool = False) -> None:
    """What `isostat convert` does: read_packing, then write_packing. Grains of another program that become a specimen (.h5) are
    stored along a curve through space, on which runs are fast; their ids say where they were.
    """
    source, target = path_text("source", source), path_text("target", target)
    how = reading(length_unit, density, domain, None, anyway)
    given("format", format, str, "text")
    warn(convert_any(source, target, how, format, given("overwrite", overwrite, bool, "True or False"))[1])


def import_tables(path: str | os.PathLike[str], law: _core.Law | None = None, density: float = QUARTZ) -> _core.Snapshot:
    """A packing as a Snapshot, from a file of another program in m, or a folder with contact history
    (docs/guide/packings.md). Refuses what no packing of soil is, as read_packing() does.
    """
    path = path_text("path", path)
    packing, _ = read_foreign(path, Reading(density=given("density", density, numbers.Real, "a number"), law=law))

    def remedy(unit):
        return f"give {'anyway=True' if unit == 'm' else f'length_unit={chr(34)}{unit}{chr(34)}'} to isostat.read_packing()"
    warn(_core._check_packing(packing, path, remedy, False))
    return packing

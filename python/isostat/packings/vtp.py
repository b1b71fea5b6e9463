# SPDX-License-Identifier: BSD-3-Clause
"""Grains as points of a VTK PolyData file.   tested: tests/python/packings_test.py

Of Isostat (write_vtp), or of another program with point data `radius` (m) and, if they are there, id, velocity, spin, density,
mass and the field data `box` or `cell`; ascii, or base64 without compression, in one piece.
"""
import base64
import re
import xml.etree.ElementTree as ET
import zlib

import numpy as np

from isostat.packings.spheres import Found, Spheres, number, refuse

TYPES = {"Float64": "<f8", "Float32": "<f4", "Int64": "<i8", "UInt64": "<u8", "Int32": "<i4", "UInt32": "<u4",
         "UInt8": "u1"}
WIDTHS = {"radius": 1, "id": 1, "velocity": 3, "spin": 3, "density": 1, "mass": 1}


class Arrays:
    """The DataArrays of a file."""

    def __init__(self, path, file):
        self.path, self.header_bytes = path, 8 if file.get("header_type") == "UInt64" else 4
        self.compressed = bool(file.get("compressor"))

    def refuse(self, what):
        refuse(self.path, 0, what)

    def content(self, text):
        """The bytes of an array and, in front of them, a header."""
        if not self.compressed:
            return base64.b64decode(text, validate=True)
        n_blocks = int.from_bytes(base64.b64decode(text[:12])[:self.header_bytes], "little")
        end = -(-(3 + n_blocks) * self.header_bytes // 3) * 4  # blocks, their size, that of the last, each compressed
        header, packed = base64.b64decode(text[:end]), base64.b64decode(text[end:])
        ends = np.cumsum(np.frombuffer(header, f"<u{self.header_bytes}")[3:]).tolist()
        return bytes(self.header_bytes) + b"".join(zlib.decompress(packed[begin:end])
                                                   for begin, end in zip([0, *ends], ends))

    def numbers(self, array):
        return self.stored(array).astype(float)

    def stored(self, array):
        """The numbers in the type of the file."""
        kind, form, name, words = array.get("type"), array.get("format"), array.get("Name"), (array.text or "").split()
        if form == "ascii":
            values = [number(word) for word in words]
            if None in values:
                self.refuse(f'"{words[values.index(None)]}" in the array {name}; expected numbers')
            return np.array(values, float)
        if form != "binary":
            self.refuse(f"the array {name} is stored as {form}; expected ascii, or binary without compression. Save it from "
                        "ParaView with data mode ASCII")
        if kind not in TYPES:
            self.refuse(f"the array {name} is of type {kind}; expected Float64, Float32 or whole numbers")
        try:
            data = self.content("".join(words))
        except (ValueError, zlib.error):
            self.refuse(f"the array {name} is not base64; is the file damaged?")
        if len(data) < self.header_bytes:
            self.refuse(f"the array {name} has no content; is the file cut off?")
        kind = np.dtype(TYPES[kind])
        return np.frombuffer(data, kind, (len(data) - self.header_bytes) // kind.itemsize, self.header_bytes)

    def named(self, parent, name):
        """The numbers of the array of this name; empty without one."""
        arrays = [] if parent is None else parent.findall("DataArray")
        return next((self.numbers(array) for array in arrays if array.get("Name") == name), np.array([]))


def parsed(path, text):
    """The elements VTKFile and PolyData."""
    if re.search(r"<!(DOCTYPE|ENTITY)", text, re.I):
        refuse(path, 0, "has a document type; expected a plain file <VTKFile type=\"PolyData\">, without <!DOCTYPE>")
    data, problem = None, "another type"
    try:
        file = ET.fromstring(text)
        data = file.find("PolyData") if file.tag == "VTKFile" else None
    except (ET.ParseError, ValueError) as error:
        problem = error
    if data is None:
        refuse(path, 0, f"no VTK PolyData ({problem}); expected an XML file <VTKFile type=\"PolyData\"> of grains as points")
    return file, data


def read(path, lines, _scale, _domain):
    file, data = parsed(path, "\n".join(lines))
    arrays = Arrays(path, file)
    if file.get("compressor"):
        arrays.refuse("compressed; expected ascii, or binary without compression. Save it from ParaView with data mode ASCII")
    if file.get("byte_order") == "BigEndian":
        arrays.refuse("its bytes are in the order of another processor (BigEndian); expected LittleEndian, or ascii")
    if len(data.findall("Piece")) > 1:
        arrays.refuse("several pieces; expected one with all grains. Save it from ParaView after the filter Merge Blocks")
    points = data.find("Piece/Points/DataArray")
    if points is None:
        arrays.refuse("no points; expected a DataArray in Points")
    centres, promised = arrays.numbers(points), data.find("Piece").get("NumberOfPoints", "")
    n = len(centres) // 3
    if number(promised) != n:
        arrays.refuse(f"{n} points, but {promised} are promised; is the file cut off?")
    of_points = {name: arrays.named(data.find("Piece/PointData"), name) for name in WIDTHS}
    if n != len(of_points["radius"]) or any(len(values) not in (0, n * WIDTHS[name]) for name, values in of_points.items()):
        arrays.refuse(f"{n} points with {len(of_points['radius'])} radii; expected point data `radius` (m), one for each "
                      "point, and as many of id, velocity, spin, density and mass if there are any")
    radii, ids, *motion, densities, masses = (
        (values.reshape(n, 3) if WIDTHS[name] == 3 else values) if len(values) else None for name, values in of_points.items())
    spheres = Spheres(path, centres[:3 * n].reshape(n, 3), np.array([]) if radii is None else radii, ids, *motion, densities,
                      masses)
    spheres.check_ids(0)
    box, cell = (arrays.named(data.find("FieldData"), name) for name in ("box", "cell"))
    if len(cell) not in (0, 9) or len(box) not in (0, 6):
        arrays.refuse(f"field data `box` of {len(box)} or `cell` of {len(cell)} numbers; expected 6 (lower and upper corner, "
                      "m) or 9 (three edges, m)")
    if len(cell):
        with np.errstate(all="ignore"):
            if not 0 < np.linalg.det(cell.reshape(3, 3)) < np.inf:
                arrays.refuse("the field data `cell` span no volume; expected nine numbers, three right-handed edges (m)")
        return Found(spheres, cell=cell.reshape(3, 3).T)
    if len(box):
        return Found(spheres, box=box.reshape(2, 3))
    return Found(spheres, notes=["The file has no field data `box` or `cell`: the bounding box of the spheres is taken."])

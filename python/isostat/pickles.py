# SPDX-License-Identifier: BSD-3-Clause
"""Packings as bytes, for pickle and copy: those of their HDF5 files.   tested: tests/python/threads_test.py"""
import copyreg
import pathlib
import tempfile

from isostat import _core


def specimen_from(data: bytes) -> _core.Specimen:
    """The way back from bytes_of()."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "packing.h5"
        path.write_bytes(data)
        return _core.read_specimen(path)


def snapshot_from(data: bytes) -> _core.Snapshot:
    """The same, of its packing."""
    return specimen_from(data).snapshot


def bytes_of(specimen: _core.Specimen) -> bytes:
    """The bytes of its file."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "packing.h5"
        _core.write_specimen(path, specimen)
        return path.read_bytes()


copyreg.pickle(_core.Specimen, lambda specimen: (specimen_from, (bytes_of(specimen),)))
copyreg.pickle(_core.Snapshot, lambda packing: (snapshot_from, (bytes_of(_core.Specimen(packing)),)))

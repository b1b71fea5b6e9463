# SPDX-License-Identifier: BSD-3-Clause
"""Undrained tests and representative volume elements of spheres: scenes, runs, packings as arrays.

    import isostat

    scene = isostat.Scene("quick_cyclic_liquefies.toml")
    result = isostat.run(scene, "results/first")
    result.history["p"], result.history.units["p"]

SI units. Stress and strain tensors are tension positive; p', q and the strains of a history compression positive.
Your own contact law is written in C++ (CONTRIBUTING.md): Python would be called for every contact.
"""
import pathlib
import sys

try:
    import numpy  # noqa: F401  that it is missing is reported here, not somewhere inside
    from isostat._core import (__version__, InputError, IsostatWarning, Law, Moment, RunFailure, Rve, RveResponse, RveState,
                               Snapshot, Specimen, default_scene, list_library, measure_units, read_snapshot,
                               read_specimen, scene_manual, write_force_chains_vtp, write_library, write_specimen,
                               write_vtp)
except ModuleNotFoundError as error:
    built = sorted(file.name.split(".")[1] for file in pathlib.Path(__file__).parent.glob("_core.*.so"))
    raise ImportError(
        f"{error}. This isostat was built for {' and '.join(built) or 'no Python: its compiled part is missing'}; this "
        f"is {sys.implementation.cache_tag}, {sys.executable}. Run the Python that it was built for, on Debian "
        "/usr/bin/python3 with python3-numpy, or build it for this one (-DPython_EXECUTABLE=...)") from error
from isostat import pickles  # noqa: F401  it teaches pickle what packings are
from isostat.packings import convert, import_tables, read_packing, write_packing
from isostat.results import History, Results, draw, read
from isostat.running import Run, prepare, run
from isostat.scene import Scene

__all__ = ["History", "InputError", "IsostatWarning", "Law", "Moment", "Results", "Run", "RunFailure", "Rve", "RveResponse",
           "RveState", "Scene", "Snapshot", "Specimen", "convert", "default_scene", "draw", "import_tables", "list_library",
           "measure_units", "prepare", "read", "read_packing", "read_snapshot", "read_specimen", "run", "scene_manual",
           "write_force_chains_vtp", "write_library", "write_packing", "write_specimen", "write_vtp"]

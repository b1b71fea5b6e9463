# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the Python package share: the package from the build tree whose programs are given."""
import pathlib
import shutil
import tempfile

import isostat
from support import BIN as BINARIES, ROOT, TIME_LIMIT, ToleranceTest

__all__ = ["BINARIES", "TIME_LIMIT", "ROOT", "FolderTest", "ToleranceTest", "isostat", "packing_in_cell"]

CONTACT = {"friction": "18 deg", "rolling": {"stiffness": 0.3, "limit": 0.5}, "twisting": {"stiffness": 0.3}}
SMALL_SCENE = """title = "small"
[grading]
grains = 200
cloud_edge = "2.7 mm"
[contact]
friction = "18 deg"
rolling = {}
[specimen]
domain = "periodic-cell"
preparation_friction = "12 deg"
[[stage]]
kind = "undrained-monotonic"
strain = 1e-3
"""


def packing_in_cell(grains=250, edge="2.9 mm", contact=None):
    scene = isostat.Scene(grading={"grains": grains, "cloud_edge": edge}, contact=contact or CONTACT,
                          specimen={"domain": "periodic-cell", "preparation_friction": "10 deg"})
    with tempfile.TemporaryDirectory() as cache:
        return isostat.prepare(scene, cache=cache).snapshot


class FolderTest(ToleranceTest):
    """All tests of a class share a folder, and in it a cache of specimens."""
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.cache = cls.folder / "specimens"

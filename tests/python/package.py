# SPDX-License-Identifier: BSD-3-Clause
"""What the tests of the Python package share: the package from the build tree whose programs are given."""
import pathlib
import sys

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1] / "apps")]
from support import BIN as BINARIES, TIME_LIMIT, ToleranceTest  # noqa: E402  (the path comes first)

sys.path[:0] = [str(BINARIES.parent / "python")]
import isostat  # noqa: E402

__all__ = ["BINARIES", "TIME_LIMIT", "ToleranceTest", "isostat"]

CONTACT = {"friction": "18 deg", "rolling": {"stiffness": 0.3, "limit": 0.5}, "twisting": {"stiffness": 0.3}}

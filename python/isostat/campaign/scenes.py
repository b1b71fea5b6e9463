# SPDX-License-Identifier: BSD-3-Clause
"""What campaigns do to scenes.   tested: tests/apps/resistance_test.py, tests/apps/library_test.py"""
import math
import pathlib
from typing import Any

POWERS = {"kPa": 3, "MPa": 6, "GPa": 9, "mm": -3, "ns": -9}  # of ten, that units of keys are
OF_A_RUN = {"folder": "runs", "snapshots": "none", "paraview": False}  # [output]


def in_si(text: str) -> float:
    """Of a quantity or number as scenes write it: "10 mm", "0.3"; degrees of an angle."""
    number, _, unit = text.partition(" ")
    digits, _, exponent = number.partition("e")
    if unit == "tan":  # of an angle that no number of degrees gives bit for bit
        return math.degrees(math.atan(float(number)))
    return float(f"{digits}e{int(exponent or 0) + POWERS.get(unit, 0)}")


def below_campaign(sections: dict[str, Any]) -> None:
    """Makes a scene one of a run in FOLDER/runs/NAME: without files that are not read, with a relative cache next to
    FOLDER, where that of any run is."""
    sections["output"] |= OF_A_RUN
    cache = pathlib.Path(sections["specimen"]["cache"])
    if not cache.is_absolute():
        sections["specimen"]["cache"] = str("../.." / cache)

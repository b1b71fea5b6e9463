# SPDX-License-Identifier: BSD-3-Clause
"""What a calibration consists of: laboratory curves, parameters of a scene with their bounds, specimens, budget.

tested: tests/python/calibration_test.py
"""
import gzip
import math
import os
import pathlib
import re
import tomllib
from types import SimpleNamespace
from typing import Any

from isostat import _core
from isostat.campaign import command
from isostat.campaign.calibrate.keys import (ARRAYS, DENSITIES, KEYS, SECTIONS, Key, heading, keys_of, unknown_text,
                                             value_text)
from isostat.scene import Scene

EXAMPLES = {"parameter": '[[parameter]] key = "contact.friction", bounds = ["10 deg", "35 deg"]',
            "curve": '[[curve]] file = "TMD3.csv", test = "drained"'}
FORMS = {int: "a whole number, written without point or exponent", float: "a plain number without unit or quotes",
         str: "text in quotes", bool: "true or false, without quotes"}
PLAIN = "a finite number, or a quantity with its unit in quotes"
ANY_SCENE = {"specimen": {"preparation_friction": "10 deg"}}


class Document:
    """The text of a plan, to say where what is in it."""

    def __init__(self, text: str, name: str):
        self.name = name
        try:
            self.root = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            what, _, place = str(error).partition(" (at ")
            line = place.partition(",")[0].removeprefix("line ")
            if not line.isdigit():  # "end of document)"
                line = text.count("\n") + 1
            raise _core.InputError(f"{name}:{line}: is not valid TOML: {what}.") from error
        self.lines: dict[str, int] = {}  # of keys and sections
        section, counts = "", dict.fromkeys(ARRAYS, 0)
        for number, line in enumerate(text.splitlines(), 1):
            if head := re.match(r"\s*\[+\s*([\w.-]+)\s*\]", line):
                section = head[1]
                if section in ARRAYS:
                    counts[section] += 1
                    section = f"{section}.{counts[section] - 1}"
                self.lines.setdefault(section, number)
            elif key := re.match(r"\s*([\w.-]+)\s*=", line):
                self.lines.setdefault(f"{section}.{key[1]}".lstrip("."), number)

    def where(self, path: str) -> str:
        while path and path not in self.lines:
            path = path.rpartition(".")[0]
        return f"{self.name}:{self.lines[path]}" if path else self.name

    def refuse(self, path: str, problem: str, value: Any = None) -> _core.InputError:
        """To be raised."""
        shown = "" if value is None else f" = {value if isinstance(value, str) else value_text(value)}"
        return _core.InputError(f"{self.where(path)}: {path}{shown}; {problem}")


def in_range(number: float, allowed: str) -> bool:
    """Of "in [0, 1)" or "> 0"."""
    if not allowed.startswith("in "):
        return number > 0 if allowed == "> 0" else number >= 0
    low, high = map(float, allowed[4:-1].split(", "))
    return low <= number <= high and (number > low or allowed[3] == "[") and (number < high or allowed[-1] == "]")


def plain(value: Any) -> float | str:
    """A number, or a quantity of a key of the scene, which says whether it takes it.   Raises ValueError"""
    try:
        number = float(value) if isinstance(value, int | float | str) and not isinstance(value, bool) else math.nan
    except (ValueError, OverflowError):
        number = math.nan
        if isinstance(value, str) and value:
            return value
    if not math.isfinite(number):
        raise ValueError(f"must be {PLAIN}")
    return number + 0.0  # -0 is 0


def quantity(key: str, value: Any) -> str:
    """A quantity as scenes write that of one of their keys.   Raises ValueError"""
    try:
        scene = Scene(ANY_SCENE, set={key: value}).to_dict()
    except _core.InputError as error:
        found = re.search(r"; (must be .*?)\.( Give for .*)?$", str(error))
        raise ValueError(found[1] if found else str(error)) from error
    section, _, name = key.partition(".")
    return scene[section][name]


def read_value(key: Key, value: Any) -> Any:
    """A value in the form of its key.   Raises ValueError: what it must be"""
    if key.path == "parameter.bounds":
        if not isinstance(value, list) or len(value) != 2:
            raise ValueError(f"must be two values, [low, high], each {PLAIN}")
        return [plain(each) for each in value]
    if key.path == "parameter.start":
        return plain(value)
    if key.reads_as:
        return quantity(key.reads_as, value)
    form = type(key.value)
    if key.choices and value not in key.choices:
        raise ValueError(f"must be {key.range}")
    if not isinstance(value, int | float if form is float else form) or (isinstance(value, bool) and form is not bool):
        raise ValueError(f"must be {FORMS[form]}")
    if form in (str, bool):
        return value
    if key.allowed and not in_range(value, key.allowed):
        raise ValueError(f"must be {key.allowed} {key.reason}".rstrip())
    if value and not 1e-30 <= abs(value) <= 1e30:
        raise ValueError("must be between 1e-30 and 1e30 in size, because products of other numbers overflow or vanish")
    return form(value)


def read_table(document: Document, section: str, path: str, table: Any) -> SimpleNamespace:
    """One table of a plan, with its defaults; that of columns as keys "columns.p"."""
    if not isinstance(table, dict):
        raise document.refuse(path, f"must be a table. Write {heading(section)} on its own line.", table)
    prefix = f"{path}." if path else ""
    if section == "curve" and not isinstance(columns := table.pop("columns", {}), dict):
        raise document.refuse(f"{path}.columns", 'must be a table, e.g. columns = { p = "p[kPa]" }.', columns)
    if section == "curve":
        table |= {f"columns.{name}": value for name, value in columns.items()}
    keys, values = {key.name: key for key in keys_of(section)}, {}
    for name in table:
        if name not in keys and (section or name not in SECTIONS):
            raise document.refuse(prefix + name, unknown_text(f"{section}.{name}".lstrip("."), [
                *(key.path for key in KEYS), *SECTIONS], "--print-defaults lists all keys."))
    for name, key in keys.items():
        value, place = table.get(name), prefix + name
        if value is not None and key.test and values["test"] != key.test:
            raise document.refuse(place, f"does not belong to a curve of test \"{values['test']}\", only to "
                                  f"{key.test}. Remove it or change the test.", value)
        if value is None:
            if key.need == "required":
                raise document.refuse(place, f"is missing. Give for example {name} = {value_text(key.value)}.")
            if not key.test or values["test"] == key.test:
                values[name] = None if key.need else key.value
            continue
        try:
            values[name] = read_value(key, value)
        except ValueError as error:
            raise document.refuse(place, f"{error}. Give for example {value_text(key.value)}.", value) from error
    return SimpleNamespace(**values)


def concerns(parameter: Any, curve: Any) -> bool:
    """Whether the tests of a curve have this parameter."""
    return parameter.curve in (None, curve.name, curve.group)


def check_curves(document: Document, plan: Any) -> None:
    """Their names are folders, and differ."""
    for i, curve in enumerate(plan.curve):
        curve.where = document.where(f"curve.{i}.file")
        place, given = (f"curve.{i}.name", curve.name) if curve.name else (f"curve.{i}.file", curve.file)
        curve.name = curve.name or pathlib.PurePath(curve.file).stem
        curve.group = curve.group or curve.name
        if not curve.name or curve.name[0] == "." or set(curve.name) & set('/,"\n\r\0'):
            raise document.refuse(place, 'must give a name that can name a folder. Give name = "loose", for example.',
                                  given)
        for other in plan.curve[:i]:
            if other.name == curve.name:
                raise document.refuse(place, f"names two curves \"{curve.name}\" (the other: {other.where}). Give one "
                                      "of them another name.", given)
        first, *more = [name for name in DENSITIES if vars(curve)[name] is not None] or [""]
        if more:
            there = document.where(f"curve.{i}.{first}")
            raise document.refuse(f"curve.{i}.{more[0]}", f"excludes curve.{i}.{first} ({there}). Keep one of them.",
                                  vars(curve)[more[0]])
    if all(curve.blind for curve in plan.curve):
        raise document.refuse("curve.0.blind", "leaves no curve to fit: all are blind. Set blind = false for one of "
                              "them.", True)


def check_parameters(document: Document, plan: Any) -> None:
    """Each belongs to a curve that is fitted, and none is there twice."""
    for i, parameter in enumerate(plan.parameter):
        parameter.where = document.where(f"parameter.{i}.key")
        if not any(concerns(parameter, curve) and not curve.blind for curve in plan.curve):
            raise document.refuse(f"parameter.{i}.curve", "is the name or group of no curve that is fitted. Give that "
                                  "of a [[curve]] without blind.", parameter.curve)
        for other in plan.parameter[:i]:
            if other.key == parameter.key and any(concerns(other, c) and concerns(parameter, c) for c in plan.curve):
                raise document.refuse(f"parameter.{i}.key", f"is a parameter twice (the other: {other.where}). Remove "
                                      "one, or give each its own curve.", parameter.key)
    if plan.optimiser.method == "bobyqa" and len(plan.parameter) < 2:
        if "method" in document.root.get("optimiser", {}):
            raise document.refuse("optimiser.method", "needs two parameters or more. Take \"sbplx\" for one.", "bobyqa")
        plan.optimiser.method = "sbplx"


def checked_plan(document: Document) -> SimpleNamespace:
    """A plan with all its keys: plan.budget.trials, plan.curve[0].test.

    Raises InputError with line, value, allowed range and remedy
    """
    plan = read_table(document, "", "", document.root)
    for section in SECTIONS:
        table = document.root.get(section, [] if section in ARRAYS else {})
        if section in ARRAYS and not (isinstance(table, list) and table):
            raise document.refuse(section, f"must have at least one {section}. Give for example {EXAMPLES[section]}.")
        setattr(plan, section, [read_table(document, section, f"{section}.{i}", each) for i, each in enumerate(table)]
                if section in ARRAYS else read_table(document, section, section, table))
    check_curves(document, plan)
    check_parameters(document, plan)
    return plan


def read_text(path: str, what: str) -> str:
    """Of a file in UTF-8, which may be packed by gzip.   Raises InputError"""
    if not os.path.isfile(path):  # a pipe or a device may have no end
        raise _core.InputError(f"{path}: does not exist, or is no file. Give {what}.")
    try:
        data = pathlib.Path(path).read_bytes()
        return (gzip.decompress(data) if data.startswith(b"\x1f\x8b") else data).decode("utf-8-sig")
    except (OSError, EOFError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise _core.InputError(f"{path}: cannot be read: {reason}. Give {what}, in UTF-8.") from error


def read_plan(path: str) -> SimpleNamespace:
    """A plan from a file, and where the files are that it names.   Raises InputError"""
    document = Document(read_text(path, "a plan (TOML)"), path)
    plan = checked_plan(document)

    def found(key, name, *more):
        places = [os.path.join(os.path.dirname(path), name), name, *more]
        for place in filter(os.path.isfile, places):
            return os.path.normpath(place)
        tried = list(dict.fromkeys(map(os.path.abspath, places)))  # the folder of the plan may be the working one
        missing = f"neither {' nor '.join(tried)}" if len(tried) > 1 else f"no {tried[0]}"
        raise document.refuse(key, f"does not exist: {missing}. A relative path counts from the folder of the plan "
                              "or else from the working directory; correct it.", name)

    plan.scene_path = found("scene", plan.scene, str(command.SCENES / "scenes" / plan.scene))
    for i, curve in enumerate(plan.curve):
        curve.path = found(f"curve.{i}.file", curve.file)
    return plan

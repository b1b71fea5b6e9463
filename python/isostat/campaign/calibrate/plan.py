# SPDX-License-Identifier: BSD-3-Clause
"""What a calibration consists of: laboratory curves, parameters of a scene with their bounds, specimens, budget.

tested: tests/apps/calibrate_units_test.py
"""
import difflib
import math
import os
import pathlib
import re
import tomllib
from types import SimpleNamespace
from typing import Any

from isostat import _core
from isostat.campaign import command
from isostat.campaign.calibrate.keys import ARRAYS, DENSITIES, KEYS, SECTIONS, Key, keys_of, number_text, value_text
from isostat.scene import Scene

EXAMPLES = {"parameter": '[[parameter]] key = "contact.friction", bounds = ["10 deg", "35 deg"]',
            "curve": '[[curve]] file = "TMD3.csv", test = "drained"'}
ANY_SCENE = {"specimen": {"preparation_friction": "10 deg"}}


class Document:
    """The text of a plan, to say where what is in it."""

    def __init__(self, text: str, name: str):
        self.name = name
        try:
            self.root = tomllib.loads(text.removeprefix("\ufeff"))
        except tomllib.TOMLDecodeError as error:
            what, _, place = str(error).partition(" (at ")
            line = re.match(r"line (\d+)", place)
            raise _core.InputError(f"{name}:{line[1] if line else text.count(chr(10)) + 1}: is not valid TOML: {what}.") \
                from error
        self.lines: dict[str, int] = {}  # of keys and sections
        section, numbers = "", dict.fromkeys(ARRAYS, -1)
        for number, line in enumerate(text.splitlines(), 1):
            if head := re.match(r"\s*\[+\s*([\w.-]+)\s*\]", line):
                section = head[1]
                if section in ARRAYS:
                    numbers[section] += 1
                    section = f"{section}.{numbers[section]}"
                self.lines.setdefault(section, number)
            elif key := re.match(r"\s*([\w.-]+)\s*=", line):
                self.lines.setdefault(f"{section}.{key[1]}".lstrip("."), number)

    def where(self, path: str) -> str:
        while path and path not in self.lines:
            path = path.rpartition(".")[0]
        return f"{self.name}:{self.lines[path]}" if path else self.name

    def refuse(self, path: str, problem: str, value: Any = None) -> _core.InputError:
        """To be raised."""
        shown = "" if value is None else f" = {value if isinstance(value, str) else json_like(value)}"
        return _core.InputError(f"{self.where(path)}: {path}{shown}; {problem}")


def json_like(value):
    try:
        return value_text(value)
    except (TypeError, ArithmeticError):
        return str(value)  # a date, infinity


def flat(table: dict[str, Any]) -> dict[str, Any]:
    """{"columns": {"p": ...}} as {"columns.p": ...}."""
    found = {}
    for name, value in table.items():
        found |= {f"{name}.{word}": inner for word, inner in value.items()} if isinstance(value, dict) else {name: value}
    return found


def in_range(number: float, allowed: str) -> bool:
    """Of "in [0, 1)" or "> 0"."""
    if not allowed.startswith("in "):
        return number > 0 if allowed == "> 0" else not allowed or number >= 0
    low, high = map(float, allowed[4:-1].split(", "))
    return (low < number if allowed[3] == "(" else low <= number) and (number < high if allowed[-1] == ")" else number <= high)


def plain(value: Any) -> float | str | None:
    """A number or a quantity of a key of the scene, which says whether it takes it; None: neither."""
    try:
        number = float(value) if isinstance(value, int | float | str) and not isinstance(value, bool) else math.nan
    except ValueError:
        return value  # text with a unit
    return number + 0.0 if math.isfinite(number) and "_" not in str(value) else None


def read_value(key: Key, value: Any) -> Any:
    """A value in the form of its key.   Raises ValueError: what it must be"""
    if key.path == "parameter.bounds":
        values = [plain(each) for each in value] if isinstance(value, list) and len(value) == 2 else [None]
        if None in values or "" in values:
            raise ValueError("must be two values, [low, high], each a finite number, or a quantity with its unit in quotes")
        return values
    if key.path == "parameter.start":
        if (found := plain(value)) in (None, ""):
            raise ValueError("must be a finite number, or a quantity with its unit in quotes")
        return found
    if key.reads_as:
        return quantity(key.reads_as, value)
    if key.choices and value not in key.choices:
        raise ValueError(f"must be {key.range}")
    if isinstance(key.value, str) and not isinstance(value, str):
        raise ValueError("must be text in quotes")
    if isinstance(key.value, bool) and not isinstance(value, bool):
        raise ValueError("must be true or false, without quotes")
    if isinstance(key.value, str | bool):
        return value
    if isinstance(value, bool) or not isinstance(value, int if isinstance(key.value, int) else int | float):
        raise ValueError("must be a whole number, written without point or exponent" if isinstance(key.value, int) else
                         "must be a plain number without unit or quotes")
    if not in_range(value, key.allowed):
        raise ValueError(f"must be {key.allowed}{key.reason and ' '}{key.reason}")
    if value and not 1e-30 <= abs(value) <= 1e30:
        raise ValueError("must be between 1e-30 and 1e30 in size, because products of other numbers overflow or vanish")
    return value if isinstance(key.value, int) else float(value)


def quantity(key: str, value: Any) -> str:
    """A quantity as scenes write that of one of their keys.   Raises ValueError: what it must be"""
    try:
        scene = Scene(ANY_SCENE, set={key: value}).to_dict()
    except _core.InputError as error:
        raise ValueError(f"must be{str(error).partition('; must be')[2].partition('. Give')[0].rstrip('.')}") from error
    section, _, name = key.partition(".")
    return scene[section][name]


def read_table(document: Document, section: str, path: str, table: Any) -> SimpleNamespace:
    """One table of a plan, with its defaults."""
    if not isinstance(table, dict):
        raise document.refuse(path, f"must be a table. Write [{section}] on a line of its own." if section not in ARRAYS
                              else f"must be a table. Write [[{section}]] on a line of its own.")
    given, prefix = flat(table) if section else table, f"{path}." if path else ""
    known = {key.name for key in KEYS if key.section == section} | (set() if section else set(SECTIONS))
    for name in given:
        if name not in known:
            near = difflib.get_close_matches(f"{section}.{name}".lstrip("."), [key.path for key in KEYS] + list(SECTIONS), 1)
            raise document.refuse(prefix + name, "unknown key. " + (f"Did you mean {near[0]}?" if near else
                                                                     "--print-defaults lists all keys."))
    values = {}
    for key in keys_of(section):
        value, place = given.get(key.name), prefix + key.name
        if key.test and values["test"] != key.test:
            if value is not None:
                raise document.refuse(place, f"does not belong to a curve of test \"{values['test']}\", only to {key.test}. "
                                      "Remove it or change the test.", value)
        elif value is not None:
            try:
                values[key.name] = read_value(key, value)
            except ValueError as error:
                raise document.refuse(place, f"{error}. Give for example {value_text(key.value)}.", value) from error
        elif key.need == "required":
            raise document.refuse(place, f"is missing. Give for example {key.name} = {value_text(key.value)}.")
        elif key.value is not None:
            values[key.name] = None if key.need else key.value
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
        if not curve.name or curve.name[0] == "." or set(curve.name) & set('/,"\n\r\0'):
            raise document.refuse(place, 'must give a name that can name a folder. Give name = "loose", for example.', given)
        for other in plan.curve[:i]:
            if other.name == curve.name:
                raise document.refuse(place, f"names two curves \"{curve.name}\" (the other: {other.where}). Give one of them "
                                      "another name.", given)
        curve.group = curve.group or curve.name
        first, *more = [name for name in DENSITIES if vars(curve)[name] is not None] or [""]
        if more:
            raise document.refuse(f"curve.{i}.{more[0]}", f"excludes curve.{i}.{first} ({document.where(f'curve.{i}.{first}')}"
                                  "). Keep one of them.", vars(curve)[more[0]])
    if all(curve.blind for curve in plan.curve):
        raise document.refuse("curve.0.blind", "leaves no curve to fit: all are blind. Set blind = false for one of them.",
                              True)


def check_parameters(document: Document, plan: Any) -> None:
    """Each belongs to a curve that is fitted, and none is there twice."""
    for i, parameter in enumerate(plan.parameter):
        parameter.where = document.where(f"parameter.{i}.key")
        if not any(concerns(parameter, curve) and not curve.blind for curve in plan.curve):
            raise document.refuse(f"parameter.{i}.curve", "is the name or group of no curve that is fitted. Give that of a "
                                  "[[curve]] without blind.", parameter.curve)
        for other in plan.parameter[:i]:
            if other.key == parameter.key and any(concerns(other, c) and concerns(parameter, c) for c in plan.curve):
                raise document.refuse(f"parameter.{i}.key", f"is a parameter twice (the other: {other.where}). Remove one, or "
                                      "give each its own curve.", parameter.key)
    if plan.optimiser.method == "bobyqa" and len(plan.parameter) < 2:
        if "method" in document.root.get("optimiser", {}):
            raise document.refuse("optimiser.method", "needs two parameters or more. Take \"sbplx\" for one.", "bobyqa")
        plan.optimiser.method = "sbplx"


def parse_plan(text: str, name: str) -> SimpleNamespace:
    """A plan from text, with all its keys: plan.budget.trials, plan.curve[0].test; `name` is that of the file in messages.

    Raises InputError with line, value, allowed range and remedy
    """
    document = Document(text, name)
    plan = read_table(document, "", "", document.root)
    for section in SECTIONS:
        given = document.root.get(section, [] if section in ARRAYS else {})
        if section in ARRAYS and not (isinstance(given, list) and given):
            raise document.refuse(section, f"must have at least one {section}. Give for example {EXAMPLES[section]}.")
        setattr(plan, section, [read_table(document, section, f"{section}.{i}", table) for i, table in enumerate(given)]
                if section in ARRAYS else read_table(document, section, section, given))
    check_curves(document, plan)
    check_parameters(document, plan)
    plan.document = document
    return plan


def found_file(document: Document, key: str, places: list[str], name: str) -> str:
    """The first of some places where a file is."""
    for place in places if name else []:
        if os.path.isfile(place):
            return os.path.normpath(place)
    raise document.refuse(key, f"is not there: neither {' nor '.join(map(os.path.abspath, places))}. A relative path counts "
                          "from the folder of the plan or else from the working directory; correct it.", name)


def read_plan(path: str) -> SimpleNamespace:
    """A plan from a file, and where the files are that it names.   Raises InputError"""
    try:
        plan = parse_plan(pathlib.Path(path).read_text(encoding="utf-8"), path)
    except (OSError, UnicodeDecodeError) as error:
        raise _core.InputError(f"{path}: cannot be read: {getattr(error, 'strerror', None) or 'it holds bytes that are no text'}."
                               " Give the path of a plan (TOML).") from error
    folder = os.path.dirname(path)
    plan.scene_path = found_file(plan.document, "scene", [os.path.join(folder, plan.scene), plan.scene,
                                                          str(command.SCENES / "scenes" / plan.scene)][:3], plan.scene)
    for i, curve in enumerate(plan.curve):
        curve.path = found_file(plan.document, f"curve.{i}.file", [os.path.join(folder, curve.file), curve.file], curve.file)
    return plan


def seconds(interval: str | None) -> float:
    """Of a wall-clock time as scenes write it, in minutes."""
    return 60 * float(interval.split()[0]) if interval else math.inf


__all__ = ["concerns", "number_text", "parse_plan", "read_plan", "seconds"]

# SPDX-License-Identifier: BSD-3-Clause
"""Scenes from files, text, dictionaries and keywords.   tested: tests/python/scene_test.py"""
import json
import os
import pathlib
import tomllib
from typing import Any, Self

from isostat import _core


class Scene(_core.Scene):
    """A whole test: grading, contact law, specimen, motion, stages, output; checked by the same schema as the programs.

    Scene("test.toml")                                     a file; a relative specimen.file counts from its folder, and
                                                           from the working folder if nothing is there
    Scene(text)                                            TOML text (it has line breaks)
    Scene({"stage": [{"kind": "drained", "strain": 0.1}]}) sections as dictionaries; what is left out has its default
    Scene(title="mine", specimen={"pressure": "100 kPa"})  sections as keywords
    Scene(..., set={"motion.damping": 0.05})               single keys over all of that

    Raises InputError with the place, the value, the allowed range and a remedy.
    """

    def __init__(self, source: str | os.PathLike[str] | dict[str, Any] | None = None, /, *,
                 set: dict[str, Any] | None = None, **sections: Any):
        super().__init__(*scene_source(_core.Scene, source, set, sections))

    def with_(self, **keys: Any) -> Self:
        """The scene with other values: scene.with_(**{"motion.damping": 0.05})."""
        return type(self)(self.text, set=keys)

    def __reduce__(self):
        """Copies and pickles go by the text."""
        return type(self), (self.text,)

    def to_dict(self) -> dict[str, Any]:
        """Every key with its value, as nested dictionaries."""
        return tomllib.loads(self.text)

    def __repr__(self):
        return f"<isostat.Scene {self.title!r}>"


def scene_source(kind, source, overrides, sections):
    """Text, name and overrides of a compiled class of scenes from what its class in Python takes."""
    given = [f"{key}={override_text(value)}" for key, value in (overrides or {}).items()]
    if isinstance(source, os.PathLike) or (isinstance(source, str) and "\n" not in source):
        if sections:
            raise _core.InputError("A scene from a file takes single keys with set={...}, no sections.")
        if not pathlib.Path(source).is_file():
            raise _core.InputError(f"{source}: is not there. Give the path of a scene file, its text or a dictionary.")
        return kind._read(os.fspath(source), given).text, os.fspath(source), []
    if isinstance(source, str):
        return source, "scene", given
    return toml_text({**(source or {}), **sections}), "scene", given


def value_text(value):
    """A value as TOML: strings are quoted as JSON does, tables are inline."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {value_text(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(item) for item in value) + "]"
    if hasattr(value, "item"):  # numbers of NumPy
        return value_text(value.item())
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)  # "nan" and "inf" as in TOML
    if isinstance(value, os.PathLike):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    raise _core.InputError(f"{value!r}: a scene has strings, numbers, true and false, lists and dictionaries.")


def override_text(value):
    """As --set takes it: plain text needs no quotes."""
    return value if isinstance(value, str) else value_text(value)


def toml_text(sections):
    """A dictionary of sections as a scene: plain values first, then tables, then arrays of tables."""
    plain = [f"{key} = {value_text(value)}" for key, value in sections.items() if not is_section(value)]
    for key, value in sections.items():
        if not is_section(value):
            continue
        for table in value if isinstance(value, (list, tuple)) else [value]:
            plain.append(f"\n[[{key}]]" if isinstance(value, (list, tuple)) else f"\n[{key}]")
            plain += [f"{name} = {value_text(item)}" for name, item in table.items()]
    return "\n".join(plain) + "\n"


def is_section(value):
    return isinstance(value, dict) or (isinstance(value, (list, tuple)) and bool(value)
                                       and all(isinstance(item, dict) for item in value))

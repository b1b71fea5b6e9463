# SPDX-License-Identifier: BSD-3-Clause
"""Scenes from files, text, dictionaries and keywords.   tested: tests/python/scene_test.py"""
import json
import os
import re
import tomllib
from typing import Any, Self

from isostat import _core


class Scene(_core.Scene):
    """A whole test: grading, contact law, specimen, motion, stages, output; checked by the same schema as the programs.

    Scene("test.toml")                                     a file; a relative specimen.file counts from its folder, and
                                                           from the working folder if nothing is there
    Scene(text)                                            TOML text (it has line breaks)
    Scene({"stage": [{"kind": "drained", "strain": 0.1}]}) sections as dictionaries; omitted keys have their defaults
    Scene(title="mine", specimen={"pressure": "100 kPa"})  sections as keywords
    Scene(..., set={"motion.damping": 0.05})               single keys over all of that

    Raises InputError with the place, the value, the allowed range and a remedy.
    """

    def __init__(self, source: str | os.PathLike[str] | dict[str, Any] | None = None, /, *,
                 set: dict[str, Any] | None = None, **sections: Any):
        super().__init__(*scene_source(source, set, sections))

    def with_(self, **keys: Any) -> Self:
        """The scene with other values: scene.with_(**{"motion.damping": 0.05}).

        Another contact law has keys of its own: Scene({**scene.to_dict(), "contact": {"law": "hertz-mindlin"}}).
        """
        return type(self)(self.text, set=keys)

    def __reduce__(self):
        """Copies and pickles go by the text."""
        return type(self), (self.text,)

    def to_dict(self) -> dict[str, Any]:
        """Every key with its value, as nested dictionaries."""
        return tomllib.loads(self.text)

    def __repr__(self):
        return f"<isostat.Scene {self.title!r}>"


def scene_source(source, overrides, sections):
    """Text, name, overrides, and whether the name is that of a file: what compiled classes of scenes take."""
    if not isinstance(overrides, dict | None):
        raise _core.InputError(f"set: must be a dictionary of keys and values, but is {overrides!r}.")
    given = [f"{key}={override_text(value, key)}" for key, value in (overrides or {}).items()]
    if isinstance(source, os.PathLike) or (isinstance(source, str) and "\n" not in source):
        if sections:
            raise _core.InputError("A scene from a file takes single keys with set={...}, no sections.")
        if not os.path.isfile(source):
            raise _core.InputError(f"{source}: does not exist. Give the path of a scene file, its text or a dictionary.")
        return "", os.fspath(source), given, True
    if isinstance(source, str):
        return source, "scene", given
    if source is not None and not isinstance(source, dict):
        raise _core.InputError(f"scene: must be a path, TOML text or a dictionary, but is {source!r}.")
    return toml_text({**(source or {}), **sections}), "", given  # without a name: its lines are none of the user's


def key_text(key, table=""):
    """A key as TOML; dots stay as they are, "rolling.limit" is `limit` in the table `rolling`."""
    if not isinstance(key, str):
        raise _core.InputError(f"{table + ': ' if table else ''}{key!r}: names of keys are text.")
    return key if re.fullmatch(r"[A-Za-z0-9_.-]+", key) else json.dumps(key, ensure_ascii=False)


def value_text(value, path):
    """A value as TOML: strings are quoted as JSON does, tables are inline.   path: of its key, for messages"""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key_text(key, path)} = {value_text(item, f'{path}.{key}')}"
                                for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(item, f"{path}.{k}") for k, item in enumerate(value)) + "]"
    if hasattr(value, "item"):  # numbers of NumPy
        return value_text(value.item(), path)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value)  # "nan" and "inf" as in TOML
    if isinstance(value, os.PathLike):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    raise _core.InputError(f"{path} = {value!r}: must be text, a number, True or False, a list or a dictionary."
                           + (" Leave the key out for its default." if value is None else ""))


def override_text(value, key):
    """As --set takes it: plain text needs no quotes."""
    return value if isinstance(value, str) else value_text(value, key)


def toml_text(sections):
    """A dictionary of sections as a scene: plain values first, then tables, then arrays of tables."""
    plain = [f"{key_text(key)} = {value_text(value, key)}" for key, value in sections.items() if not is_section(value)]
    for key, value in sections.items():
        if not is_section(value):
            continue
        several = isinstance(value, (list, tuple))
        for number, table in enumerate(value if several else [value]):
            plain.append(f"\n[[{key_text(key)}]]" if several else f"\n[{key_text(key)}]")
            path = f"{key}.{number}" if several else key
            plain += [f"{key_text(name, path)} = {value_text(item, f'{path}.{name}')}" for name, item in table.items()]
    return "\n".join(plain) + "\n"


def is_section(value):
    return isinstance(value, dict) or (isinstance(value, (list, tuple)) and bool(value)
                                       and all(isinstance(item, dict) for item in value))

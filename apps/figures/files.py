# SPDX-License-Identifier: BSD-3-Clause
"""Tables that a run has left as text, JSON or TOML. Needs nothing but Python: figures, reports and the module isostat
read them here.   tested: tests/apps/report_test.py"""
import contextlib
import itertools
import json
import os
import re

REMEDY = ("Restore it from a copy, or delete it and finish the run again: its command is in provenance.txt, and "
          "--resume continues from a checkpoint.")
NOT_SHEARED = ("compress", "friction", "rebalance", "hold", "k0-compress", "repeat")  # kinds of stage
NUMBERS = itertools.count()


@contextlib.contextmanager
def replacing(path):
    """A path next to `path` that no other writer has; what is written there becomes `path` at the end, in one step."""
    aside = path.with_name(f"{path.name}.{os.getpid()}-{next(NUMBERS)}.tmp")
    aside.unlink(missing_ok=True)
    try:
        yield aside
        os.replace(aside, path)
    finally:
        aside.unlink(missing_ok=True)


class BadInput(Exception):
    """What was given is not what a command or a figure can be made of."""


def check_results(folder):
    """Raises BadInput where there is no folder."""
    if not folder.is_dir():
        what = "is a file, not a results folder" if folder.exists() else "does not exist"
        raise BadInput(f"{folder}: {what}. Give the results folder of a run.")


def check_target(path, beginnings, option="--output"):
    """Raises BadInput where a file cannot be written, or would replace one that its command has not written.

    beginnings   {ending: bytes that are among the first 1000 of such a file}
    option       that names the file
    """
    if path.suffix not in beginnings:
        raise BadInput(f"{path}: must end with {' or '.join(beginnings)}.")
    folder = path.absolute().parent
    if path.is_dir() or not folder.is_dir():
        what = "is a folder" if path.is_dir() else f"there is no folder {folder}"
        raise BadInput(f"{path}: cannot be written: {what}. Give a file in a folder that exists with {option}.")
    if not path.exists():
        return
    ours = path.is_file()
    if ours:
        with open(path, "rb") as file:
            ours = beginnings[path.suffix] in file.read(1000)
    if not ours:
        raise BadInput(f"{path}: exists and is not a file of this command. Give another {option}, or move it away.")


class Damaged(ValueError):
    """A file that is not what a run left; the message has the place, what is wrong and what to do."""

    def __init__(self, path, line, reason):
        super().__init__(f"{path}:{line}: is damaged ({reason}). {REMEDY}")


def place_of(error, content):
    """The line that an error of a parser names after its reason, else the last one; and the reason."""
    named = re.fullmatch(r"(.*?)[:(]? ?(?:\(?at )?line (\d+).*", str(error))
    if named:
        return int(named[2]), named[1].strip()
    return content.rstrip().count(b"\n") + 1, str(error).replace(" (at end of document)", "")


def read_parsed(path, parse=json.loads):
    """The table in a file, as a dictionary.   Raises OSError if it cannot be opened, Damaged if it holds no table"""
    content = path.read_bytes()
    try:
        table = parse(content.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise Damaged(path, content.count(b"\n", 0, error.start) + 1, "it holds bytes that are no text") from error
    except ValueError as error:
        line, reason = place_of(error, content)
        raise Damaged(path, line, reason if content.strip() else "it is empty") from error
    if not isinstance(table, dict):
        raise Damaged(path, 1, "it holds no table of names and values")
    return table

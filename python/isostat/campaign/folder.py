# SPDX-License-Identifier: BSD-3-Clause
"""The folder of a campaign, to which the same command comes back.   tested: tests/apps/resistance_test.py"""
import contextlib
import os
import pathlib
import shlex
import shutil
import sys
import time
import typing

from isostat import _core
from isostat.campaign.locks import wait_for_lock, wait_until_free
from isostat.campaign.runs import program as path_of

FIRST_FILES = (".lock", "provenance.txt", "scene.toml")  # of a call that was killed before its scene was there
PATIENCE, RUNS_END = 5, 60  # s, for a program that is about to leave, for a run that writes a checkpoint
_locks: dict[pathlib.Path, typing.BinaryIO] = {}  # of this process, until it ends


def write_replacing(path: pathlib.Path, text: str) -> None:
    """Writes a file aside, brings it to the disk and renames it, as the programs do: a reader finds all of it. A
    path in the text that is not UTF-8 is spelt out.   Raises RunFailure"""
    _core._write_replacing(path, text.encode("utf-8", "backslashreplace"))


def is_first(name: str) -> bool:
    return name in FIRST_FILES[:2] or (name.endswith(".tmp") and name.startswith((*FIRST_FILES, ".writable")))


def first_difference(text: str, other: str) -> str:
    """The first line of a text that another one has not at that place."""
    lines, others = text.splitlines(), other.splitlines()
    return next((line for line, twin in zip(lines, others) if line != twin), (lines[len(others):] or [""])[0])


def refuse_other(path: pathlib.Path, text: str, owner: str) -> None:
    """Raises InputError where a file holds another text: the folder is of another `owner`, "scene" or "calibration"."""
    kept = path.read_bytes().decode("utf-8", "replace") if path.is_file() else text
    if kept != text:
        raise _core.InputError(f"{path}: belongs to another {owner}: it has `{first_difference(kept, text)}` where this "
                               f"one has `{first_difference(text, kept)}`. Choose another --output, or --overwrite to "
                               "start again.")


class CampaignFolder:
    """Holds a folder for this process, until it ends, however it ends.

    kept       {name of a file: text} of what makes the results, "scene.toml" among them
    owner      who a folder with other texts belongs to
    overwrite  what the folder holds is removed first; it must be that of a campaign
    only_check the folder is not made, held or written to
    program    that does the runs: it must be there before anything is removed

    Raises InputError: no such program, a file, a folder of something else, of another scene, at work, or that cannot be written.
    """

    def __init__(self, path: str | os.PathLike[str], kept: dict[str, str], *, owner: str = "scene",
                 overwrite: bool = False, command: str | None = None, only_check: bool = False,
                 program: str = "element_test"):
        self.path = pathlib.Path(path)
        path_of(program)
        self.check(kept, owner, overwrite)
        if only_check:
            return
        self._hold()
        self.check(kept, owner, overwrite)  # another command may have been faster
        if overwrite:
            self._empty()
        calls = self.path / "provenance.txt"
        before = calls.read_text(encoding="utf-8", errors="replace") + "\n" if calls.is_file() else ""
        write_replacing(calls, before + provenance(command or shlex.join([os.path.basename(sys.argv[0]), *sys.argv[1:]])))
        # scene.toml first: a folder with other files but without it is refused, even by the command that made it
        for name, text in sorted(kept.items(), key=lambda item: item[0] != "scene.toml"):
            (self.path / name).parent.mkdir(exist_ok=True)
            write_replacing(self.path / name, text)

    def check(self, kept, owner, overwrite):
        """Raises InputError where the folder is not one for these texts; leaves no trace."""
        if self.path.exists() and not self.path.is_dir():
            raise _core.InputError(f"{self.path}: is a file, not a folder. Choose another --output.")
        if not self.path.is_dir() or all(is_first(entry.name) for entry in self.path.iterdir()):
            return
        for name in ("scene.toml", "provenance.txt"):  # a user's folder may hold a scene
            if not (self.path / name).is_file():
                raise _core.InputError(f"{self.path}: not overwritten, because it holds no {name} and may not be a "
                                       "results folder. Choose another --output.")
        for name, text in {} if overwrite else kept.items():
            refuse_other(self.path / name, text, owner)

    def _hold(self):
        place = self.path.resolve()
        if place in _locks:  # of an earlier call in this process
            return
        try:
            self.path.mkdir(parents=True, exist_ok=True)
            lock = open(self.path / ".lock", "ab")  # pylint: disable=consider-using-with
        except OSError as error:
            raise _core.InputError(f"{self.path}: the output folder cannot be made or written to ({error.strerror}). "
                                   "Give a path you may write to with --output.") from error
        if not wait_for_lock(lock, PATIENCE):
            lock.close()
            raise _core.InputError(f"{self.path}: another program is using it. Wait for it, or give another "
                                   "--output.")
        _locks[place] = lock

    def _empty(self):
        for lock in self.path.glob("*/**/.lock"):
            wait_until_free(lock.parent, RUNS_END)  # of a run whose campaign was killed
        names = [entry.name for entry in self.path.iterdir() if entry.name not in FIRST_FILES]
        for name in [*names, "scene.toml", "provenance.txt"]:  # last what marks these as results
            path = self.path / name
            try:
                with contextlib.suppress(FileNotFoundError):
                    shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()
            except OSError as error:
                raise _core.RunFailure(f"{path}: cannot be removed: {error.strerror}. Remove it by hand, or give "
                                       "another --output.") from error


def provenance(command: str) -> str:
    started = time.strftime("%Y-%m-%d %H:%M:%S", time.gmtime())
    return f"command           {command}\nversion           {_core.__version__}\nstarted           {started} UTC\n"

# SPDX-License-Identifier: BSD-3-Clause
"""Locks on files (flock): one holder among all processes that see the file; they end with the process that holds them.

A file system that has no locks gives them to everybody.   tested: tests/python/campaign_test.py
"""
import fcntl
import pathlib
import time
from collections.abc import Callable
from typing import BinaryIO


def try_lock(file: BinaryIO) -> bool:
    """Whether this process holds the file's lock now."""
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # no locks there: no message
        pass
    return True


def wait_for_lock(file: BinaryIO, patience: float, given_up: Callable[[], bool] = lambda: False) -> bool:
    """Whether the lock came within this many seconds; `given_up` ends the wait, too."""
    end = time.monotonic() + patience
    while not try_lock(file):
        if given_up() or time.monotonic() > end:
            return False
        time.sleep(0.1)
    return True


def wait_until_free(folder: pathlib.Path, patience: float) -> bool:
    """Whether no program of Isostat works in a results folder, at last after this many seconds."""
    try:
        with open(folder / ".lock", "rb+") as file:
            return wait_for_lock(file, patience)
    except (FileNotFoundError, NotADirectoryError):
        return True

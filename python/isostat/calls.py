# SPDX-License-Identifier: BSD-3-Clause
"""What long calls share: their warnings, and signals that end them.   tested: tests/python/warnings_test.py"""
import contextlib
import os
import pathlib
import signal
import sys
import threading
import warnings

from isostat import _core

STOPPING = (signal.SIGTERM, signal.SIGHUP, signal.SIGUSR1, signal.SIGXCPU)  # and SIGINT, as the programs have them


def path_text(name, value):
    """An argument that is a path, as text.   Raises InputError with its name"""
    try:
        return os.fspath(value)
    except TypeError:
        raise _core.InputError(f"{name}: must be a path, but is {value!r}.") from None


def check_use(overwrite, resume):
    """Raises InputError where a run is to replace what it is to continue from."""
    if overwrite and resume:
        raise _core.InputError("overwrite and resume exclude each other: one replaces the results that the other "
                               "continues from. Give one of them.")


@contextlib.contextmanager
def warned(name, quiet):
    """Gives a list for the warnings of a call, and warns of them when the call is over: "name: text".

    name: of the run. quiet: True: they are only listed.
    """
    listed = []
    def warn():
        for text in listed if quiet is not True else ():
            warnings.warn(f"{name}: {text}", _core.IsostatWarning, stacklevel=depth_of_caller())

    try:
        yield listed
    except BaseException:
        with contextlib.suppress(Warning):  # a filter may make errors of warnings: the first one counts
            warn()
        raise
    warn()


def depth_of_caller():
    """As stacklevel: of the first caller outside of this package, so that the warning names his line."""
    own = (str(pathlib.Path(__file__).parent) + os.sep, contextlib.__file__)
    frame, depth = sys._getframe(1), 1
    while frame.f_back and frame.f_code.co_filename.startswith(own):
        frame, depth = frame.f_back, depth + 1
    return depth


@contextlib.contextmanager
def stopped_by_signals():
    """Signals that would kill the interpreter raise KeyboardInterrupt instead, as Ctrl-C does.

    In the main thread, and only those that the program does not handle or ignore itself. A second one kills.
    """
    def stop(number, _):
        signal.signal(number, signal.SIG_DFL)
        raise KeyboardInterrupt(signal.Signals(number).name)

    if threading.current_thread() is not threading.main_thread():
        yield
        return
    ours = [number for number in STOPPING if signal.getsignal(number) is signal.SIG_DFL]
    for number in ours:
        signal.signal(number, stop)
    try:
        yield
    finally:
        for number in ours:
            signal.signal(number, signal.SIG_DFL)

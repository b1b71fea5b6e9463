# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the programs, each in its own process and kept in its own folder.

tested: tests/python/campaign_test.py, tests/apps/campaign_engines_test.py
"""
import concurrent.futures
import contextlib
import dataclasses
import errno
import json
import math
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from typing import Any

from isostat import _core
from isostat.calls import STOPPING
from isostat.campaign.locks import wait_for_lock, wait_until_free

LAUNCHED = ("OMPI_", "PMIX_", "PMI_", "SLURM_")  # what a launcher passes to its ranks: programs that these start are none
PATIENCE = 60  # s, for a process that another call left in a folder: it stops with a checkpoint when its parent ends
BAD_INPUT, STOPPED = 2, 130  # exit codes
CRASHED = 126  # exit codes from here on: stopped, killed or crashed
NO_ROOM = [os.strerror(code) for code in (errno.ENOSPC, errno.EDQUOT)]
OWN_FILES = ("scene.toml", "provenance.txt", "result.json", ".lock", ".writable")  # one of them is in every folder of a run
_at_work: set[subprocess.Popen[bytes]] = set()
_stopping = threading.Event()


def program(name: str) -> str:
    """The path of a program of this installation.   Raises InputError"""
    folders = [parent / "bin" for parent in pathlib.Path(__file__).parents[2:7]]
    if pathlib.Path(sys.argv[0]).name == "isostat":
        folders.append(pathlib.Path(sys.argv[0]).parent)
    for folder in folders:
        if os.access(folder / name, os.X_OK) and (folder / name).is_file():
            return str((folder / name).absolute())
    if found := shutil.which(name):  # of another installation: a wheel has no programs
        return found
    raise _core.InputError(f"{name}: is not in this installation of Isostat. Build it: cmake --build --preset release "
                           f"--target {name}.")


@dataclasses.dataclass(frozen=True)
class Run:
    """A scene that a program runs, and where: FOLDER/scenes/NAME.toml, FOLDER/runs/NAME/, FOLDER/logs/NAME.log, .cpu and
    .lock."""

    name: str
    text: str  # of the scene, every key resolved
    scene: pathlib.Path
    results: pathlib.Path
    log: pathlib.Path
    program: str = "element_test"
    threads: int = 1

    @classmethod
    def below(cls, folder, name, scene, program="element_test", results="runs", threads=1):
        """The run of a Scene (or ColumnScene) in the usual places below the folder of a campaign."""
        folder = pathlib.Path(folder).absolute()
        if not scene.folder:  # else the program would name one after the file, and the text not be its own
            scene = scene.with_(**{"output.folder": results})
        return cls(name, scene.text, folder / "scenes" / f"{name}.toml", folder / results / name,
                   folder / "logs" / f"{name}.log", program, threads)

    def command(self, resumed: bool) -> list[str]:
        return [program(self.program), str(self.scene), "--output", str(self.results), "--threads", str(self.threads),
                "--no-figures", *["--resume"] * resumed]

    @property
    def is_finished(self) -> bool:
        """True if its folder holds the results of this scene, to its end."""
        try:
            return (self.results / "summary.json").is_file() and self.is_of_this_scene
        except OSError:
            return False

    @property
    def is_of_this_scene(self) -> bool:
        """Whether what is in its folder can be gone on with."""
        with contextlib.suppress(OSError):
            return (self.results / "scene.toml").read_text(encoding="utf-8") == self.text
        return False

    @property
    def cpu_seconds(self) -> float:
        """That its processes took; 0 if none has ended."""
        with contextlib.suppress(OSError, ValueError):
            return float(self.log.with_suffix(".cpu").read_text(encoding="ascii"))
        return 0.0

    @property
    def last_line(self) -> str:
        """What it said last; empty if it has not said anything."""
        with contextlib.suppress(OSError):
            lines = self.log.read_text(encoding="utf-8", errors="replace").split("\n")
            return next((line for line in reversed(lines) if line.strip()), "")
        return ""

    @property
    def reason(self) -> str:
        """Why it failed, as its program said."""
        with contextlib.suppress(OSError):
            lines = self.log.read_text(encoding="utf-8", errors="replace").rstrip().split("\n")
            for k in reversed(range(len(lines))):
                if lines[k].startswith(("error: ", "failed: ")):
                    return "; ".join(line.strip() for line in lines[k:])
        return self.last_line


def read_summary(results: pathlib.Path) -> dict[str, Any]:
    """summary.json of a run that has finished.   Raises InputError (a damaged file)"""
    try:
        return json.loads((results / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise _core.InputError(f"{results / 'summary.json'}: is damaged ({error}).") from error


def execute(run: Run) -> tuple[int, float]:
    """Does a run, or the rest of it where there is a checkpoint, in this process' place: what an engine is given.

    Waits for the process that already does it; what that one has finished is not done again. The program ends with a checkpoint
    when the thread that called this ends.
    Returns its exit code, or 128 + the signal that ended it, and the seconds it took.
    """
    start = time.monotonic()
    for file in (run.results, run.log):
        file.parent.mkdir(parents=True, exist_ok=True)
    with open(run.log.with_suffix(".lock"), "ab") as lock:
        if not wait_for_lock(lock, math.inf, _stopping.is_set):
            return STOPPED, 0
        if run.is_finished:
            return 0, 0
        if not wait_until_free(run.results, PATIENCE):
            return refuse(run, "another program is using it. Wait for it."), 0
        if has_other_files(run.results):
            return refuse(run, "is not emptied, because it holds no results. Move it away."), 0
        resumed = run.is_of_this_scene and any((run.results / "checkpoint").glob("*.h5"))
        code = start_program(run, resumed)
        if resumed and code == BAD_INPUT:  # its checkpoint is damaged
            code = start_program(run, False)
    return code, time.monotonic() - start


def has_other_files(folder: pathlib.Path) -> bool:
    """Whether a folder may be a user's own. A run that was killed as it began leaves files aside."""
    names = [entry.name for entry in folder.iterdir() if not entry.name.endswith(".tmp")] if folder.is_dir() else []
    return bool(names) and not set(OWN_FILES) & set(names)


def refuse(run: Run, why: str) -> int:
    run.log.unlink(missing_ok=True)
    run.log.write_text(f"error: {run.results}: {why}\n", encoding="utf-8")
    return BAD_INPUT


def start_program(run: Run, resumed: bool) -> int:
    """Its exit code; what the folder holds is removed unless the program continues with it."""
    if not resumed:
        shutil.rmtree(run.results, ignore_errors=True)
        run.log.with_suffix(".cpu").unlink(missing_ok=True)
    run.log.unlink(missing_ok=True)  # it may be a link to a user's file
    command = ["setpriv", "--pdeathsig", "TERM", "--", *run.command(resumed)]
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith(LAUNCHED) or name.startswith("OMPI_ALLOW_RUN_AS_ROOT")}
    environment |= {"OPENBLAS_NUM_THREADS": "1"} | ({"OMP_NUM_THREADS": str(run.threads)} if run.threads else {})
    if _stopping.is_set():
        return STOPPED
    with open(run.log, "xb") as log:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                                   env=environment, process_group=0)
    _at_work.add(process)
    try:
        if _stopping.is_set():
            os.kill(process.pid, signal.SIGTERM)
        _, status, usage = os.wait4(process.pid, 0)
    finally:
        _at_work.discard(process)
    process.returncode = code = os.waitstatus_to_exitcode(status)
    spent = usage.ru_utime + usage.ru_stime + run.cpu_seconds
    run.log.with_suffix(".cpu").write_text(f"{spent:.2f}\n", encoding="ascii")
    return code if code >= 0 else 128 - code


def stop() -> None:
    """Asks the programs that this process has started to end with a checkpoint; it starts no others."""
    _stopping.set()
    for process in list(_at_work):
        with contextlib.suppress(ProcessLookupError):
            os.kill(process.pid, signal.SIGTERM)  # send_signal() might reap it before execute() does


@contextlib.contextmanager
def signals_noted() -> Iterator[threading.Event]:
    """Signals that end a program only set a flag: an exception within concurrent.futures would leave its locks held. A
    second one kills, as ever."""
    noted = threading.Event()

    def note(number, _):
        if noted.is_set():
            signal.signal(number, signal.SIG_DFL)
            os.kill(os.getpid(), number)
        noted.set()

    is_main = threading.current_thread() is threading.main_thread()
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, *STOPPING)} if is_main else {}
    try:
        for number, handler in before.items():
            if handler not in (signal.SIG_IGN, None):
                signal.signal(number, note)
        yield noted
    finally:
        for number, handler in before.items():
            if handler is not None:
                signal.signal(number, handler)


def complete(executor: concurrent.futures.Executor, runs: Iterable[Run],
             ended: Callable[[Run, int, float], None] = lambda run, code, seconds: None,
             waiting: Callable[[list[Run]], None] = lambda runs: None, interval: float = 30) -> None:
    """Does all runs, side by side. When it is interrupted it starts no others, and lets those of this machine end with a
    checkpoint.

    ended     called for each run that has ended: its exit code and the seconds it took
    waiting   called with the running ones, whenever nothing has ended for `interval` seconds

    Raises RunFailure, at the end, if runs were stopped by another process, and at once if the disk is full or the engine has
    lost one; KeyboardInterrupt.
    """
    _stopping.clear()
    stopped = []
    futures: dict[concurrent.futures.Future[tuple[int, float]], Run] = {}
    pending = set()

    def tell_of_ended():
        """Waits a little; returns whether anything has ended."""
        nonlocal pending
        done, pending = concurrent.futures.wait(pending, 0.5, concurrent.futures.FIRST_COMPLETED)
        for future in [future for future in futures if future in done]:
            code, seconds = result_of(future, futures[future])
            if code == STOPPED:
                stopped.append(futures[future])
            elif code and any(text in futures[future].reason for text in NO_ROOM):  # says nothing of the scene
                raise _core.RunFailure(f"{futures[future].name}: {futures[future].reason}. Make room; the same command "
                                       "continues.")
            ended(futures[future], code, seconds)
        return bool(done)

    with signals_noted() as interrupted:
        try:
            for run in runs:
                run.scene.parent.mkdir(parents=True, exist_ok=True)
                run.scene.write_text(run.text, encoding="utf-8")
                future = executor.submit(execute, run)
                futures[future] = run
                pending.add(future)
            last = time.monotonic()
            while pending:
                if interrupted.is_set():
                    raise KeyboardInterrupt
                if tell_of_ended():
                    last = time.monotonic()
                elif time.monotonic() - last > interval:
                    waiting([futures[future] for future in pending if future.running()])
                    last = time.monotonic()
        except BaseException:
            pending = {future for future in pending if not future.cancel()}
            stop()
            end = time.monotonic() + PATIENCE  # runs of other machines continue, and are found finished by the next call
            while pending and time.monotonic() < end:
                tell_of_ended()
            raise
    if stopped:
        raise _core.RunFailure(f"{len(stopped)} runs were stopped by another process, the first of them {stopped[0].name}; "
                               "the same command continues")


def result_of(future: concurrent.futures.Future[tuple[int, float]], run: Run) -> tuple[int, float]:
    try:
        return future.result()
    except (KeyboardInterrupt, _core.InputError, _core.RunFailure, OSError):
        raise
    except BaseException as error:  # of the engine: every library has its own
        raise _core.RunFailure(f"{run.name}: the engine has lost it ({type(error).__name__}). What has ended is kept, the "
                               "same command continues.") from error

# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the programs, each in a process of its own and kept in a folder of its own.

tested: tests/apps/campaign_engines_test.py, tests/apps/resistance_test.py
"""
import concurrent.futures
import contextlib
import dataclasses
import fcntl
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterable
from typing import Any

from isostat import _core

LAUNCHED = ("OMPI_", "PMIX_", "PMI_", "SLURM_")  # what a launcher tells its ranks: programs that these start are none
PATIENCE = 60  # s, for a process that another call left in a folder: it stops with a checkpoint when its parent ends
CRASHED = 126  # exit codes from here on: stopped, killed or crashed
_at_work: set[subprocess.Popen[bytes]] = set()


def program(name: str) -> str:
    """The path of a program of this installation.   Raises InputError"""
    folders = [pathlib.Path(sys.argv[0]).parent, *(parent / "bin" for parent in pathlib.Path(__file__).parents[2:7])]
    for folder in folders:
        if os.access(folder / name, os.X_OK) and (folder / name).is_file():
            return str((folder / name).absolute())
    if found := shutil.which(name):  # of another installation: a wheel has no programs
        return found
    raise _core.InputError(f"{name}: is not in this installation of Isostat. Build it: cmake --build --preset release "
                           f"--target {name}.")


@dataclasses.dataclass(frozen=True)
class Run:
    """A scene that a program runs, and where: FOLDER/scenes/NAME.toml, FOLDER/runs/NAME/, FOLDER/logs/NAME.log and .cpu."""

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
            return ((self.results / "summary.json").is_file()
                    and (self.results / "scene.toml").read_text(encoding="utf-8") == self.text)
        except OSError:
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


def read_summary(results: pathlib.Path) -> dict[str, Any]:
    """summary.json of a run that has finished.   Raises InputError (a damaged file)"""
    try:
        return json.loads((results / "summary.json").read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise _core.InputError(f"{results / 'summary.json'}: is damaged ({error}).") from error


def wait_until_free(folder: pathlib.Path) -> None:
    """Until no process works in a results folder, or patience ends: then its program says what is the matter."""
    end = time.monotonic() + PATIENCE
    with contextlib.suppress(FileNotFoundError, NotADirectoryError), open(folder / ".lock", "rb+") as file:
        while time.monotonic() < end:
            with contextlib.suppress(BlockingIOError):
                return fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            time.sleep(0.1)


def execute(run: Run) -> tuple[int, float]:
    """Does a run, or the rest of it where there is a checkpoint, in this process' place: what an engine is given.

    The program ends with a checkpoint when the thread that called this ends.
    Returns its exit code, or 128 + the signal that ended it, and the seconds it took.
    """
    start = time.monotonic()
    wait_until_free(run.results)
    resumed = any((run.results / "checkpoint").glob("*.h5"))
    if not resumed:
        shutil.rmtree(run.results, ignore_errors=True)
    for file in (run.results, run.log):
        file.parent.mkdir(parents=True, exist_ok=True)
    run.log.unlink(missing_ok=True)  # it may be a link to a file of somebody
    command = ["setpriv", "--pdeathsig", "TERM", "--", *run.command(resumed)]
    environment = {name: value for name, value in os.environ.items()
                   if not name.startswith(LAUNCHED) or name.startswith("OMPI_ALLOW_RUN_AS_ROOT")}
    environment |= {"OMP_NUM_THREADS": str(run.threads), "OPENBLAS_NUM_THREADS": "1"}
    with open(run.log, "xb") as log:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                                   env=environment, process_group=0)
    _at_work.add(process)
    try:
        _, status, usage = os.wait4(process.pid, 0)
    finally:
        _at_work.discard(process)
    process.returncode = code = os.waitstatus_to_exitcode(status)
    spent = usage.ru_utime + usage.ru_stime + (run.cpu_seconds if resumed else 0)
    run.log.with_suffix(".cpu").write_text(f"{spent:.2f}\n", encoding="ascii")
    return (code if code >= 0 else 128 - code), time.monotonic() - start


def stop() -> None:
    """Asks the programs that this process has started to end with a checkpoint."""
    for process in list(_at_work):
        with contextlib.suppress(ProcessLookupError):
            os.kill(process.pid, signal.SIGTERM)  # send_signal() might reap it before execute() does


def complete(executor: concurrent.futures.Executor, runs: Iterable[Run],
             ended: Callable[[Run, int, float], None] = lambda run, code, seconds: None,
             waiting: Callable[[list[Run]], None] = lambda runs: None, interval: float = 30) -> None:
    """Does all runs, side by side. When it is interrupted it starts no others, and lets those of this machine end with a
    checkpoint.

    ended     told of each run that has ended: its exit code and the seconds it took
    waiting   told of those at work, whenever nothing has ended for `interval` seconds
    """
    futures: dict[concurrent.futures.Future[tuple[int, float]], Run] = {}
    pending = set()

    def wait(seconds):
        """Tells of what has ended; returns whether anything has."""
        nonlocal pending
        done, pending = concurrent.futures.wait(pending, seconds, concurrent.futures.FIRST_COMPLETED)
        for future in [future for future in futures if future in done]:
            ended(futures[future], *future.result())
        return bool(done)

    try:
        for run in runs:
            run.scene.parent.mkdir(parents=True, exist_ok=True)
            run.scene.write_text(run.text, encoding="utf-8")
            future = executor.submit(execute, run)
            futures[future] = run
            pending.add(future)
        while pending:
            if not wait(interval):
                waiting([futures[future] for future in pending if future.running()])
    except BaseException:
        pending = {future for future in pending if not future.cancel()}
        stop()
        end = time.monotonic() + PATIENCE  # runs of other machines go on, and are found finished by the next call
        while pending and time.monotonic() < end:
            wait(1)
        raise

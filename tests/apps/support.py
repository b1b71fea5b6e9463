# SPDX-License-Identifier: BSD-3-Clause
"""What the command line tests share: a tiny scene, running the programs, comparing what they leave behind.
"""
import contextlib
import csv
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np

if sys.argv[0].endswith("_test.py"):
    sys.exit("a test in Python is run by tests/run.py BIN TEST")
ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(sys.argv[1]).resolve()

os.environ.pop("PYTHONUNBUFFERED", None)  # as in the shell of a user
os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_pml="ob1",
                  OMPI_MCA_ess_singleton_isolated="1", OPENBLAS_NUM_THREADS="1")  # as in tests/CMakeLists.txt
DISK, MEMORY = tempfile.gettempdir(), "/dev/shm"  # what is in memory may not be executable
if os.path.ismount(MEMORY) and shutil.disk_usage(MEMORY).free > 2e9:
    tempfile.tempdir = os.environ["TMPDIR"] = MEMORY  # a short run syncs 50 times, and a disk takes 4 ms each time
TIME_LIMIT = float(os.environ.get("ISOSTAT_TIME_LIMIT", "3600")) / 4  # s; a hang is reported before ctest ends the test
ATTEMPTS = 5  # to stop a run, which may end first on a busy machine
CACHE = tempfile.TemporaryDirectory(prefix="isostat_cache_")  # pylint: disable=consider-using-with

TINY = """title = "tiny"
[grading]
grains = 200
cloud_edge = "2.7 mm"
[contact]
young = "0.5 GPa"
friction = "18 deg"
rolling = {{ stiffness = 0.3, limit = 0.5 }}
twisting = {{ stiffness = 0.3 }}
[specimen]
{specimen}
[motion]
{motion}
{stages}
[output]
record_steps = 50
{output}
"""
CYCLIC = '[[stage]]\nkind = "undrained-cyclic"\ndeviator_amplitude = "40 kPa"\nmax_steps = {steps}\n'
MONOTONIC = '[[stage]]\nkind = "undrained-monotonic"\nstrain = 0.02\nmax_steps = {steps}\n'
REBALANCE = '[[stage]]\nkind = "rebalance"\nmax_steps = {steps}\n'


def tiny_scene(specimen='preparation_friction = "10 deg"', motion='strain_rate = "2 1/s"', stages=None, output=""):
    return TINY.format(specimen=specimen, motion=motion, stages=stages or CYCLIC.format(steps=2000), output=output)


def wait_until(happened, what, process=None, interval=0.005):
    """Returns once happened() is true or the process has ended; asks every `interval` s."""
    end = time.monotonic() + TIME_LIMIT
    while not happened() and (process is None or process.poll() is None):
        if time.monotonic() > end:
            raise TimeoutError(f"{what}: not there after {TIME_LIMIT:g} s")
        time.sleep(interval)


def written_since(path, begin):
    with contextlib.suppress(FileNotFoundError):
        return path.stat().st_mtime >= begin
    return False


def children(process):
    """Numbers of the processes that its threads have started; none once it has ended."""
    found = []
    for started in pathlib.Path(f"/proc/{process.pid}/task").glob("*/children"):
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            found += [int(word) for word in started.read_text(encoding="ascii").split()]
    return found


class ToleranceTest(unittest.TestCase):
    """Comparisons that say why their tolerance is as large as it is; the twin of tests/support/near.hpp.

    All take numbers or arrays of one shape. The reason is printed by a failure: round-off of n operations, an order of
    convergence, the digits of a file, a scatter."""

    def assert_near(self, actual, expected, tolerance, reason):
        """|actual - expected| <= tolerance, a number or one for each value."""
        actual, expected = np.asarray(actual), np.asarray(expected)
        self.assertIn(expected.shape, (actual.shape, ()))
        off = np.abs(actual - expected) - tolerance
        self.assertTrue((off <= 0).all(),
                        f"{actual} and {expected} differ by more than {tolerance}, because of: {reason}")

    def assert_close(self, actual, expected, relative, reason):
        """|actual - expected| <= relative times the largest |expected|."""
        self.assert_near(actual, expected, relative * np.abs(expected).max(), reason)

    def assert_below(self, error, bound, reason):
        """error <= bound."""
        self.assertTrue((np.asarray(error) <= bound).all(), f"{error} is more than {bound}, because of: {reason}")


class AppTest(ToleranceTest):
    """A test with a folder of its own, in which the programs run. Prepared specimens are kept for the whole script."""

    cache = pathlib.Path(CACHE.name)

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="isostat_app_"))
        (self.folder / "specimens").symlink_to(self.cache)
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def summary_of(self, folder, name="summary.json"):
        """What a program has left as JSON."""
        return json.loads((self.folder / folder / name).read_text(encoding="utf-8"))

    def command(self, program, *arguments):
        return [str(BIN / program), *map(str, arguments)]

    def run_command(self, command, **options):
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, timeout=TIME_LIMIT, check=False,
                              **options)

    def run_app(self, program, *arguments):
        return self.run_command(self.command(program, *arguments))

    def run_test(self, *arguments):
        """element_test without figures, which are not the matter here."""
        return self.run_app("element_test", *arguments, "--no-figures")

    def assert_done(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)

    def assert_refused(self, result, *parts):
        """Exit code 2, one `error:` line that holds all the parts, and nothing on stdout."""
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        message = result.stderr[result.stderr.find("error: "):]
        self.assertTrue(message.startswith("error: "), result.stderr)
        for part in parts:
            self.assertIn(part, message)
        self.assertEqual(result.stdout, "")

    @contextlib.contextmanager
    def started(self, command, **options):
        """A program at work. If the test fails meanwhile it is killed with its children: it may hang."""
        options = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True} | options
        with subprocess.Popen(command, cwd=self.folder, **options) as process:
            try:
                yield process
            except BaseException:
                for child in children(process):
                    with contextlib.suppress(ProcessLookupError):
                        os.kill(child, signal.SIGKILL)
                process.kill()
                raise

    def stop_when(self, happened, what, with_signal, command, wait=0.0, send=subprocess.Popen.send_signal, **options):
        """Starts a program and sends a signal `wait` s after happened(). Returns the exit code and stderr. A run that
        ends before the signal, as it may on a busy machine, is repeated with half the wait, unless it was resumed."""
        for attempt in range(ATTEMPTS):
            if attempt > 0:
                shutil.rmtree(self.folder / command[command.index("-o") + 1], ignore_errors=True)
            with self.started(command, **options) as process:
                wait_until(happened, what, process)
                time.sleep(wait / 2**attempt)
                with contextlib.suppress(ProcessLookupError):
                    send(process, with_signal)
                said = process.communicate(timeout=TIME_LIMIT)[1]
            if process.returncode != 0 or "--resume" in command:
                break
        return process.returncode, said

    def run_and_stop(self, wait, with_signal, started_file, *arguments, program="element_test"):
        """Starts a program and sends a signal `wait` seconds after it has written `started_file` (or found it there,
        if it must not be newer: for a file that resuming leaves alone). Returns the exit code."""
        path, newer = started_file
        begin = time.time() if newer else 0
        command = self.command(program, *arguments, "--no-figures", "--quiet")
        return self.stop_when(lambda: written_since(path, begin), path, with_signal, command, wait)[0]

    def assert_same_results(self, one, other, but=()):
        """All files that results() takes, byte by byte."""
        self.assert_same_contents(*(results(self.folder / name) for name in (one, other)), but)

    def assert_same_folders(self, one, other, but):
        """All files, byte by byte, unless one of these words is in their path."""
        self.assert_same_contents(*({name: data for name, data in contents(self.folder / folder).items()
                                     if not any(word in name for word in but)} for folder in (one, other)))

    def assert_same_contents(self, left, right, but=()):
        self.assertEqual(sorted(left), sorted(right))
        self.assertGreater(len(left), 3)
        different = [name for name, data in left.items() if name not in but and data != right[name]]
        self.assertEqual(different, [])


def contents(folder):
    """All files below a folder with their bytes: to see that nothing has changed."""
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def table(path):
    """Rows of a CSV file, except for times."""
    with open(path, newline="", encoding="utf-8") as file:
        return [{name: cell for name, cell in row.items() if not name.startswith("wall")}
                for row in csv.DictReader(file)]


def columns(path):
    """{name: values} of a CSV file whose cells are numbers, others become nan; headers are `name (unit)`."""
    names = path.read_text(encoding="utf-8").partition("\n")[0].split(",")
    values = np.genfromtxt(path, delimiter=",", skip_header=1, encoding="utf-8").reshape(-1, len(names))
    return {name.split(" (")[0]: values[:, k] for k, name in enumerate(names)}


TIMED = {"provenance.txt", "times.json", "summary.json", "summary.txt"}  # they hold times and calls


def results(path):
    """A file, or contents() of a folder, without times and calls, checkpoints, which may be others, and
    what a campaign keeps next to its runs."""
    if path.is_file():
        return {"": path.read_bytes()}
    left_out = TIMED | {"checkpoint", "queue", "logs"}
    return {name: table(path / name) if name.endswith("resistance.csv") else data
            for name, data in contents(path).items()
            if not name.endswith((".log", ".cpu")) and not left_out & set(pathlib.PurePath(name).parts)}

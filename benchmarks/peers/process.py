# SPDX-License-Identifier: BSD-3-Clause
"""Programs of others: installed where missing, run pinned to cores, their failures made readable."""
import dataclasses
import os
import pathlib
import resource
import subprocess
import time

OTHER_DEBIAN = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "other_debian.sh"
TIME_LIMIT = 3600  # s for one run; a peer that takes longer hangs


class PeerError(Exception):
    """A program crashed, hung or printed nothing that could be read."""


@dataclasses.dataclass
class Output:
    text: str
    cores: float  # processor time over elapsed time: the cores it really had


@dataclasses.dataclass(frozen=True)
class System:
    """The Debian whose packages are run: this one, or another in a folder of its own (scripts/other_debian.sh)."""
    suite: str = ""

    def inside(self, command):
        return [OTHER_DEBIAN, self.suite, *command] if self.suite else command

    def label(self, name):
        return f"{name}@{self.suite}" if self.suite else name

    def asks(self, *command):
        """Standard output of a program, empty if it fails."""
        done = subprocess.run(self.inside(command), capture_output=True, text=True, check=False)
        return done.stdout.strip() if done.returncode == 0 else ""

    def version(self, package):
        return self.asks("dpkg-query", "-W", "-f=${Version}", package)

    def install(self, program, package):
        """Debian's package, when its program does not exist yet."""
        if self.asks("sh", "-c", f"command -v {program}"):
            return
        print(f"installing {self.label(package)}", flush=True)
        root = [] if os.geteuid() == 0 else ["sudo"]
        root += self.inside(["env", "DEBIAN_FRONTEND=noninteractive", "apt-get"])
        for command in (["update", "-q"], ["install", "-q", "-y", "--no-install-recommends", package]):
            try:
                done = subprocess.run(root + command, capture_output=True, text=True)
            except FileNotFoundError as error:
                raise PeerError(f"{package} is not installed, nor is {error.filename} to install it") from error
            if done.returncode != 0:
                raise PeerError(f"apt-get {' '.join(command)} failed:\n{last_lines(done.stdout + done.stderr)}")
        if not self.asks("sh", "-c", f"command -v {program}"):
            raise PeerError(f"package {package} is installed but brings no program {program}")


def last_lines(text, n=12):
    return "\n".join("    " + line for line in text.strip().splitlines()[-n:])


def execute(command, cores, folder):
    """Standard output of a program pinned to `cores`; PeerError with its last lines if it fails."""
    command = ["taskset", "-c", ",".join(map(str, cores))] + [str(word) for word in command]
    environment = dict(os.environ, OMP_NUM_THREADS="1")
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL,
                              cwd=folder, env=environment, timeout=TIME_LIMIT)
    except subprocess.TimeoutExpired as error:
        raise PeerError(f"no end after {TIME_LIMIT} s: {' '.join(command)}") from error
    elapsed, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise PeerError(f"exit code {done.returncode}: {' '.join(command)}\n{last_lines(done.stdout + done.stderr)}")
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Output(done.stdout, used / elapsed)


def under_mpi(command, ranks):
    """The command itself, or under mpirun with that many ranks on the cores it is pinned to."""
    if ranks == 1:
        return command
    root = ["--allow-run-as-root"] if os.geteuid() == 0 else []
    return ["mpirun", *root, "--oversubscribe", "--bind-to", "none", "-np", str(ranks), *command]

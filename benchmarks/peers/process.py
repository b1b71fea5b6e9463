# SPDX-License-Identifier: BSD-3-Clause
"""Programs of others: installed where missing, run pinned to cores, their failures made readable."""
import dataclasses
import os
import resource
import shutil
import subprocess
import time

TIME_LIMIT = 3600  # s for one run; a peer that takes longer hangs


class PeerError(Exception):
    """A program crashed, hung or printed nothing that could be read."""


@dataclasses.dataclass
class Output:
    text: str
    cores: float  # processor time over elapsed time: the cores it really had


def installed_version(package):
    query = subprocess.run(["dpkg-query", "-W", "-f=${Version}", package], capture_output=True, text=True)
    return query.stdout.strip() if query.returncode == 0 else ""


def install(program, package):
    """Debian's package, when its program is not there yet."""
    if shutil.which(program):
        return
    print(f"installing {package}", flush=True)
    root = [] if os.geteuid() == 0 else ["sudo"]
    commands = [["apt-get", "update", "-q"], ["apt-get", "install", "-q", "-y", "--no-install-recommends", package]]
    for command in commands:
        try:
            done = subprocess.run(root + ["env", "DEBIAN_FRONTEND=noninteractive"] + command, capture_output=True,
                                  text=True)
        except FileNotFoundError as error:
            raise PeerError(f"{package} is not installed, and {error.filename} is not there to install it") from error
        if done.returncode != 0:
            raise PeerError(f"{' '.join(command)} failed:\n{last_lines(done.stdout + done.stderr)}")
    if not shutil.which(program):
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

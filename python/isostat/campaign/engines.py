# SPDX-License-Identifier: BSD-3-Clause
"""Where the runs of a campaign are done.   tested: tests/apps/campaign_engines_test.py"""
import concurrent.futures
import contextlib
import importlib
import os
from collections.abc import Iterator

from isostat import _core

ENGINE_TEXT = ("where runs are done: local, processes of this machine (default); mpi, ranks above 0 of mpirun or srun, "
               "which is the default under mpirun; or the address of a Dask scheduler, tcp://HOST:8786 or its file "
               "NAME.json")


def library(name: str, package: str, user: str = "--engine"):
    """A module that only some commands need.   user: which, for the message

    Raises InputError with the package to install
    """
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        raise _core.InputError(f"{user}: Python has no module {error.name}. Install it: apt-get install "
                               f"{package}.") from error


@contextlib.contextmanager
def engine(name: str | None = None, jobs: int = 1) -> Iterator[concurrent.futures.Executor | None]:
    """An executor, closed at the end. With it each run is a process of its own on one thread; results do not depend on it.

    name  "local", "mpi" or the address of a Dask scheduler; None: "mpi" under mpirun with more than one rank, or else
          "local"
    jobs  of "local": runs side by side, 0: as many as the process may use cores

    Ranks above 0 work inside of the `with` statement until rank 0 leaves it, and get None.   Raises InputError
    """
    if name is None:
        name = "mpi" if int(os.environ.get("OMPI_COMM_WORLD_SIZE", "1")) > 1 else "local"
    if name == "local":
        with concurrent.futures.ThreadPoolExecutor(jobs or len(os.sched_getaffinity(0))) as threads:
            yield threads  # each waits for a process
    elif name == "mpi":
        futures = library("mpi4py.futures", "python3-mpi4py")
        with futures.MPICommExecutor() as ranks:
            yield ranks
    elif "://" in name or name.endswith(".json"):
        distributed = library("distributed", "python3-distributed")
        where = {"scheduler_file": name} if name.endswith(".json") else {"address": name}
        try:
            client = distributed.Client(**where, timeout="30 s")
        except (OSError, ValueError) as error:
            raise _core.InputError(f"--engine {name}: no Dask scheduler answers there ({error}). Start one with "
                                   "`dask scheduler`, and workers with `dask worker`.") from error
        with client, client.get_executor(pure=False) as cluster:
            yield cluster
    else:
        raise _core.InputError(f"--engine {name}: is none. Give {ENGINE_TEXT.partition(': ')[2]}.")

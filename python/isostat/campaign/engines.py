# SPDX-License-Identifier: BSD-3-Clause
"""Where the runs of a campaign are done.   tested: tests/apps/campaign_engines_test.py"""
import concurrent.futures
import contextlib
import importlib
import os
import signal
from collections.abc import Iterator

from isostat import _core
from isostat.calls import STOPPING
from isostat.campaign.runs import stop

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
        ranks = os.environ.get("OMPI_COMM_WORLD_SIZE") or os.environ.get("PMI_SIZE") or "1"
        name = "mpi" if int(ranks) > 1 else "local"
    if name == "local":
        with concurrent.futures.ThreadPoolExecutor(jobs or len(os.sched_getaffinity(0))) as threads:
            yield threads  # each waits for a process
    elif name == "mpi":
        futures = library("mpi4py.futures", "python3-mpi4py")
        if library("mpi4py.MPI", "python3-mpi4py").COMM_WORLD.rank > 0:
            for number in (signal.SIGINT, *STOPPING):  # they end its run; rank 0 ends the ranks
                signal.signal(number, lambda *_: stop())
        with futures.MPICommExecutor() as ranks:
            yield ranks
    elif "://" in name or name.endswith(".json"):
        distributed = library("distributed", "python3-distributed")
        if name.endswith(".json") and not os.path.isfile(name):
            raise _core.InputError(f"--engine {name}: does not exist. Give the file of `dask scheduler --scheduler-file "
                                   f"{name}`.")
        where = {"scheduler_file": name} if name.endswith(".json") else {"address": name}
        try:
            client = distributed.Client(**where, timeout="120 s")
        except (OSError, ValueError) as error:
            raise _core.InputError(f"--engine {name}: no Dask scheduler answers there ({error}). Start one with "
                                   "`dask scheduler`, and workers with `dask worker`.") from error
        with client, client.get_executor(pure=False) as cluster:
            yield cluster
    else:
        raise _core.InputError(f"--engine {name}: is not an engine. Give {ENGINE_TEXT.partition(': ')[2]}.")

// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/ranks.hpp"

#include "apps/common/command_line.hpp"
#include "apps/common/interrupt.hpp"
#include "base/error.hpp"
#include "fem/libraries.hpp"
#include "fem/ranks/failure.hpp"

#include <cstdio>
#include <cstdlib>
#include <mpi.h>
#include <unistd.h>

namespace isostat
{
namespace
{
int loud_stderr = 2; ///< a copy of it from before silence_others()

void silence_others()
{
  if (ranks().first())
    return;
  loud_stderr = dup(2);
  if (!std::freopen("/dev/null", "w", stdout) || !std::freopen("/dev/null", "w", stderr))
    throw RunFailure("/dev/null cannot be opened");
}
} // namespace

Ranks ranks()
{
  Ranks r;
  MPI_Comm_rank(MPI_COMM_WORLD, &r.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &r.size);
  return r;
}

int guarded_on_ranks(const std::function<void()> &program)
{
  const Libraries libraries;
  catch_signals(); // after PETSc, which has handlers of its own
  return guarded([&] {
    silence_others();
    program();
  });
}

void on_first_rank(const std::function<void()> &task)
{
  fail_together(MPI_COMM_WORLD, ranks().first() ? failure_of(task) : std::nullopt);
}

void together(const std::function<void()> &task) { fail_together(MPI_COMM_WORLD, failure_of(task)); }

bool on_any_rank(bool here)
{
  if (ranks().size == 1)
    return here;
  int flag = here;
  MPI_Allreduce(MPI_IN_PLACE, &flag, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return flag != 0;
}

bool as_first_rank(bool here)
{
  int flag = here;
  MPI_Bcast(&flag, 1, MPI_INT, 0, MPI_COMM_WORLD);
  return flag != 0;
}

void abort_all(const char *message)
{
  const std::string line = std::string("failed: ") + message + "\n";
  if (write(loud_stderr, line.data(), line.size()) < 0)
    std::perror("stderr");
  MPI_Abort(MPI_COMM_WORLD, 1);
  std::abort();
}
} // namespace isostat

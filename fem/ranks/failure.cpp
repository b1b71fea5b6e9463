// SPDX-License-Identifier: BSD-3-Clause
#include "fem/ranks/failure.hpp"

#include "base/error.hpp"

#include <limits>

namespace isostat
{
std::optional<RankFailure> failure_of(const std::function<void()> &task, std::uint64_t order, const std::string &prefix)
{
  try
    {
      task();
      return std::nullopt;
    }
  catch (const InputError &error)
    {
      return RankFailure{order, prefix + error.what(), true};
    }
  catch (const std::exception &error)
    {
      return RankFailure{order, prefix + error.what(), false};
    }
}

void fail_together(MPI_Comm comm, const std::optional<RankFailure> &here)
{
  constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();
  int rank = 0, size = 1;
  MPI_Comm_size(comm, &size);
  RankFailure failure = here.value_or(RankFailure{none, {}, false});
  if (size > 1)
    {
      MPI_Comm_rank(comm, &rank);
      std::uint64_t first = none;
      MPI_Allreduce(&failure.order, &first, 1, MPI_UINT64_T, MPI_MIN, comm);
      if (first == none)
        return;
      int speaker = failure.order == first ? rank : size;
      MPI_Allreduce(MPI_IN_PLACE, &speaker, 1, MPI_INT, MPI_MIN, comm);
      int said[2] = {static_cast<int>(failure.message.size()), failure.bad_input};
      MPI_Bcast(said, 2, MPI_INT, speaker, comm);
      failure.message.resize(static_cast<std::size_t>(said[0]));
      MPI_Bcast(failure.message.data(), said[0], MPI_CHAR, speaker, comm);
      failure.order = first;
      failure.bad_input = said[1] != 0;
    }
  if (failure.order == none)
    return;
  if (failure.bad_input)
    throw InputError(failure.message);
  throw RunFailure(failure.message);
}
} // namespace isostat

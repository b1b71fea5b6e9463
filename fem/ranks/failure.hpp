// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <functional>
#include <mpi.h>
#include <optional>
#include <string>

namespace isostat
{
/// What went wrong on one rank, before it becomes the failure of all.
struct RankFailure
{
  std::uint64_t order = 0; ///< the failure of lowest order is reported, of equal ones that of the lowest rank
  std::string message;
  bool bad_input = false; ///< of the user's making: an InputError
};

/// What `task` throws; nothing if it throws nothing.   @param prefix  of the message
std::optional<RankFailure> failure_of(const std::function<void()> &task, std::uint64_t order = 0,
                                      const std::string &prefix = "");

/// If any rank has a failure every rank throws it, with the same message.   Collective; a rank alone makes no call but
/// that for their number.
/// @throws InputError, RunFailure
/// tested: tests/mpi/rve_material_mpi.cpp, tests/apps/grain_column_test.py
void fail_together(MPI_Comm comm, const std::optional<RankFailure> &here);
} // namespace isostat

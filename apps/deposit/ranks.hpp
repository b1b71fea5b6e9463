// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/soil_column_resume_test.py
#pragma once
#include <functional>

namespace isostat
{
/// The ranks of MPI_COMM_WORLD in a program of which only the first one writes files and prints.
/// tested: tests/apps/grain_column_test.py
struct Ranks
{
  int rank = 0, size = 1;
  bool first() const { return rank == 0; }
};

Ranks ranks();

/// Runs a program on all ranks as guarded() does (apps/common/command_line.hpp). PETSc reads no option from the command
/// line, signals are ours, and only the first rank is heard on stdout and stderr.   @return its exit code
int guarded_on_ranks(const std::function<void()> &program);

/// `task` on the first rank; the others wait. What it throws is thrown on all ranks.   Collective.
void on_first_rank(const std::function<void()> &task);

/// `task` on every rank, without any call to another one. What it throws on one, the lowest of these, is thrown on all.
/// Collective.
void together(const std::function<void()> &task);

/// True on all ranks if it is on one.   Collective.
bool on_any_rank(bool here);

/// What the first rank says, on all ranks.   Collective.
bool as_first_rank(bool here);

/// Ends all ranks, after `message` on stderr from this rank even if it is silent: for a failure the others cannot see.
[[noreturn]] void abort_all(const char *message);
} // namespace isostat

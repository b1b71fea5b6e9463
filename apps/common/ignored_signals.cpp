// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/system_limits_test.py
// Of each program, not of a library: only programs have functions that run before those of the libraries they load.
#include "apps/common/interrupt.hpp"

namespace isostat
{
namespace
{
std::array<bool, detail::stopping.size()> ignored_at_start;

void note_ignored()
{
  for (std::size_t k = 0; k < ignored_at_start.size(); ++k)
    {
      struct sigaction before = {};
      sigaction(detail::stopping[k], nullptr, &before);
      ignored_at_start[k] = before.sa_handler == SIG_IGN;
    }
}

// What was ignored when the program was started, as by nohup, is so once its libraries are initialized: UCX, which
// Open MPI 5 loads, takes SIGHUP for itself.
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_libraries)() = note_ignored;

[[gnu::constructor]] void ignore_again()
{
  for (std::size_t k = 0; k < ignored_at_start.size(); ++k)
    if (ignored_at_start[k])
      std::signal(detail::stopping[k], SIG_IGN);
}
} // namespace
} // namespace isostat

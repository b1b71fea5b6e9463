// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/kill_resume_test.py
#pragma once
#include <csignal>
#include <initializer_list>

namespace isostat
{
namespace detail
{
inline volatile std::sig_atomic_t stop = 0;
} // namespace detail

/// From here on SIGINT and SIGTERM only raise a flag; the run stops after the step it is in and writes a checkpoint. A
/// second signal ends the program at once.
inline void catch_signals()
{
  for (int signal : {SIGINT, SIGTERM})
    std::signal(signal, [](int caught) {
      detail::stop = 1;
      std::signal(caught, SIG_DFL);
    });
}

inline bool stop_requested() { return detail::stop != 0; }
} // namespace isostat

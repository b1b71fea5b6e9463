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

/// Signals are caught as long as this lives, for a run within a program that has handlers of its own.
/// tested: tests/python/column_test.py
class SignalsCaught
{
public:
  SignalsCaught()
  {
    sigaction(SIGINT, nullptr, &before_[0]);
    sigaction(SIGTERM, nullptr, &before_[1]);
    catch_signals();
  }
  ~SignalsCaught()
  {
    sigaction(SIGINT, &before_[0], nullptr);
    sigaction(SIGTERM, &before_[1], nullptr);
    detail::stop = 0;
  }
  SignalsCaught(const SignalsCaught &) = delete;
  SignalsCaught &operator=(const SignalsCaught &) = delete;

private:
  struct sigaction before_[2] = {};
};
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/kill_resume_test.py
#pragma once
#include <array>
#include <csignal>

namespace isostat
{
namespace detail
{
inline volatile std::sig_atomic_t stop = 0;
inline constexpr std::array stopping = {SIGINT, SIGTERM, SIGUSR1};
} // namespace detail

/// From here on SIGINT, SIGTERM and SIGUSR1 only raise a flag; the run stops after the step it is in and writes a
/// checkpoint. A second signal of the kind ends the program at once. SIGUSR1 is the one that mpirun hands on to the
/// ranks without ending them itself.
inline void catch_signals()
{
  for (int signal : detail::stopping)
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
    for (std::size_t k = 0; k < before_.size(); ++k)
      sigaction(detail::stopping[k], nullptr, &before_[k]);
    catch_signals();
  }
  ~SignalsCaught()
  {
    for (std::size_t k = 0; k < before_.size(); ++k)
      sigaction(detail::stopping[k], &before_[k], nullptr);
    detail::stop = 0;
  }
  SignalsCaught(const SignalsCaught &) = delete;
  SignalsCaught &operator=(const SignalsCaught &) = delete;

private:
  std::array<struct sigaction, detail::stopping.size()> before_ = {};
};
} // namespace isostat

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
inline constexpr std::array stopping = {SIGINT, SIGTERM, SIGUSR1, SIGHUP, SIGXCPU};
inline std::array<struct sigaction, stopping.size()> second = {}; ///< what takes the second signal of each kind
} // namespace detail

/// Those that catch_signals() catches.
inline constexpr const auto &stopping_signals = detail::stopping;

/// What is ignored, as nohup does, stays so.
inline void handle_unless_ignored(int signal, void (*handler)(int))
{
  struct sigaction before = {};
  sigaction(signal, nullptr, &before);
  if (before.sa_handler != SIG_IGN)
    std::signal(signal, handler);
}

/// From here on SIGINT, SIGTERM, SIGUSR1, SIGHUP (a closed terminal) and SIGXCPU (the limit of a queue) only raise a
/// flag; the run stops after the step it is in and writes a checkpoint. A second signal of the kind ends the program at
/// once. SIGUSR1 is the one that mpirun hands on to the ranks without ending them itself.
inline void catch_signals()
{
  const auto note = [](int caught) {
    detail::stop = 1;
    for (std::size_t k = 0; k < detail::second.size(); ++k)
      if (detail::stopping[k] == caught)
        sigaction(caught, &detail::second[k], nullptr);
  };
  for (int signal : detail::stopping)
    handle_unless_ignored(signal, note);
}

inline bool stop_requested() { return detail::stop != 0; }

/// What takes some signals, put back by `restore()` or once this is gone.
template <std::size_t n>
class HandlersKept
{
public:
  explicit HandlersKept(const std::array<int, n> &signals) : signals_(signals)
  {
    for (std::size_t k = 0; k < n; ++k)
      sigaction(signals_[k], nullptr, &before_[k]);
  }
  ~HandlersKept() { restore(); }
  HandlersKept(const HandlersKept &) = delete;
  HandlersKept &operator=(const HandlersKept &) = delete;

  void restore() const
  {
    for (std::size_t k = 0; k < n; ++k)
      sigaction(signals_[k], &before_[k], nullptr);
  }
  const std::array<struct sigaction, n> &before() const { return before_; }

private:
  std::array<int, n> signals_;
  std::array<struct sigaction, n> before_ = {};
};

/// Signals are caught as long as this lives, for a run within a program that has handlers of its own: these take the
/// second signal of a kind.
/// tested: tests/python/column_test.py
class SignalsCaught
{
public:
  SignalsCaught()
  {
    detail::second = kept_.before();
    catch_signals();
  }
  ~SignalsCaught()
  {
    kept_.restore();
    detail::second = {};
    detail::stop = 0;
  }
  SignalsCaught(const SignalsCaught &) = delete;
  SignalsCaught &operator=(const SignalsCaught &) = delete;

private:
  HandlersKept<detail::stopping.size()> kept_{detail::stopping};
};
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/dem/assembly/thread_choice_test.cpp
#pragma once
#include <array>

namespace isostat
{
/// One thread or several, whichever has been faster: a packing may be too small for several, and on a machine that is
/// busy with other work threads wait for each other. The way in use is left for 1/50 of the time, for a trial of the
/// other one, and given up where the other one has been faster by 3 %. Only time depends on it, no result.
///
///     [ one ][ several ][          use, 1 s          ][ trial ][          use, 1 s          ] ...
class ThreadChoice
{
public:
  static constexpr double use_seconds = 1, trial_seconds = 0.02;
  static constexpr long min_steps = 4;

  /// Whether the coming step is for several threads.
  bool several() const { return way(); }

  /// What a step of the present way took, s.
  void add(double seconds)
  {
    seconds_ += seconds;
    const bool is_short = trying_ || mean_[usual_] == 0;
    if (++steps_ < min_steps || seconds_ < (is_short ? trial_seconds : use_seconds))
      return;
    double &mean = mean_[way()];
    const double now = seconds_ / static_cast<double>(steps_);
    mean = trying_ && mean > 0 ? 0.5 * (mean + now) : now; // a trial is short and says less than a time of use
    if (trying_ && mean < 0.97 * mean_[usual_])
      usual_ = !usual_;
    trying_ = !trying_;
    seconds_ = 0;
    steps_ = 0;
  }

private:
  bool way() const { return trying_ != usual_; }

  std::array<double, 2> mean_{}; ///< s per step on one thread and on several; 0: not known yet
  bool usual_ = false, trying_ = false;
  double seconds_ = 0;
  long steps_ = 0;
};
} // namespace isostat

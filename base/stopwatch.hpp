// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>

namespace isostat
{
/// Wall-clock seconds since it was made or restarted. Tested: tests/base/record/progress_test.cpp.
class Stopwatch
{
public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }
  void restart() { begin_ = Clock::now(); }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begin_ = Clock::now();
};

/// Adds the seconds of its own life to a sum.
class TimedScope
{
public:
  explicit TimedScope(double &sum) : sum_(sum) {}
  TimedScope(const TimedScope &) = delete;
  TimedScope &operator=(const TimedScope &) = delete;
  ~TimedScope() { sum_ += watch_.seconds(); }

private:
  double &sum_;
  Stopwatch watch_;
};
} // namespace isostat

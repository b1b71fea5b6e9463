// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/soil_column/history.hpp"

#include <chrono>

namespace isostat
{
/// Progress on stderr: one line every few seconds with percent, rate, ETA and the state.
class ColumnProgress
{
public:
  ColumnProgress(bool quiet, std::uint64_t first_step, double first_fraction)
      : quiet_(quiet), first_step_(first_step), first_fraction_(first_fraction)
  {}
  void say(const std::string &line) const;
  /// Looks at the clock every 64 calls.   @param fraction  of the work done, 0..1
  void tick(std::uint64_t step, double fraction, const ColumnState &state);

private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  std::uint64_t calls_ = 0, first_step_;
  double first_fraction_;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};
} // namespace isostat

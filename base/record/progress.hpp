// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/stopwatch.hpp"

#include <cstdint>
#include <string>

namespace isostat
{
/// A duration as people say it: "42 s", "17 min", "3.1 h".   @param seconds  >= 0
std::string duration_text(double seconds);

/// Progress of a run on stderr: now and then one line with what share of the work is done, the rate, the time that is
/// left and the state of the run.
///
///     if (progress.due(step, fraction))
///       progress.say(progress.line("p' 12.3 kPa"));
///
/// Tested: tests/base/record/progress_test.cpp.
class Progress
{
public:
  /// @param interval  seconds between two lines
  explicit Progress(bool quiet, double interval = 10) : quiet_(quiet), interval_(interval) {}

  /// A line of the caller's own, unless the run is quiet.
  void say(const std::string &line) const;

  /// True once every interval. Cheap enough for every step: looks at the clock every 16 calls.
  /// @param step      counts on, also in a resumed run
  /// @param fraction  of the work done, 0..1; negative: unknown
  bool due(std::uint64_t step, double fraction);

  /// The line that is due: " 42.0 %  step       840       12 1/s  ETA 17 min  STATE". The rate is that since the line
  /// before; the time left follows from the share done since the first call. Both start again when steps or share fall
  /// back, as they do with a new stage. Without a fraction there is no share and no time left.
  std::string line(const std::string &state);

private:
  bool quiet_;
  double interval_;
  std::uint64_t calls_ = 0, step_ = 0, step_of_line_ = 0;
  double fraction_ = -1, first_fraction_ = -1;
  Stopwatch since_line_, since_first_;
};
} // namespace isostat

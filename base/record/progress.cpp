// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/progress.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

namespace isostat
{
std::string duration_text(double s)
{
  return s < 90     ? fmt::format("{:.0f} s", s)
         : s < 5400 ? fmt::format("{:.0f} min", s / 60)
                    : fmt::format("{:.1f} h", s / 3600);
}

void Progress::say(const std::string &line) const
{
  if (!quiet_)
    std::fprintf(stderr, "%s\n", line.c_str());
}

bool Progress::due(std::uint64_t step, double fraction)
{
  if (quiet_ || calls_++ % 16 != 0)
    return false;
  if (calls_ == 1 || step < step_)
    step_of_line_ = step;
  if (calls_ == 1 || fraction < fraction_ || first_fraction_ < 0)
    {
      first_fraction_ = fraction;
      since_first_.restart();
    }
  step_ = step;
  fraction_ = fraction;
  return since_line_.seconds() >= interval_;
}

std::string Progress::line(const std::string &state)
{
  const double since = std::max(since_line_.seconds(), 1e-9), done = fraction_ - first_fraction_;
  std::string line = fraction_ >= 0 ? fmt::format("{:5.1f} %  ", 100 * fraction_) : "";
  line += fmt::format("step {:>9}  {:>7.0f} 1/s", step_, static_cast<double>(step_ - step_of_line_) / since);
  if (fraction_ >= 0 && done > 0)
    line += fmt::format("  ETA {}", duration_text(since_first_.seconds() * (1 - fraction_) / done));
  step_of_line_ = step_;
  since_line_.restart();
  return line + "  " + state;
}
} // namespace isostat

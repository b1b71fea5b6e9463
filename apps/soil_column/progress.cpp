// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/progress.hpp"

#include "apps/common/progress_text.hpp"

#include <cstdio>

namespace isostat
{
namespace
{
constexpr double between_lines = 5; // s
double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }
} // namespace

void ColumnProgress::say(const std::string &line) const
{
  if (!quiet_)
    std::fprintf(stderr, "%s\n", line.c_str());
}

void ColumnProgress::tick(std::uint64_t step, double fraction, const ColumnState &state)
{
  if (quiet_ || ++calls_ % 64 != 0)
    return;
  const Clock::time_point now = Clock::now();
  if (seconds(now - last_) < between_lines)
    return;
  last_ = now;
  const double since = seconds(now - start_), done = fraction - first_fraction_;
  std::string line = fmt::format("{:5.1f} %  step {:>8}  {:>7.0f} steps/s", 100 * fraction, step,
                                 static_cast<double>(step - first_step_) / since);
  if (done > 0)
    line += fmt::format("  ETA {}", duration_text(since * (1 - fraction) / done));
  say(line + fmt::format("   t {:.4g} s  a_surface {:+.3g} m/s2  r_u {:.3f}  p'/p0' {:.3f}", state.time,
                         state.surface_acceleration, state.max_ru, state.min_p_ratio));
}
} // namespace isostat

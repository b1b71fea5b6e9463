// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fmt/format.h>
#include <string>

namespace isostat
{
/// "42 s", "17 min", "3.1 h".
inline std::string duration_text(double s)
{
  return s < 90     ? fmt::format("{:.0f} s", s)
         : s < 5400 ? fmt::format("{:.0f} min", s / 60)
                    : fmt::format("{:.1f} h", s / 3600);
}
} // namespace isostat

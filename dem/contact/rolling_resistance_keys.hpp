// SPDX-License-Identifier: BSD-3-Clause
// Keys that all laws with rolling resistance have, and a table of them behind a law's own.
// tested: tests/dem/scene/scene_test.cpp
#pragma once
#include "base/scene/ranges.hpp"
#include "dem/contact/rolling_resistance.hpp"
#include "dem/law/parameters.hpp"

#include <algorithm>
#include <array>

namespace isostat
{
inline constexpr Range up_to_thousand{0, 1e3, true};

// clang-format off
inline constexpr std::array keys_of_rolling_resistance{
  Key{.path = "friction", .field = member<&RollingResistance::friction>, .unit = unit::deg,
      .presence = Presence::experiment, .value = "18 deg", .range = ranges::right_angle, .reason = ranges::because_tan,
      .text = "Angle of friction between grains while the specimen is tested; left out or 0 deg: frictionless, and "
              "then without rolling and twisting resistance too. Walls are always frictionless."},
  Key{.path = "rolling", .field = member<&RollingResistance::rolling>, .table = true, .presence = Presence::experiment,
      .value = "{ stiffness = 0.3, limit = 0.5 }", .text = "Rolling resistance; left out: none. Needs `friction`."},
  Key{.path = "rolling.stiffness", .field = member<&RollingResistance::rolling_stiffness>, .value = "0.3",
      .range = up_to_thousand,
      .reason = "because zero means no resistance (leave the table out instead), and the time step falls with it",
      .text = "alpha_r: rolling stiffness over R1 R2 ks."},
  Key{.path = "rolling.limit", .field = member<&RollingResistance::rolling_limit>, .value = "0.5",
      .range = ranges::positive, .reason = "because zero means no resistance (leave the table out instead)",
      .text = "eta_r: the rolling moment stays below eta_r min(R1,R2) times the normal force."},
  Key{.path = "twisting", .field = member<&RollingResistance::twisting>, .table = true,
      .presence = Presence::experiment, .value = "{ stiffness = 0.3 }",
      .text = "Twisting resistance, elastic without limit; left out: none. Needs `friction`."},
  Key{.path = "twisting.stiffness", .field = member<&RollingResistance::twisting_stiffness>, .value = "0.3",
      .range = up_to_thousand,
      .reason = "because zero means no resistance (leave the table out instead), and the time step falls with it",
      .text = "alpha_t: twisting stiffness over R1 R2 ks; not given in the paper."},
};
// clang-format on

/// A law's own keys, then those above.
template <std::size_t n>
constexpr auto with_rolling_resistance(const std::array<Key, n> &own)
{
  std::array<Key, n + keys_of_rolling_resistance.size()> all{};
  std::ranges::copy(own, all.begin());
  std::ranges::copy(keys_of_rolling_resistance, all.begin() + n);
  return all;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/balanced.hpp"

#include "base/error.hpp"
#include "base/scene/ranges.hpp"
#include "dem/drive/servo.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t check_interval = 200, min_steps = 1000, hopeless_steps = 20'000'000;
}

Verdict BalancedStage::reached(const StageContext &c, const Observation &) const
{
  const std::uint64_t steps = c.state.place.steps;
  if (steps < min_steps || steps % check_interval != 0)
    return {};
  const bool balanced = on_target(c) && c.assembly.unbalanced_force_ratio() < balance;
  std::uint64_t &checks = c.state.servo.balanced_checks;
  checks = balanced ? checks + 1 : 0;
  if (steps > hopeless_steps)
    throw RunFailure(
        fmt::format("step {}: stage '{}' is not in balance after {} steps (unbalanced {:.3g}, wanted {:.3g})",
                    c.assembly.step(), kind(), steps, c.assembly.unbalanced_force_ratio(), balance));
  return {.finished = checks >= 2};
}

Key BalancedStage::balance_key()
{
  return {.path = "balance",
          .value = "1e-4",
          .range = ranges::fraction,
          .text = "Unbalanced-force ratio at which the stage ends.",
          .field = InStage<&BalancedStage::balance>{}};
}

bool ServoStage::on_target(const StageContext &c) const
{
  return stress_error(c.assembly, target(c), axes()) < stress_tolerance();
}

/// Bound on the strain rate: the approach is fast, the last of the pressure slow.
double ServoStage::rate_cap(const StageContext &c, const Observation &seen) const
{
  return c.servo.compaction_rate * (seen.p < 0.05 * target(c)[0] ? 1.0 : 0.25);
}

RigidBox ServoStage::next_box(const StageContext &c, const Observation &seen) const
{
  return about_centre(c.state, servo_edges(c.assembly, target(c), axes(), rate_cap(c, seen), c.state.servo));
}

Mat3 ServoStage::next_gradient(const StageContext &c, const Observation &seen) const
{
  Eigen::Matrix<bool, 3, 3> controlled = Eigen::Matrix<bool, 3, 3>::Constant(true);
  for (int axis = 0; axis < 3; ++axis)
    controlled(axis, axis) = axes()[axis];
  const Mat3 wanted = (-target(c)).asDiagonal();
  return stress_servo(c.assembly, wanted, controlled, rate_cap(c, seen), c.state.place.steps, c.state.servo);
}

Key ServoStage::pressure_key()
{
  return {.path = "pressure",
          .kind = Kind::quantity,
          .dimension = Dimension::pressure,
          .unit = "kPa",
          .presence = Presence::optional,
          .value = "200 kPa",
          .range = ranges::positive,
          .text =
              "Isotropic pressure of the servo; in k0-compress the vertical effective stress; left out: that of the "
              "specimen.",
          .field = InStage<&ServoStage::pressure>{}};
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/consolidation.hpp"

#include "base/error.hpp"
#include "dem/drive/servo.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::uint64_t check_interval = 200, min_steps = 1000;
}

void Friction::begin(const StageContext &c) const
{
  Law law = c.assembly.law();
  law->friction = friction;
  c.assembly.set_law(law);
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
        fmt::format("step {}: stage '{}' is not in balance after {} steps (unbalanced {:.3g}, requested {:.3g})",
                    c.assembly.step(), kind(), steps, c.assembly.unbalanced_force_ratio(), balance));
  return {.end = checks >= 2 ? std::optional(EndCondition::balance) : std::nullopt};
}

Conditions BalancedStage::conditions(const StageFigures &reached) const
{
  return {{EndCondition::balance, fmt::format("balance = {:g} ({:.3g} reached)", balance, reached.unbalanced)}};
}

Conditions ServoStage::conditions(const StageFigures &reached) const
{
  Conditions both = BalancedStage::conditions(reached);
  both.push_back({EndCondition::balance, fmt::format("stresses within {:g} % of their target ({:.3g} % reached)",
                                                     100 * stress_tolerance(), 100 * reached.stress_error)});
  return both;
}

StageFigures ServoStage::figures(const StageContext &c, const Observation &seen) const
{
  StageFigures now = BalancedStage::figures(c, seen);
  now.stress_error = stress_error(c.assembly, target(c), axes());
  return now;
}

std::optional<double> ServoStage::isotropic_pressure(double standard) const
{
  if (axes() != std::array{true, true, true} || max_steps > 0)
    return std::nullopt;
  return pressure > 0 ? pressure : standard;
}

bool ServoStage::on_target(const StageContext &c) const
{
  return stress_error(c.assembly, target(c), axes()) < stress_tolerance();
}

/// A packing that carries load is brought on slowly.
double ServoStage::rate_share(double reached) const { return reached < 0.05 ? 0.5 : 0.125; }

/// Grains that fly knock at walls and each other long before they carry load: up to half of the pressure may be of
/// impacts, and slowing down for it only lengthens the flight (docs/theory.md, section 7).
double Compress::rate_share(double reached) const
{
  if (!of_cloud)
    return ServoStage::rate_share(reached);
  return reached < 0.5 ? 1.0 : 0.5;
}

double ServoStage::rate_cap(const StageContext &c, const Observation &seen) const
{
  return c.servo.compaction_rate * rate_share(seen.p / target(c)[0]);
}

RigidBox ServoStage::next_box(const StageContext &c, const Observation &seen) const
{
  return c.box_of(servo_edges(c.assembly, target(c), axes(), rate_cap(c, seen), c.state.servo));
}

Mat3 ServoStage::next_gradient(const StageContext &c, const Observation &seen) const
{
  Eigen::Matrix<bool, 3, 3> controlled = Eigen::Matrix<bool, 3, 3>::Constant(true);
  for (int axis = 0; axis < 3; ++axis)
    controlled(axis, axis) = axes()[axis];
  return stress_servo(c.assembly, (-target(c)).asDiagonal(), controlled, rate_cap(c, seen), c.state.place.steps,
                      c.state.servo);
}
} // namespace isostat

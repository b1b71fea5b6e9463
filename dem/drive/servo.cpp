// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/servo.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
Vec3 servo_edges(const Assembly &assembly, const Vec3 &target, const std::array<bool, 3> &controlled, double rate_cap,
                 DriveState &state)
{
  const Vec3 stress = -assembly.wall_stress();
  Vec3 edges = assembly.box().edges();
  for (int axis = 0; axis < 3; ++axis)
    if (controlled[axis])
      {
        const double cap = 0.5 * rate_cap * edges[axis] * assembly.time_step;
        const double missing_force = (target[axis] - stress[axis]) * assembly.box().area(axis);
        const double stiffness = 0.5 * assembly.wall_stiffness_sum(axis);
        const double wanted = stiffness > 0 ? missing_force / stiffness : cap;
        double &step = state.servo_step[axis];
        step = 0.8 * step + 0.2 * std::clamp(wanted, -cap, cap);
        edges[axis] -= 2 * step;
      }
  return edges;
}

Vec3 servo_strain(const Assembly &assembly, const Vec3 &target, const std::array<bool, 3> &controlled, double rate_cap,
                  DriveState &state)
{
  if (std::fmod(state.steps_in_stage, 20) == 0)
    state.servo_modulus = assembly.affine_moduli();
  const Vec3 stress = -assembly.stress().diagonal();
  const double cap = rate_cap * assembly.time_step;
  Vec3 strain = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (controlled[axis])
      {
        const double modulus = state.servo_modulus[axis];
        const double wanted = modulus > 0 ? (target[axis] - stress[axis]) / modulus : cap;
        double &step = state.servo_step[axis];
        step = 0.8 * step + 0.2 * std::clamp(wanted, -cap, cap);
        strain[axis] = -step;
      }
  return strain;
}

double stress_error(const Assembly &assembly, const Vec3 &target, const std::array<bool, 3> &controlled)
{
  const Vec3 stress = -assembly.stress().diagonal();
  double worst = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (controlled[axis])
      worst = std::max(worst, std::abs(stress[axis] / target[axis] - 1));
  return worst;
}
} // namespace isostat

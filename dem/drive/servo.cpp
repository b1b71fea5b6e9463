// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/servo.hpp"

#include <algorithm>

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

double stress_error(const Assembly &assembly, const Vec3 &target)
{
  const Vec3 stress = -assembly.wall_stress();
  return (stress.cwiseQuotient(target) - Vec3::Ones()).cwiseAbs().maxCoeff();
}
} // namespace isostat

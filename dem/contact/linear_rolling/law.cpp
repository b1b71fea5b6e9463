// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/linear_rolling/law.hpp"

namespace isostat
{
double LinearRolling::normal_stiffness(double r1, double r2, double) const { return 2 * young * r1 * r2 / (r1 + r2); }

double LinearRolling::normal_force(double r1, double r2, double overlap) const
{
  return normal_stiffness(r1, r2, overlap) * overlap;
}

double LinearRolling::normal_energy(double, double normal_force, double kn) const
{
  return 0.5 * normal_force * normal_force / kn;
}

WallResponse LinearRolling::wall(double radius, double overlap) const
{
  const double kn = young * radius;
  return {kn * overlap, kn};
}

void LinearRolling::walls(std::span<const WallOverlap> near, std::span<WallResponse> responses) const
{
  for (std::size_t i = 0; i < near.size(); ++i) // a grain without radius has no stiffness: no branch
    responses[i] = wall(near[i].overlap > 0 ? near[i].radius : 0.0, near[i].overlap);
}

double LinearRolling::wall_energy(double radius, double, double normal_force) const
{
  return 0.5 * normal_force * normal_force / (young * radius);
}
} // namespace isostat

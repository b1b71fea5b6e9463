// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/hertz_mindlin/law.hpp"

#include <cmath>

namespace isostat
{
double HertzMindlin::normal_stiffness(double r1, double r2, double overlap) const
{
  return 2 * contact_modulus() * std::sqrt(r1 * r2 / (r1 + r2) * overlap);
}

double HertzMindlin::normal_force(double r1, double r2, double overlap) const
{
  return 2.0 / 3.0 * normal_stiffness(r1, r2, overlap) * overlap;
}

double HertzMindlin::normal_energy(double overlap, double normal_force, double) const
{
  return 0.4 * normal_force * overlap;
}

WallResponse HertzMindlin::wall(double radius, double overlap) const
{
  const double kn = 4 * contact_modulus() * std::sqrt(radius * overlap);
  return {2.0 / 3.0 * kn * overlap, kn};
}

double HertzMindlin::wall_energy(double, double overlap, double normal_force) const
{
  return 0.4 * normal_force * overlap;
}

double HertzMindlin::modulus(double pressure) const
{
  const double overlap = std::pow(std::sqrt(18.0) * pressure / contact_modulus(), 2.0 / 3.0); // u/R
  return contact_modulus() * std::sqrt(2 * overlap);
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/hertz_mindlin/law.hpp"

#include <cmath>

namespace isostat
{
namespace
{
/// a, m.   @param radius  R*, m
double contact_radius(const HertzMindlin &law, double radius, double overlap)
{
  if (law.is_spherical())
    return std::sqrt(radius * overlap);
  return law.asperity * radius * std::pow(overlap / (law.asperity_depth() * radius), law.exponent - 1);
}
} // namespace

double HertzMindlin::asperity_depth() const
{
  const double half_power = 0.5 / (exponent - 1), gamma = std::tgamma(1 + half_power) / std::tgamma(0.5 + half_power);
  return 0.5 * std::sqrt(M_PI) * gamma * asperity * asperity;
}

double HertzMindlin::normal_stiffness(double r1, double r2, double overlap) const
{
  return 2 * contact_modulus() * contact_radius(*this, r1 * r2 / (r1 + r2), overlap);
}

double HertzMindlin::normal_force(double r1, double r2, double overlap) const
{
  return 1 / exponent * normal_stiffness(r1, r2, overlap) * overlap;
}

double HertzMindlin::normal_energy(double overlap, double normal_force, double) const
{
  return 1 / (exponent + 1) * normal_force * overlap;
}

WallResponse HertzMindlin::wall(double radius, double overlap) const
{
  const double kn = 2 * normal_stiffness(radius, radius, 2 * overlap);
  return {1 / exponent * kn * overlap, kn};
}

double HertzMindlin::wall_energy(double, double overlap, double normal_force) const
{
  return normal_energy(overlap, normal_force, 0);
}

double HertzMindlin::modulus(double pressure) const
{
  const double force = 4 * pressure / contact_modulus(); // of two spheres of radius R, fn/(E* R^2)
  if (is_spherical())
    return contact_modulus() * std::sqrt(2 * std::pow(std::sqrt(18.0) * force / 4, 2.0 / 3.0));
  const double depth = 0.5 * asperity_depth(); // over R
  const double overlap = depth * std::pow(exponent * force / (asperity * depth), 1 / exponent);
  return contact_modulus() * asperity * std::pow(overlap / depth, exponent - 1);
}
} // namespace isostat

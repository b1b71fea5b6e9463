// SPDX-License-Identifier: BSD-3-Clause
#include "fem/solve/skeleton_viscosity.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace isostat
{
SkeletonViscosity::SkeletonViscosity(double viscosity, double corner, std::size_t n_points)
    : viscosity_(viscosity), corner_(corner), stresses_(n_points), memory_(n_points)
{
  if (!(viscosity > 0) || !std::isfinite(viscosity))
    throw InputError(fmt::format("viscosity = {} s; must be > 0. Give 1e-4 s, or 0 for none.", viscosity));
  if (!(corner >= 0) || !std::isfinite(corner))
    throw InputError(fmt::format("frequency above which the viscosity acts = {} Hz; must be >= 0", corner));
}

void SkeletonViscosity::set_time_step(double dt)
{
  const double x = std::tan(std::numbers::pi * std::min(corner_ * dt, 0.25));
  gain_ = x / (1 + x);
  keep_ = (1 - x) / (1 + x);
  per_step_ = viscosity_ / dt;
}

void SkeletonViscosity::follow(std::span<const Gradient> increments, std::span<const WaveModuli> moduli)
{
  for (std::size_t q = 0; q < stresses_.size(); ++q)
    {
      std::array<double, 6> fast = strain(increments[q]), &memory = memory_[q];
      for (std::size_t k = 0; k < 6; ++k)
        {
          const double low = gain_ * fast[k] + memory[k];
          memory[k] = gain_ * fast[k] + keep_ * low;
          fast[k] -= low;
        }
      const double shear = per_step_ * moduli[q].s, lame = per_step_ * moduli[q].p - 2 * shear,
                   normal = lame * (fast[0] + fast[1] + fast[2]);
      for (std::size_t k = 0; k < 3; ++k)
        stresses_[q][k] = normal + 2 * shear * fast[k];
      for (std::size_t k = 3; k < 6; ++k)
        stresses_[q][k] = shear * fast[k];
    }
}

void SkeletonViscosity::add(std::span<const Stress> stresses, std::span<Stress> total) const
{
  for (std::size_t q = 0; q < stresses_.size(); ++q)
    for (std::size_t k = 0; k < 6; ++k)
      total[q][k] = stresses[q][k] + stresses_[q][k];
}

double SkeletonViscosity::stable_step(double max_frequency_squared, double viscosity)
{
  return std::sqrt(viscosity * viscosity + 4 / max_frequency_squared) - viscosity;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/packing.hpp"
#include "tests/support/random.hpp"

namespace isostat::test
{
/// Grains of one size within a centimetre of the origin, with velocities of some 1 m/s and spins of some 1,000 rad/s.
inline Packing flying_grains(std::size_t n, unsigned seed)
{
  Random random(seed);
  std::vector<Vec3> centres;
  for (std::size_t i = 0; i < n; ++i)
    centres.emplace_back(1e-2 * random.vector());
  Packing packing = make_packing(centres, std::vector<double>(n, 2e-4), 2650);
  for (std::size_t i = 0; i < n; ++i)
    {
      packing.set_linear_velocity(i, random.vector());
      packing.set_angular_velocity(i, 1000 * random.vector());
    }
  return packing;
}
} // namespace isostat::test

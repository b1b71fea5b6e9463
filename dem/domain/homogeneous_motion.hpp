// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/rigid_box.hpp"

namespace isostat
{
/// The homogeneous motion that the six walls of a box have together: u_k(x) = rate_k x_k + shift_k, the velocity of the
/// lower wall at the lower wall and that of the upper one at the upper.
/// tested: tests/dem/motion/carried_grains_test.cpp, free_grains_test.cpp
struct HomogeneousMotion
{
  alignas(32) double rate[4] = {};  ///< 1/s; the last is 0
  alignas(32) double shift[4] = {}; ///< m/s; the last is 0

  /// Of walls that go from one place to another in a step of dt, s.
  static HomogeneousMotion of_walls(const RigidBox &from, const RigidBox &to, double dt)
  {
    HomogeneousMotion u;
    for (int k = 0; k < 3; ++k)
      {
        const double low = (to.lower[k] - from.lower[k]) / dt, high = (to.upper[k] - from.upper[k]) / dt;
        u.rate[k] = (high - low) / (from.upper[k] - from.lower[k]);
        u.shift[k] = low - u.rate[k] * from.lower[k];
      }
    return u;
  }
  bool operator==(const HomogeneousMotion &) const = default;
  double at(const double *x, int k) const { return rate[k] * x[k] + shift[k]; }
};
} // namespace isostat

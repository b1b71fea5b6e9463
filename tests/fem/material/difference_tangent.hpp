// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"

namespace isostat
{
/// Tangent of a material of one point by central differences of its trial stress, +-d about an increment.
inline Stiffness difference_tangent(Material &material, const Gradient &increment, double d)
{
  constexpr int entry[6] = {0, 4, 8, 5, 2, 1}; // of the gradient: xx, yy, zz, yz, xz, xy
  Stiffness tangent;
  for (int j = 0; j < 6; ++j)
    {
      Gradient more = increment, less = increment;
      more[entry[j]] += d;
      less[entry[j]] -= d;
      Stress high, low;
      material.trial({&more, 1}, {&high, 1});
      material.trial({&less, 1}, {&low, 1});
      for (int k = 0; k < 6; ++k)
        tangent(k, j) = (high[k] - low[k]) / (2 * d);
    }
  return tangent;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/homogeneous_motion.hpp"

namespace isostat
{
/// Carried grains: those of a box share the homogeneous motion u(x) of its walls, as those of a periodic cell do by
/// construction. A leapfrog step is one of what they move besides, and damping acts on that alone,
///
///     v' = v - u_before(x);   leapfrog of v';   v <- v' + u_now(x);   x <- x + dt v
///
/// so that walls which start, stop or turn round accelerate no grain through contacts. Otherwise a packing of edge L
/// whose walls reach the strain rate r within a time T has a stress that differs by rho r L^2 / (8 T) between wall and
/// middle: some 2 % of 200 kPa at 5 1/s and 2,000 grains, which loosens contacts at each load reversal.
/// tested: tests/dem/motion/carried_grains_test.cpp
struct CarriedStep
{
  HomogeneousMotion before, now; ///< u in the step before, and in this one
};
} // namespace isostat

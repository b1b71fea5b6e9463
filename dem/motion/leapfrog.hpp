// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/motion/carried_grains.hpp"
#include "dem/motion/free_grains.hpp"
#include "dem/state/packing.hpp"

namespace isostat
{
/// What one integration step found.
struct MotionReport
{
  double max_speed = 0;    ///< m/s
  bool exploded = false;   ///< a grain moves or spins at no number, or faster than the limit
  double damping_loss = 0; ///< J, only where asked for
  double free_loss = 0;    ///< J that the damping of rattlers takes, only where asked for
  double carried_work = 0; ///< J that carried grains have gained from the walls' homogeneous motion, where asked for
};

/// Homogeneous strain of one step in a periodic cell: x <- x + (A - I) x besides the motion of the grains.
struct AffineStep
{
  explicit AffineStep(const Mat3 &growth)
  {
    for (int k = 0; k < 3; ++k)
      for (int row = 0; row < 3; ++row)
        columns[4 * k + row] = growth(row, k);
  }
  alignas(64) double columns[12] = {}; ///< of A - I, four numbers each, the last 0
};

/// How grains are moved in one step.
struct LeapfrogStep
{
  double dt;                          ///< s
  double damping;                     ///< d [-], [0, 1)
  double speed_limit;                 ///< m/s; a grain with a faster velocity component is reported as exploded
  bool measure_damping = false;       ///< also sum the energy that damping takes, exact: d |F| |v_mid| dt
  const AffineStep *affine = nullptr; ///< of a periodic cell, whose velocities are fluctuations: damping acts on these
                                      ///< alone; nullptr in a box
  const CarriedStep *carried = nullptr; ///< of a box; nullptr: its walls push
  FreeGrainDamping free = {};
};

/// Leapfrog with local (non-viscous) damping for the grains [begin, end), and the clearing of their forces:
///
///     A_i = F_i/m;   A_i <- A_i (1 - d sign[A_i (v_i + dt A_i/2)]);   v <- v + dt A;   x <- x + dt v
///
/// component by component, the same for torque and spin (docs/theory.md). v is the absolute velocity in a box and the
/// fluctuation in a cell; of carried grains it is the velocity against the walls' homogeneous motion (CarriedStep).
/// @param action  [F 0 T 0] per grain, N and N m; zero afterwards
/// cost: 2 x 15 vector operations and 260 bytes of traffic per grain
/// tested: tests/dem/motion/leapfrog_test.cpp
MotionReport integrate(Packing &packing, std::size_t begin, std::size_t end, double *action, const LeapfrogStep &how);
} // namespace isostat

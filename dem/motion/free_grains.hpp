// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isostat
{
/// Damping of rattlers: grains on which neither force nor torque acts, because no contact carries anything and there
/// is no gravity. Local damping does nothing to them, so that they would fly on forever and knock at the packing; in
/// nature gravity and water lay them to rest. In each step, before it,
///
///     v' <- (1 - c) v',   w <- (1 - c) w
///
/// with v' the velocity that local damping acts on: against the homogeneous motion of the walls for carried grains, the
/// fluctuation in a cell, else the absolute one. c = 0.1 takes two thirds of a velocity in ten steps: as long as a
/// collision lasts, too short to cross a pore.
/// cost: one test of a grain's eight force components
/// tested: tests/dem/motion/free_grains_test.cpp
struct FreeGrainDamping
{
  double share = 0; ///< c [-], [0, 1]
};
} // namespace isostat

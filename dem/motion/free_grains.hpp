// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/rigid_box.hpp"

namespace isostat
{
/// Damping of free grains: those on which neither force nor torque acts, because no contact carries anything and there
/// is no gravity. Local damping does nothing to them, so that they would fly on for ever and knock at the packing; in
/// nature gravity and water lay them to rest. In each step, before it,
///
///     v <- u + (1 - c)(v - u),   w <- (1 - c) w
///
/// with u_k = rate_k x_k + shift_k the homogeneous motion that the walls of a box have; 0 in a cell, whose velocities
/// are fluctuations. c = 0.1 takes a velocity in some ten steps: as long as a collision lasts, too short to cross a
/// pore.
/// tested: tests/dem/motion/free_grains_test.cpp
struct FreeGrainDamping
{
  double share = 0;     ///< c [-], [0, 1]
  double rate[3] = {};  ///< 1/s
  double shift[3] = {}; ///< m/s

  /// u of the walls of a box that go from one place to another in a step of dt, s.
  static FreeGrainDamping of_walls(double share, const RigidBox &from, const RigidBox &to, double dt)
  {
    FreeGrainDamping free{share};
    for (int k = 0; k < 3; ++k)
      {
        const double low = (to.lower[k] - from.lower[k]) / dt, high = (to.upper[k] - from.upper[k]) / dt;
        free.rate[k] = (high - low) / (from.upper[k] - from.lower[k]);
        free.shift[k] = low - free.rate[k] * from.lower[k];
      }
    return free;
  }

  /// Damps one grain.   @param x, v, w  its records: position; velocity and 1/m; spin and 1/J   @return J that it loses
  double damp(const double *x, double *v, double *w) const
  {
    double loss = 0;
    for (int k = 0; k < 3; ++k)
      {
        const double u = rate[k] * x[k] + shift[k];
        const double v_new = u + (1 - share) * (v[k] - u), w_new = (1 - share) * w[k];
        loss += 0.5 * ((v[k] * v[k] - v_new * v_new) / v[3] + (w[k] * w[k] - w_new * w_new) / w[3]);
        v[k] = v_new;
        w[k] = w_new;
      }
    return loss;
  }
};
} // namespace isostat

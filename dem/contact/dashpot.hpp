// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>

namespace isostat
{
/// c = 2 beta sqrt(m* kn), N s/m: see dashpot_force().
inline double dashpot_coefficient(double beta, double kn, double m1, double m2)
{
  return 2 * beta * std::sqrt(kn * m1 * m2 / (m1 + m2));
}

/// Viscous damping of contacts: a dashpot along the normal, next to the spring of any law. With v_n = n . (v2 - v1) the
/// rate at which two grains part, kn the stiffness of the law and m* = m1 m2/(m1 + m2),
///
///     F_n = fn - min(c v_n, fn),   c = 2 beta sqrt(m* kn)
///
/// No contact pulls, and limits of friction and rolling go by the elastic fn. beta is the share of critical damping at
/// which two single grains collide; they part with the restitution
///
///     e = exp[ -(beta/w) (pi - atan2(2 beta w, 1 - 2 beta^2)) ],   w = sqrt(1 - beta^2)
///
/// of their speed (Schwager and Poeschel, Granular Matter 9, 2007, linear spring): 0.86 at beta = 0.05. It acts between
/// grains that move against each other, and not, as local damping does, on what moves together: a packing that gives
/// way as a whole is not held back. Walls have none.
/// @param beta  [-]   @param kn  N/m   @param m1, m2  kg   @param fn  N   @param speed  v_n, m/s
/// @return fn - F_n, N
/// cost in the loop: 17 vector operations of some 310; none where beta is 0
/// tested: tests/dem/contact/dashpot_test.cpp, loop_test.cpp
inline double dashpot_force(double beta, double kn, double m1, double m2, double fn, double speed)
{
  return std::min(dashpot_coefficient(beta, kn, m1, m2) * speed, fn);
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/vector.hpp"
#include "fem/solve/energy.hpp"

#include <array>
#include <functional>

namespace isostat
{
/// What makes steps of statics steps of a motion: docs/theory_column.md (13a) and (13b).
struct NodalInertia
{
  double spectral_radius = 0.8; ///< rho_inf, in [0, 1]: part of a vibration far above 1/dt that a step leaves
  Vector mass, damping;         ///< diagonals of M and C, of each owned displacement: kg, kg/s
  std::function<void(double time, Vector &force)> add_load;                 ///< besides tractions, N
  std::function<std::array<double, 3>(double time)> base_acceleration = {}; ///< that displacements count from, m/s2
};

/// How nodes move at the end of a sub-step.
struct NodalMotion
{
  Vector velocity, velocity_increment; ///< m/s; of the sub-step
  Vector acceleration;                 ///< of (13a), m/s2: of a moment (alpha_m - alpha_f) dt from the end
  Vector imbalance;                    ///< R of (13b), N; over the mass it is the acceleration at the end
  DynamicsEnergy energy = {};          ///< of this rank
};

/// Coefficients of (13a) and (13b): second order, and the least damping of slow vibrations that the radius allows
/// (Chung & Hulbert 1993, doi:10.1115/1.2900803).   tested: tests/verification/implicit_dynamics_test.cpp
struct GeneralisedAlpha
{
  explicit GeneralisedAlpha(double radius)
      : m((2 * radius - 1) / (radius + 1)), f(radius / (radius + 1)), beta((1 - m + f) * (1 - m + f) / 4),
        gamma(0.5 - m + f)
  {}

  /// Newmark's velocity and acceleration at the end of a sub-step with an increment of displacement (13a).
  void move(const Vector &increment, double duration, const NodalMotion &from, NodalMotion &to) const
  {
    const double dt = duration;
    for (std::size_t i = 0; i < increment.locally_owned_size(); ++i)
      {
        const double v = from.velocity.local_element(i), a = from.acceleration.local_element(i),
                     now = (increment.local_element(i) - dt * v) / (beta * dt * dt) - (0.5 / beta - 1) * a;
        to.acceleration.local_element(i) = now;
        to.velocity_increment.local_element(i) = dt * ((1 - gamma) * a + gamma * now);
        to.velocity.local_element(i) = v + to.velocity_increment.local_element(i);
      }
  }

  double m, f, beta, gamma; ///< alpha_m, alpha_f, Newmark's beta and gamma
};
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/solve/dynamics.hpp"

namespace isostat
{
/// A column at one instant. Unknowns are those this rank owns, points its own.
struct ColumnInstant
{
  std::uint64_t step = 0;
  double time = 0;                                          ///< s
  std::vector<double> displacement, velocity, acceleration; ///< as the unknown counts (from a rigid base), m, m/s, m/s2
  std::vector<Gradient> gradients;                          ///< of the whole displacement [-]
  std::vector<Stress> stresses;                             ///< effective, tension positive, Pa
  std::vector<double> pressure;                             ///< excess pore pressure at the points, Pa
  DynamicsEnergy energy;                                    ///< of the whole mesh, J
};

/// Makes one time step and returns the state at its start, t_n, all of it at that instant. Dynamics holds quantities
/// of different instants after a step: displacement and stress (and from it the pressure of an undrained column) of
/// t_n are those before the step; acceleration, pressure of u-p and energy of t_n are known after it; the velocity of
/// t_n is the mean of those half a step before and after, at the start the given one. Collective.
/// @throws RunFailure from Dynamics::step()
/// tested: tests/apps/soil_column_test.py
void observe_step(Dynamics &run, const FiniteElementSpace &space, ColumnInstant &instant);

/// Displacement gradients at the points of a vector of displacements, whatever its ghosts hold.
void gradients_of(const FiniteElementSpace &space, const Vector &displacement, std::vector<Gradient> &gradients);
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/linear_solver.hpp"
#include "fem/space/discretisation.hpp"
#include "fem/water/pore_fluid.hpp"

namespace isostat
{
/// The pore pressure of a time step where air in the water follows Boyle's law: docs/theory_column.md (30). In place of
/// S (3p - 4p' + p'')/(2 dt), linear, the water's equation (5) has
///
///     int N_i (3 Theta(p) - 4 Theta(p') + Theta(p''))/(2 dt)                           Theta: PoreFluid::volume()
///
/// with Theta at the pressures of the points, so that water and air are conserved whatever the step. Newton's method:
/// Theta is concave, so that from the second iteration on the pressure rises to the solution. Each iteration has a new
/// matrix, which is factorised again; what is found depends on p', p'' and the right-hand side alone.
/// tested: tests/fem/water/air_pressure_test.cpp
class AirPressure
{
public:
  /// @param linear  H + (G/2 + L/dt) D G^T with room for S; rows of held pressures are those of the identity
  /// @param solver  must outlive this   @param held  owned unknowns with p = 0   @param volumes  of the points, m3
  AirPressure(const FiniteElementSpace &space, std::vector<double> volumes, double time_step, PetscMatrix linear,
              LinearSolver &solver, const std::vector<unsigned> &held);

  /// p of linear p + int N_i (...)/(2 dt) = b.   @throws RunFailure  no solution in 50 iterations
  void solve(const Vector &b, const Vector &before, const Vector &before_that, Vector &p);

private:
  void find_residual(const Vector &b, const Vector &p);
  void find_tangent(const Vector &p);

  const FiniteElementSpace &space_;
  std::vector<double> volumes_;
  double two_steps_;
  std::vector<PoreFluid> fluids_; ///< of each point
  PetscMatrix linear_, tangent_;
  LinearSolver &solver_;       ///< of the tangent
  Vector held_;                ///< 1 at held unknowns, also those of other ranks
  std::vector<double> before_; ///< 4 Theta(p') - Theta(p'') at the points
  Vector residual_, change_;
  PetscView of_p_, of_residual_;
};
} // namespace isostat

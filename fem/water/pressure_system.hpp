// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/linear_effort.hpp"
#include "fem/space/discretisation.hpp"

namespace isostat
{
/// The implicit pore pressure of u-p dynamics: docs/theory_column.md (4) to (8). With the water's equation
///
///     G (v+ + v-)/2 + S (3p - 4p' + p'')/(2 dt) + H p + L (v+ - v-)/dt + L a_base = 0
///     G_iA = int N_i div N_A              S_ij = int N_i N_j / Q
///     H_ij = int kb grad N_i . grad N_j   L_iA = int kb rho_f grad N_i . N_A
///
/// and the momentum update v+ = v* + D G^T p with a diagonal D, the pressure solves
///
///     (3S/(2 dt) + H + (G/2 + L/dt) D G^T) p
///         = S (4p' - p'')/(2 dt) - (G/2 + L/dt) v* - (G/2 - L/dt) v- - L a_base
///
/// p is excess pressure, compression positive, Pa; v in m/s. The matrix is constant: assembled and factorised once by
/// PETSc, LU of its own on one rank (natural order in a column, which is banded; else nested dissection), MUMPS on
/// several, unless options that begin with -water_ say otherwise (LinearSolver); the matrix is not symmetric. A step
/// costs one pair of triangular solves and four products. Biot's coefficient is 1 (rigid grains). Where
/// air follows Boyle's law, S is not constant: AirPressure. Where the permeability follows the
/// void ratio or cells move, Dynamics makes another system from time to time.
/// tested: tests/fem/water/pressure_system_test.cpp
class PressureSystem
{
public:
  /// @param update  D: v+ per unit force, for each displacement unknown (0 where it is fixed)
  /// @param at      the cells: the space, or where they have moved
  /// @param volume_strains  of the points, that permeability and storage are of; empty: in situ
  PressureSystem(const FiniteElementSpace &space, const CellGeometry &at, double time_step, const Vector &update,
                 std::span<const double> volume_strains, const std::string &options);
  ~PressureSystem();

  /// p from v* and what came before.  @param base_acceleration  constant over the mesh, m/s2
  /// @param inflow  added to the right-hand side: water that comes in over the boundary, m3/s; null: none
  void solve(const Vector &v_star, const Vector &v_before, const Vector &p_before, const Vector &p_before_that,
             const std::array<double, 3> &base_acceleration, const Vector *inflow, Vector &p) const;
  /// f = G^T p, N.
  void force(const Vector &p, Vector &f) const;
  LinearEffort effort() const; ///< of iterations

private:
  struct Matrices;
  std::unique_ptr<Matrices> matrices_;
};
} // namespace isostat

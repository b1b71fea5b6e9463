// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/linear_effort.hpp"
#include "fem/solve/statics/mixed_vector.hpp"
#include "fem/water/biot_integrals.hpp"

struct _p_KSP; // PETSc's, as the next one
struct _p_MatNullSpace;

namespace isostat
{
/// The linear system of a Newton step of statics, symmetric for a symmetric tangent: docs/theory_column.md (16).
///
///     [  K     -G^T        ] [du]   [r_u]      K = int B^T C B
///     [ -G   -(S + theta H)] [dp] = [r_p]      theta: time step over the leading coefficient of BDF, s
///
/// without the second row if there is no pore water. Pressures are scaled by a modulus, so that both rows are of one
/// size. Assembled by PETSc, factorised by MUMPS (LU: the tangent of a soil need not be symmetric) on any number of
/// ranks unless options that begin with -statics_ say otherwise (LinearSolver); a split of displacements and pressures
/// has (16a) in place of the Schur complement. Held unknowns take given increments.
/// The factor is kept as long as tangent, theta and held unknowns are the same numbers.
/// tested: tests/fem/solve/statics_test.cpp
class StaticsSystem
{
public:
  /// @param water  null: no pore water; must outlive this   @param pressure_scale  Pa, about the skeleton's modulus
  /// @param moves   there will be inertia: the LU of a column is PETSc's own
  StaticsSystem(const FiniteElementSpace &space, const BiotOperator *water, double pressure_scale,
                const std::string &options = {}, bool moves = false);
  ~StaticsSystem();

  /// Owned unknowns that are held from now on; others that no cell has are so anyway.
  void hold(const std::vector<unsigned> &displacements, const std::vector<unsigned> &pressures);
  /// @throws RunFailure  the tangent is singular: a body that moves freely, or a soil without stiffness
  void set_tangent(std::span<const Stiffness> tangents, double theta);
  void forget_tangent(); ///< the water has changed
  /// (13b): adds to the diagonal of K, N/m; L counts a velocity of so much per displacement, 1/s.
  void set_inertia(const Vector &diagonal, double velocity);

  /// Increments of a residual (N; m3), and of the increments that `step` has at held unknowns when called.
  /// @param moved  what the residual loses by the held increments alone
  void solve(const MixedVector &residual, MixedVector &step, MixedVector &moved) const;

  LinearEffort effort() const; ///< of iterations

  /// r_p counts in a residual as this force, N/m3: pressure scale over the size of a cell.
  double force_per_volume() const;

private:
  struct Matrices;
  void number_unknowns();
  void rows_of(std::size_t cell, std::vector<int> &rows, std::vector<int> &schur) const;
  void preallocate(int block);
  void assemble(std::span<const Stiffness> tangents, double theta);
  void factorise();
  void tell_structure(_p_KSP *ksp) const;
  _p_MatNullSpace *rigid_motions() const;
  void load(MixedVector &x, double p_factor) const;
  void unload(MixedVector &x, double p_factor) const;

  const FiniteElementSpace &space_;
  std::unique_ptr<Matrices> matrices_;
};
} // namespace isostat

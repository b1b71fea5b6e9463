// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/linear_effort.hpp"
#include "fem/linear/petsc.hpp"

#include <functional>
#include <petscksp.h>
#include <string>
#include <vector>

namespace isostat
{
/// The direct solution of a system whose options say nothing else.
struct DirectSolver
{
  MatSolverType package;                           ///< MATSOLVERPETSC, MATSOLVERMUMPS
  MatOrderingType ordering = nullptr;              ///< null: the package's own
  std::vector<std::array<PetscInt, 2>> icntl = {}; ///< controls of MUMPS: number, value
};

/// Solver of a linear system: PETSc's KSP, which reads the options of its prefix ("-water_ksp_type gmres -water_pc_type
/// hypre"); without any a direct solution by LU, whose factor is applied without a detour. Iterations end at 1e-10 of
/// the right-hand side unless the options say otherwise. No other solver of the process sees the options. A matrix with
/// other values must have the pattern of the first one.   tested: tests/fem/solve/statics_ranks_test.cpp
class LinearSolver
{
public:
  /// @param prefix   "water_": that of the system   @param options  of this and of other systems; empty: the direct one
  /// @param prepare  called once, before the options are read; may be empty
  /// @param split_blocks  options of a split (pc_type fieldsplit) that the user's replace
  LinearSolver(MPI_Comm communicator, std::string prefix, const std::string &options, DirectSolver direct,
               std::function<void(KSP)> prepare = {}, const std::string &split_blocks = {});
  ~LinearSolver();
  LinearSolver(LinearSolver &&other) noexcept;

  /// Factorises it, or sets up the preconditioner; keeps the matrix.
  /// @throws RunFailure  it is singular, or no preconditioner could be made of it
  /// @throws InputError  an option of this prefix that PETSc does not know or that nothing has read, with its name
  void set_matrix(Mat matrix);
  /// Solves for `out`, from 0 where it iterates.
  /// @throws RunFailure  the iteration has not converged: PETSc's reason (KSPConvergedReason), iterations, residual
  void solve(Vec in, Vec out);

  bool splits() const; ///< pc_type fieldsplit
  const LinearEffort &effort() const { return effort_; }

private:
  struct Parts;

  void read_options();
  void refuse_no_solution(const std::string &method, const std::string &preconditioner) const;
  void refuse_unused();

  std::unique_ptr<Parts> parts_;
  LinearEffort effort_;
};
} // namespace isostat

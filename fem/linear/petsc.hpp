// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/vector.hpp"

#include <memory>
#include <petscmat.h>
#include <type_traits>
#include <vector>

namespace isostat
{
/// PETSc's matrices and vectors as values that clean up after themselves. Only the files of the linear systems see this
/// header: those of their solver, of fem/water's pressures and fem/solve/statics/system.cpp.
/// tested: tests/fem/water/pressure_system_test.cpp, tests/fem/solve/statics_test.cpp

/// @throws RunFailure  PETSc reports an error
void petsc_check(PetscErrorCode code);

struct PetscDestroy
{
  void operator()(Mat matrix) const { MatDestroy(&matrix); }
  void operator()(Vec vector) const { VecDestroy(&vector); }
  void operator()(MatNullSpace space) const { MatNullSpaceDestroy(&space); }
};
using PetscMatrix = std::unique_ptr<std::remove_pointer_t<Mat>, PetscDestroy>;
using PetscVector = std::unique_ptr<std::remove_pointer_t<Vec>, PetscDestroy>;
using PetscNullSpace = std::unique_ptr<std::remove_pointer_t<MatNullSpace>, PetscDestroy>;

/// Entries (row, column, value; numbers over all ranks) that add up.
struct PetscEntries
{
  std::vector<PetscInt> rows, columns;
  std::vector<double> values;

  void add(PetscInt row, PetscInt column, double value);
};

/// The sparse matrix of some entries; values of an entry that is named several times are added in that order.
/// @param n_rows, n_columns  owned by this rank
PetscMatrix petsc_matrix(MPI_Comm communicator, std::size_t n_rows, std::size_t n_columns, PetscEntries &entries);

/// The pattern of a sparse matrix of dense blocks, one of each cell, and of its whole diagonal.
class PetscPattern
{
public:
  /// @param n_owned, block  rows of this rank; those that belong to one node
  PetscPattern(MPI_Comm communicator, std::size_t n_owned, PetscInt block = 1);
  void add(const std::vector<PetscInt> &rows); ///< and columns of a block
  PetscMatrix matrix();                        ///< that takes these entries   Collective.

private:
  PetscMatrix pattern_, matrix_;
};

/// PETSc's name for the owned values of a Vector, without a copy.
class PetscView
{
public:
  PetscView(MPI_Comm communicator, std::size_t n_owned);
  /// @pre released since the last call; `ours` outlives the use
  Vec of(const Vector &ours) const;
  Vec vec() const { return vec_.get(); } ///< of the vector that of() was called with last
  void release() const;

private:
  PetscVector vec_;
};
} // namespace isostat

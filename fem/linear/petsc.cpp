// SPDX-License-Identifier: BSD-3-Clause
#include "fem/linear/petsc.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

namespace isostat
{
void petsc_check(PetscErrorCode code)
{
  if (!code)
    return;
  const char *text = nullptr;
  PetscErrorMessage(code, &text, nullptr);
  throw RunFailure(fmt::format("linear system: PETSc error {}: {}", static_cast<int>(code), text));
}

void PetscEntries::add(PetscInt row, PetscInt column, double value)
{
  rows.push_back(row);
  columns.push_back(column);
  values.push_back(value);
}

namespace
{
PetscMatrix new_matrix(MPI_Comm communicator, std::size_t n_rows, std::size_t n_columns, PetscInt block, MatType type)
{
  Mat matrix = nullptr;
  petsc_check(MatCreate(communicator, &matrix));
  PetscMatrix owner(matrix);
  petsc_check(MatSetSizes(matrix, static_cast<PetscInt>(n_rows), static_cast<PetscInt>(n_columns), PETSC_DETERMINE,
                          PETSC_DETERMINE));
  petsc_check(MatSetBlockSize(matrix, block));
  petsc_check(MatSetType(matrix, type));
  return owner;
}
} // namespace

PetscMatrix petsc_matrix(MPI_Comm communicator, std::size_t n_rows, std::size_t n_columns, PetscEntries &entries)
{
  PetscMatrix matrix = new_matrix(communicator, n_rows, n_columns, 1, MATAIJ);
  petsc_check(MatSetPreallocationCOO(matrix.get(), entries.rows.size(), entries.rows.data(), entries.columns.data()));
  petsc_check(MatSetValuesCOO(matrix.get(), entries.values.data(), INSERT_VALUES));
  return matrix;
}

PetscPattern::PetscPattern(MPI_Comm communicator, std::size_t n_owned, PetscInt block)
    : pattern_(new_matrix(communicator, n_owned, n_owned, block, MATPREALLOCATOR)),
      matrix_(new_matrix(communicator, n_owned, n_owned, block, MATAIJ))
{
  petsc_check(MatSetUp(pattern_.get()));
  PetscInt row = 0, end = 0;
  petsc_check(MatGetOwnershipRange(pattern_.get(), &row, &end));
  for (; row < end; ++row)
    add({row});
}

void PetscPattern::add(const std::vector<PetscInt> &rows)
{
  const auto n = static_cast<PetscInt>(rows.size());
  petsc_check(MatSetValues(pattern_.get(), n, rows.data(), n, rows.data(), nullptr, INSERT_VALUES));
}

PetscMatrix PetscPattern::matrix()
{
  petsc_check(MatAssemblyBegin(pattern_.get(), MAT_FINAL_ASSEMBLY));
  petsc_check(MatAssemblyEnd(pattern_.get(), MAT_FINAL_ASSEMBLY));
  petsc_check(MatPreallocatorPreallocate(pattern_.get(), PETSC_FALSE, matrix_.get()));
  return std::move(matrix_);
}

PetscView::PetscView(MPI_Comm communicator, std::size_t n_owned)
{
  Vec vec = nullptr;
  petsc_check(VecCreateMPIWithArray(communicator, 1, n_owned, PETSC_DETERMINE, nullptr, &vec));
  vec_.reset(vec);
}

Vec PetscView::of(const Vector &ours) const
{
  petsc_check(VecPlaceArray(vec_.get(), const_cast<double *>(ours.begin())));
  return vec_.get();
}

void PetscView::release() const { petsc_check(VecResetArray(vec_.get())); }
} // namespace isostat

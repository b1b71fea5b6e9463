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

PetscMatrix petsc_matrix(MPI_Comm communicator, std::size_t n_rows, std::size_t n_columns, PetscEntries &entries,
                         PetscInt block)
{
  Mat matrix = nullptr;
  petsc_check(MatCreate(communicator, &matrix));
  PetscMatrix owner(matrix);
  petsc_check(MatSetSizes(matrix, n_rows, n_columns, PETSC_DETERMINE, PETSC_DETERMINE));
  petsc_check(MatSetBlockSize(matrix, block));
  petsc_check(MatSetType(matrix, MATAIJ));
  petsc_check(MatSetPreallocationCOO(matrix, entries.rows.size(), entries.rows.data(), entries.columns.data()));
  petsc_check(MatSetValuesCOO(matrix, entries.values.data(), INSERT_VALUES));
  return owner;
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

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/linear/petsc.hpp"
#include "fem/water/biot_integrals.hpp"

namespace isostat
{
/// G, L, S and H of docs/theory_column.md (7), of all cells of this rank, as entries of sparse matrices over all ranks:
/// rows are pressures; columns displacements (G, L, the same entries) or pressures (S, H; every diagonal one,
/// of S also for unknowns that no cell has).   tested: tests/fem/water/pressure_system_test.cpp
struct BiotEntries
{
  PetscEntries g, l, s, h;
  std::size_t n_pressures = 0, n_displacements = 0; ///< owned by this rank
  MPI_Comm communicator = MPI_COMM_SELF;

  BiotEntries(const FiniteElementSpace &space, const std::vector<PorousLayer> &layers);

  PetscMatrix coupling(double a, double b) const; ///< a G + b L
  PetscMatrix to_force() const;                   ///< G^T
  PetscMatrix storage(double divisor) const;      ///< S / divisor
  PetscMatrix seepage() const;                    ///< H
};
} // namespace isostat

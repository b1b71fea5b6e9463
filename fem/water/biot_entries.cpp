// SPDX-License-Identifier: BSD-3-Clause
#include "fem/water/biot_entries.hpp"

#include <utility>

namespace isostat
{
BiotEntries::BiotEntries(const FiniteElementSpace &space, const std::vector<PorousLayer> &layers)
    : communicator(space.communicator())
{
  const Vector u = space.displacement_vector(), p = space.pressure_vector();
  n_displacements = u.locally_owned_size();
  n_pressures = p.locally_owned_size();
  const std::size_t n_u = 3 * space.n_nodes, n_i = space.pressure_nodes_per_cell();
  for (std::size_t cell = 0; cell < space.n_cells(); ++cell)
    {
      const BiotCell c = biot_cell(space, layers[space.cell_layer[cell]], cell);
      for (std::size_t i = 0; i < n_i; ++i)
        {
          const PetscInt row = p.global_index(space.cell_pressures[cell * n_i + i]);
          for (std::size_t j = 0; j < n_i; ++j)
            {
              const PetscInt column = p.global_index(space.cell_pressures[cell * n_i + j]);
              s.add(row, column, c.s(i, j));
              h.add(row, column, c.h(i, j));
            }
          for (std::size_t k = 0; k < n_u; ++k)
            if (c.g(i, k) != 0 || c.l(i, k) != 0)
              {
                const PetscInt column = u.global_index(space.cell_dofs[cell * n_u + k]);
                g.add(row, column, c.g(i, k));
                l.add(row, column, c.l(i, k));
              }
        }
    }
  for (std::size_t i = 0; i < n_pressures; ++i)
    s.add(p.first_owned() + i, p.first_owned() + i, 0);
}

PetscMatrix BiotEntries::coupling(double a, double b) const
{
  PetscEntries sum = g;
  for (std::size_t k = 0; k < sum.values.size(); ++k)
    sum.values[k] = a * g.values[k] + b * l.values[k];
  return petsc_matrix(communicator, n_pressures, n_displacements, sum);
}

PetscMatrix BiotEntries::to_force() const
{
  PetscEntries transposed = g;
  std::swap(transposed.rows, transposed.columns);
  return petsc_matrix(communicator, n_displacements, n_pressures, transposed);
}

PetscMatrix BiotEntries::storage(double divisor) const
{
  PetscEntries scaled = s;
  for (double &value : scaled.values)
    value /= divisor;
  return petsc_matrix(communicator, n_pressures, n_pressures, scaled);
}

PetscMatrix BiotEntries::seepage() const
{
  PetscEntries entries = h;
  return petsc_matrix(communicator, n_pressures, n_pressures, entries);
}
} // namespace isostat

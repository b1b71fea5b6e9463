// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/material.hpp"
#include "fem/space/tables.hpp"

namespace isostat
{
/// Integrals over the cells of a mesh that a time step needs, on bare numbers: `u`, `f` have one entry for each local
/// displacement unknown (CellTables::cell_dofs).   tested: tests/fem/space/discretisation_test.cpp (patch tests)

/// Displacement gradients h_cd = factor sum_A u_Ac dN_A/dx_d at every point, along the axes that are meshed; the other
/// entries of `out` stay as they are.   @param out  n_points()      cost: in the loop
template <int dim>
void find_gradients(const CellTables &tables, const double *u, double factor, Gradient *out);

/// f_Ac += int sigma_cd dN_A/dx_d, the internal force of effective stresses (N).   @param stresses  n_points()
/// cost: in the loop
template <int dim>
void add_stress_divergence(const CellTables &tables, const Stress *stresses, double *f);

/// B of a point: strain (as strain() orders it, shear as gamma) per displacement of its cell's nodes, 6 rows, columns
/// [node][3], 1/m.   tested: tests/fem/solve/statics_test.cpp (patch tests)
template <int dim>
void strain_matrix(const CellTables &tables, std::size_t point, Eigen::Matrix<double, 6, Eigen::Dynamic> &b)
{
  for (std::size_t a = 0; a < tables.n_nodes; ++a)
    {
      std::array<double, 3> g = {0, 0, 0};
      for (int d = 0; d < dim; ++d)
        g[mesh_axes<dim>[d]] = tables.gradient[(point * tables.n_nodes + a) * dim + d];
      b.template middleCols<3>(3 * a) << g[0], 0, 0, 0, g[1], 0, 0, 0, g[2], 0, g[2], g[1], g[2], 0, g[0], g[1], g[0],
          0;
    }
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/axes.hpp"

namespace isostat
{
/// B of a point: strain (as strain() orders it, shear as gamma) per displacement of its cell's nodes, 6 rows, columns
/// [node][3], 1/m.   tested: tests/fem/solve/statics_test.cpp (patch tests)
template <int dim>
void strain_matrix(const Discretisation<dim> &space, std::size_t point, Eigen::Matrix<double, 6, Eigen::Dynamic> &b)
{
  const std::size_t n_a = space.nodes_per_cell();
  for (std::size_t a = 0; a < n_a; ++a)
    {
      std::array<double, 3> g = {0, 0, 0};
      for (int d = 0; d < dim; ++d)
        g[mesh_axes<dim>[d]] = space.gradient[(point * n_a + a) * dim + d];
      b.template middleCols<3>(3 * a) << g[0], 0, 0, 0, g[1], 0, 0, 0, g[2], 0, g[2], g[1], g[2], 0, g[0], g[1], g[0],
          0;
    }
}
} // namespace isostat

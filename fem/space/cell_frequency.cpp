// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/tables.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
/// Nodal volumes of a cell.
const double *shares(const CellTables &t, std::size_t cell)
{
  return &(t.bound_share.empty() ? t.nodal_share : t.bound_share)[cell * t.n_nodes];
}

/// Stiffness of a skeleton with rho V_p^2 = 1 Pa and rho V_s^2 = shear Pa for one cell, divided by its nodal volumes on
/// both sides (square roots): its eigenvalues are omega^2 at a density of 1 kg/m3.
Eigen::MatrixXd scaled_stiffness(const CellTables &t, const CellGeometry &at, std::size_t cell, double shear)
{
  const std::size_t n_nodes = t.n_nodes, n = 3 * n_nodes, dim = t.dimension;
  const double *share = shares(t, cell);
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  const double lambda = 1 - 2 * shear;
  for (std::size_t q = cell * t.n_gauss; q < (cell + 1) * t.n_gauss; ++q)
    for (std::size_t a = 0; a < n_nodes; ++a)
      for (std::size_t b = 0; b < n_nodes; ++b)
        {
          Eigen::Vector3d ga = Eigen::Vector3d::Zero(), gb = ga;
          for (std::size_t d = 0; d < dim; ++d)
            {
              ga[mesh_axes[dim][d]] = at.gradient[(q * n_nodes + a) * dim + d];
              gb[mesh_axes[dim][d]] = at.gradient[(q * n_nodes + b) * dim + d];
            }
          k.block<3, 3>(3 * a, 3 * b) += at.weight[q] * (lambda * ga * gb.transpose() + shear * gb * ga.transpose() +
                                                         shear * ga.dot(gb) * Eigen::Matrix3d::Identity());
        }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      k(i, j) /= std::sqrt(share[i / 3] * share[j / 3]);
  return k;
}

double frequency(const CellTables &t, const CellGeometry &at, std::size_t cell)
{
  double largest = 0;
  for (double shear : {0.0, 0.75})
    {
      const Eigen::MatrixXd k = scaled_stiffness(t, at, cell, shear);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k, Eigen::EigenvaluesOnly);
      largest = std::max(largest, solver.eigenvalues().maxCoeff());
    }
  return largest;
}

bool have_same_shape(const CellTables &t, const CellGeometry &at, std::size_t one, std::size_t other)
{
  const std::size_t per_cell = t.n_gauss * t.n_nodes * t.dimension;
  const double *a = &at.gradient[one * per_cell], *b = &at.gradient[other * per_cell];
  const double *v = shares(t, one), *w = shares(t, other);
  if (!t.bound_share.empty() &&
      !std::equal(v, v + t.n_nodes, w, [&](double x, double y) { return std::abs(x - y) < 1e-9 * std::abs(*v); }))
    return false;
  return std::equal(a, a + per_cell, b, [&](double x, double y) { return std::abs(x - y) < 1e-9 * std::abs(*a); });
}
} // namespace

std::vector<double> cell_frequencies(const CellTables &t, const CellGeometry &at)
{
  std::vector<double> found;
  std::vector<std::size_t> known; // the first cell of each shape
  for (std::size_t cell = 0; cell < t.n_cells(); ++cell)
    {
      const auto same = std::find_if(known.begin(), known.end(),
                                     [&](std::size_t other) { return have_same_shape(t, at, cell, other); });
      found.push_back(same == known.end() ? frequency(t, at, cell) : found[*same]);
      if (same == known.end())
        known.push_back(cell);
    }
  return found;
}
} // namespace isostat

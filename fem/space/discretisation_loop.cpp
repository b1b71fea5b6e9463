// SPDX-License-Identifier: BSD-3-Clause
// What the time loop does at every step: strains, forces, the largest frequency.
#include "fem/space/axes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
/// Position in a Stress of the component (i, j).
constexpr int voigt[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};

template <int dim>
struct Tables
{
  const unsigned *dofs;
  const double *gradient, *weight;
  std::size_t n_cells, n_points;
};

template <int dim, int n_nodes>
void cell_gradients(const Tables<dim> &t, const double *u, double factor, Gradient *out)
{
  for (std::size_t cell = 0; cell < t.n_cells; ++cell)
    {
      double local[n_nodes][3];
      for (int a = 0; a < n_nodes; ++a)
        for (int c = 0; c < 3; ++c)
          local[a][c] = factor * u[t.dofs[(cell * n_nodes + a) * 3 + c]];
      for (std::size_t q = cell * t.n_points; q < (cell + 1) * t.n_points; ++q)
        {
          const double *grad = t.gradient + q * n_nodes * dim;
          for (int d = 0; d < dim; ++d)
            for (int c = 0; c < 3; ++c)
              {
                double sum = 0;
                for (int a = 0; a < n_nodes; ++a)
                  sum += local[a][c] * grad[a * dim + d];
                out[q][3 * c + mesh_axes<dim>[d]] = sum;
              }
        }
    }
}

template <int dim, int n_nodes>
void cell_forces(const Tables<dim> &t, const Stress *stresses, double *f)
{
  for (std::size_t cell = 0; cell < t.n_cells; ++cell)
    {
      double local[n_nodes][3] = {};
      for (std::size_t q = cell * t.n_points; q < (cell + 1) * t.n_points; ++q)
        {
          const double *grad = t.gradient + q * n_nodes * dim;
          for (int d = 0; d < dim; ++d)
            for (int c = 0; c < 3; ++c)
              {
                const double traction = t.weight[q] * stresses[q][voigt[c][mesh_axes<dim>[d]]];
                for (int a = 0; a < n_nodes; ++a)
                  local[a][c] += traction * grad[a * dim + d];
              }
        }
      for (int a = 0; a < n_nodes; ++a)
        for (int c = 0; c < 3; ++c)
          f[t.dofs[(cell * n_nodes + a) * 3 + c]] += local[a][c];
    }
}

constexpr int power(int base, int exponent) { return exponent == 0 ? 1 : base * power(base, exponent - 1); }

/// Stiffness of a skeleton with V_p^2 rho = 1 Pa and V_s^2 rho = shear Pa for one cell, divided by its nodal volumes on
/// both sides (square roots): its eigenvalues are omega^2 at a density of 1 kg/m3.
template <int dim>
Eigen::MatrixXd scaled_stiffness(const Tables<dim> &t, const double *nodal_share, std::size_t n_nodes, double shear)
{
  const std::size_t n = 3 * n_nodes;
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  const double lambda = 1 - 2 * shear;
  for (std::size_t q = 0; q < t.n_points; ++q)
    for (std::size_t a = 0; a < n_nodes; ++a)
      for (std::size_t b = 0; b < n_nodes; ++b)
        {
          Eigen::Vector3d ga = Eigen::Vector3d::Zero(), gb = ga;
          for (int d = 0; d < dim; ++d)
            {
              ga[mesh_axes<dim>[d]] = t.gradient[(q * n_nodes + a) * dim + d];
              gb[mesh_axes<dim>[d]] = t.gradient[(q * n_nodes + b) * dim + d];
            }
          k.block<3, 3>(3 * a, 3 * b) += t.weight[q] * (lambda * ga * gb.transpose() + shear * gb * ga.transpose() +
                                                        shear * ga.dot(gb) * Eigen::Matrix3d::Identity());
        }
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      k(i, j) /= std::sqrt(nodal_share[i / 3] * nodal_share[j / 3]);
  return k;
}
} // namespace

template <int dim>
void Discretisation<dim>::gradients(const Vector &u, std::span<Gradient> out, double factor) const
{
  const Tables<dim> t{cell_dofs.data(), gradient.data(), weight.data(), n_cells(), points_per_cell_};
  if (mesh_.degree == 1)
    cell_gradients<dim, power(2, dim)>(t, u.begin(), factor, out.data());
  else
    cell_gradients<dim, power(3, dim)>(t, u.begin(), factor, out.data());
}

template <int dim>
void Discretisation<dim>::add_internal_force(std::span<const Stress> stresses, Vector &f) const
{
  const Tables<dim> t{cell_dofs.data(), gradient.data(), weight.data(), n_cells(), points_per_cell_};
  if (mesh_.degree == 1)
    cell_forces<dim, power(2, dim)>(t, stresses.data(), f.begin());
  else
    cell_forces<dim, power(3, dim)>(t, stresses.data(), f.begin());
  if (shared_out_)
    f.compress(dealii::VectorOperation::add);
}

namespace
{
/// Largest omega^2 of a cell for rho V_p^2 = 1 Pa and a density of 1 kg/m3. It is convex in V_s^2/V_p^2, so the larger
/// of its values at the ends 0 and 3/4 (no bulk modulus) bounds it.
template <int dim>
double cell_frequency_squared(const Tables<dim> &t, const double *nodal_share, std::size_t n_nodes)
{
  double largest = 0;
  for (double shear : {0.0, 0.75})
    {
      const Eigen::MatrixXd k = scaled_stiffness<dim>(t, nodal_share, n_nodes, shear);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k, Eigen::EigenvaluesOnly);
      largest = std::max(largest, solver.eigenvalues().maxCoeff());
    }
  return largest;
}
} // namespace

/// Cells with the same gradients share one computation.
template <int dim>
void Discretisation<dim>::make_frequencies()
{
  const std::size_t per_cell = points_per_cell_ * nodes_per_cell_ * dim;
  std::vector<std::pair<std::size_t, double>> known; // first cell of a shape, its frequency
  for (std::size_t cell = 0; cell < n_cells(); ++cell)
    {
      const double *own = &gradient[cell * per_cell];
      const auto same = [&](const auto &entry) {
        const double *other = &gradient[entry.first * per_cell];
        return std::equal(own, own + per_cell, other,
                          [&](double a, double b) { return std::abs(a - b) < 1e-9 * std::abs(*own); });
      };
      auto found = std::find_if(known.begin(), known.end(), same);
      if (found == known.end())
        {
          const Tables<dim> t{nullptr, own, &weight[cell * points_per_cell_], 1, points_per_cell_};
          known.emplace_back(cell,
                             cell_frequency_squared<dim>(t, &nodal_share[cell * nodes_per_cell_], nodes_per_cell_));
          found = known.end() - 1;
        }
      cell_frequency_.push_back(found->second / mesh_.soil.layers[cell_layer[cell]].density);
    }
}

template <int dim>
double Discretisation<dim>::max_frequency_squared(std::span<const WaveModuli> moduli, bool shear_only) const
{
  double maximum = 0;
  for (std::size_t cell = 0; cell < n_cells(); ++cell)
    {
      double modulus = 0;
      for (std::size_t q = cell * points_per_cell_; q < (cell + 1) * points_per_cell_; ++q)
        modulus = std::max(modulus, shear_only ? moduli[q].s : moduli[q].p);
      maximum = std::max(maximum, modulus * cell_frequency_[cell]);
    }
  if (shared_out_)
    MPI_Allreduce(MPI_IN_PLACE, &maximum, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  return maximum;
}

template class Discretisation<1>;
template class Discretisation<2>;
template class Discretisation<3>;
} // namespace isostat

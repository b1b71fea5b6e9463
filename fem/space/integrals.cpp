// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/integrals.hpp"

namespace isostat
{
namespace
{
/// Position in a Stress of the component (i, j).
constexpr int voigt[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};

/// The tables by plain pointers: nothing that the loops write can be taken for one of them.
struct Pointers
{
  const unsigned *dofs;
  const double *gradient, *weight;
  std::size_t n_cells, n_points;

  explicit Pointers(const CellTables &t)
      : dofs(t.cell_dofs.data()), gradient(t.gradient.data()), weight(t.weight.data()), n_cells(t.n_cells()),
        n_points(t.n_gauss)
  {}
};

template <int dim, int n_nodes>
void cell_gradients(const Pointers &t, const double *u, double factor, Gradient *out)
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
void cell_forces(const Pointers &t, const Stress *stresses, double *f)
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

/// Degree 1 has two nodes along each axis, degree 2 three.
template <int dim>
bool is_linear(const CellTables &t)
{
  return t.n_nodes == power(2, dim);
}
} // namespace

template <int dim>
void find_gradients(const CellTables &tables, const double *u, double factor, Gradient *out)
{
  const Pointers t(tables);
  if (is_linear<dim>(tables))
    cell_gradients<dim, power(2, dim)>(t, u, factor, out);
  else
    cell_gradients<dim, power(3, dim)>(t, u, factor, out);
}

template <int dim>
void add_stress_divergence(const CellTables &tables, const Stress *stresses, double *f)
{
  const Pointers t(tables);
  if (is_linear<dim>(tables))
    cell_forces<dim, power(2, dim)>(t, stresses, f);
  else
    cell_forces<dim, power(3, dim)>(t, stresses, f);
}

#define ISOSTAT_INSTANTIATE(dim) \
  template void find_gradients<dim>(const CellTables &, const double *, double, Gradient *); \
  template void add_stress_divergence<dim>(const CellTables &, const Stress *, double *);
ISOSTAT_INSTANTIATE(1)
ISOSTAT_INSTANTIATE(2)
ISOSTAT_INSTANTIATE(3)
} // namespace isostat

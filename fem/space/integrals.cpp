// SPDX-License-Identifier: BSD-3-Clause
// Strains and forces from the tables of the cells, in the time loop.
#include "base/error.hpp"
#include "fem/space/discretisation.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <fmt/format.h>

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

  Pointers(const CellTables &t, const CellGeometry &at)
      : dofs(t.cell_dofs.data()), gradient(at.gradient.data()), weight(at.weight.data()), n_cells(t.n_cells()),
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
                out[q][3 * c + mesh_axes[dim][d]] = sum;
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
                const double traction = t.weight[q] * stresses[q][voigt[c][mesh_axes[dim][d]]];
                for (int a = 0; a < n_nodes; ++a)
                  local[a][c] += traction * grad[a * dim + d];
              }
        }
      for (int a = 0; a < n_nodes; ++a)
        for (int c = 0; c < 3; ++c)
          f[t.dofs[(cell * n_nodes + a) * 3 + c]] += local[a][c];
    }
}

/// Brings gradients and volume of a point from the start to where a gradient h of displacement has moved it.
template <int dim>
void deform_point(const CellTables &t, std::size_t q, const Gradient &h, CellGeometry &at)
{
  using Matrix = Eigen::Matrix<double, dim, dim>;
  Matrix f = Matrix::Identity(); // of the axes that are meshed: along others nothing changes
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j)
      f(i, j) += h[3 * mesh_axes[dim][i] + mesh_axes[dim][j]];
  const double volume = f.determinant();
  if (!(volume > 0))
    throw RunFailure(fmt::format("the element around x = {:.4g} m, y = {:.4g} m, z = {:.4g} m is turned inside out "
                                 "(volume ratio {:.3g}); give larger elements there, or end the run earlier",
                                 t.position[q][0], t.position[q][1], t.position[q][2], volume));
  const Matrix inverse = f.inverse();
  const auto turn = [&](std::vector<double> &gradients, std::size_t n) {
    for (std::size_t a = q * n; a < (q + 1) * n; ++a)
      {
        Eigen::Map<Eigen::Matrix<double, 1, dim>> gradient(&gradients[a * dim]);
        gradient = (gradient * inverse).eval();
      }
  };
  turn(at.gradient, t.n_nodes);
  turn(at.pressure_gradient, t.pressure_nodes_per_cell());
  at.weight[q] *= volume;
}

/// loop<dim, nodes of a cell>() for cells as they are: degree 1 has two nodes along each axis, degree 2 three.
template <typename Loop>
void for_shape_of(const CellTables &t, const Loop &loop)
{
  const bool linear = t.n_nodes == std::size_t{1} << t.dimension;
  if (t.dimension == 1)
    linear ? loop.template operator()<1, 2>() : loop.template operator()<1, 3>();
  else if (t.dimension == 2)
    linear ? loop.template operator()<2, 4>() : loop.template operator()<2, 9>();
  else
    linear ? loop.template operator()<3, 8>() : loop.template operator()<3, 27>();
}
} // namespace

void FiniteElementSpace::gradients(const CellGeometry &at, const Vector &u, std::span<Gradient> out,
                                   double factor) const
{
  for_shape_of(*this,
               [&]<int dim, int n>() { cell_gradients<dim, n>(Pointers(*this, at), u.begin(), factor, out.data()); });
}

void FiniteElementSpace::deform(const Vector &u, CellGeometry &at) const
{
  std::vector<Gradient> h(n_points());
  gradients(u, h);
  at = *this;
  for_shape_of(*this, [&]<int dim, int n>() {
    for (std::size_t q = 0; q < n_points(); ++q)
      deform_point<dim>(*this, q, h[q], at);
  });
}

void FiniteElementSpace::add_internal_force(const CellGeometry &at, std::span<const Stress> stresses, Vector &f) const
{
  for_shape_of(*this, [&]<int dim, int n>() { cell_forces<dim, n>(Pointers(*this, at), stresses.data(), f.begin()); });
  if (shared_out_)
    f.add_ghosts_to_owners();
}

Vector FiniteElementSpace::lumped_mass() const
{
  Vector mass = displacement_vector();
  for (std::size_t cell = 0; cell < n_cells(); ++cell)
    for (std::size_t a = 0; a < n_nodes; ++a)
      for (unsigned c = 0; c < 3; ++c)
        mass.local_element(cell_dofs[(cell * n_nodes + a) * 3 + c]) +=
            mesh_.soil.layers[cell_layer[cell]].density * nodal_share[cell * n_nodes + a];
  mass.add_ghosts_to_owners();
  return mass;
}

/// |m_eA| of a cell, times m_A / sum_e |m_eA|: together they are the mass of an unknown, part by part positive.
void FiniteElementSpace::share_out_masses()
{
  Vector absolute = displacement_vector(), part = lumped_mass();
  const auto mass = [this](std::size_t k) {
    return mesh_.soil.layers[cell_layer[k / n_nodes]].density * std::abs(nodal_share[k]);
  };
  for (std::size_t k = 0; k < nodal_share.size(); ++k)
    for (unsigned c = 0; c < 3; ++c)
      absolute.local_element(cell_dofs[3 * k + c]) += mass(k);
  absolute.add_ghosts_to_owners();
  for (std::size_t i = 0; i < part.locally_owned_size(); ++i)
    if (absolute.local_element(i) > 0)
      part.local_element(i) /= absolute.local_element(i);
  part.update_ghost_values();
  for (std::size_t k = 0; k < nodal_share.size(); ++k)
    {
      const unsigned *i = &cell_dofs[3 * k];
      bound_share.push_back(std::abs(nodal_share[k]) *
                            std::min({part.local_element(i[0]), part.local_element(i[1]), part.local_element(i[2])}));
      if (!(bound_share.back() > 0))
        throw InputError(
            "refine: a node between elements of two sizes has no positive mass; let layers of densities as "
            "different as that end elsewhere");
    }
}

std::vector<Vector> FiniteElementSpace::layer_volumes() const
{
  std::vector<Vector> volumes(mesh_.soil.layers.size(), displacement_vector());
  for (std::size_t cell = 0; cell < n_cells(); ++cell)
    for (std::size_t a = 0; a < n_nodes; ++a)
      for (unsigned c = 0; c < 3; ++c)
        volumes[cell_layer[cell]].local_element(cell_dofs[(cell * n_nodes + a) * 3 + c]) +=
            nodal_share[cell * n_nodes + a];
  for (Vector &volume : volumes)
    volume.add_ghosts_to_owners();
  return volumes;
}

std::vector<double> FiniteElementSpace::point_pressures(const Vector &p) const
{
  std::vector<double> pressure(n_points(), 0.0);
  Vector whole = p;
  whole.update_ghost_values();
  const std::size_t n_i = pressure_nodes_per_cell();
  for (std::size_t q = 0; q < pressure.size(); ++q)
    for (std::size_t i = 0; cell_is_wet[q / n_gauss] && i < n_i; ++i)
      pressure[q] += pressure_shapes(q)[i] * whole.local_element(cell_pressures[q / n_gauss * n_i + i]);
  return pressure;
}

std::vector<double> FiniteElementSpace::frequencies(const CellGeometry &at) const
{
  std::vector<double> found = cell_frequencies(*this, at);
  for (std::size_t cell = 0; cell < n_cells(); ++cell)
    found[cell] /= mesh_.soil.layers[cell_layer[cell]].density;
  return found;
}

double FiniteElementSpace::max_frequency_squared(std::span<const double> frequencies,
                                                 std::span<const WaveModuli> moduli, bool shear_only) const
{
  double maximum = 0;
  for (std::size_t cell = 0; cell < n_cells(); ++cell)
    {
      double modulus = 0;
      for (std::size_t q = cell * n_gauss; q < (cell + 1) * n_gauss; ++q)
        modulus = std::max(modulus, shear_only && cell_is_wet[cell] ? moduli[q].s : moduli[q].p);
      maximum = std::max(maximum, modulus * frequencies[cell]);
    }
  if (shared_out_)
    MPI_Allreduce(MPI_IN_PLACE, &maximum, 1, MPI_DOUBLE, MPI_MAX, communicator_);
  return maximum;
}
} // namespace isostat

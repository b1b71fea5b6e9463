// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/tables.hpp"

#include "base/error.hpp"
#include "fem/space/unknowns.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
using Index = dealii::types::global_dof_index;

template <typename Values>
void append_gradients(const Values &values, std::size_t n_shapes, std::size_t n_points, std::vector<double> &gradient)
{
  for (std::size_t q = 0; q < n_points; ++q)
    for (std::size_t a = 0; a < n_shapes; ++a)
      for (unsigned d = 0; d < Values::dimension; ++d)
        gradient.push_back(values.shape_grad(a, q)[d]);
}

template <typename Values>
std::vector<double> shapes(const Values &values, std::size_t n_shapes, std::size_t n_points)
{
  std::vector<double> table;
  for (std::size_t q = 0; q < n_points; ++q)
    for (std::size_t a = 0; a < n_shapes; ++a)
      table.push_back(values.shape_value(a, q));
  return table;
}

/// Gauss-Lobatto volumes of the nodes: int N_A.
template <typename Values>
void append_shares(const Values &lumped, std::size_t n_nodes, std::vector<double> &nodal_share)
{
  for (std::size_t a = 0; a < n_nodes; ++a)
    {
      double share = 0;
      for (unsigned q = 0; q < lumped.n_quadrature_points; ++q)
        share += lumped.shape_value(a, q) * lumped.JxW(q);
      nodal_share.push_back(share);
    }
}

/// Local unknowns of a cell's nodes and corners.
template <int dim, typename Cell, typename PressureCell>
void append_unknowns(const Unknowns<dim> &unknowns, const Cell &cell, const PressureCell &same_cell, CellTables &t)
{
  std::vector<Index> node(t.n_nodes), corner(t.pressure_nodes_per_cell());
  cell->get_dof_indices(node);
  same_cell->get_dof_indices(corner);
  for (Index n : node)
    for (unsigned c = 0; c < 3; ++c)
      t.cell_dofs.push_back(unknowns.dof_of_node(n, c));
  for (Index n : corner)
    t.cell_pressures.push_back(unknowns.pressure_of_node(n));
}
} // namespace

template <int dim>
CellTables make_tables(const MeshSpec &spec, const Unknowns<dim> &unknowns)
{
  using namespace dealii;
  const QGauss<dim> gauss(spec.gauss_points(dim));
  const QGaussLobatto<dim> lobatto(spec.degree + 1);
  const auto &displacement = unknowns.nodes().get_fe(), &pressure = unknowns.pressure_nodes().get_fe();
  FEValues<dim> u(displacement, gauss, update_values | update_gradients | update_JxW_values | update_quadrature_points);
  FEValues<dim> p(pressure, gauss, update_values | update_gradients);
  FEValues<dim> lumped(displacement, lobatto, update_values | update_JxW_values);
  CellTables t;
  t.dimension = dim;
  t.n_nodes = displacement.n_dofs_per_cell();
  t.n_gauss = gauss.size();
  auto pressure_cell = unknowns.pressure_nodes().begin_active();
  for (const auto &cell : unknowns.nodes().active_cell_iterators())
    {
      const auto same_cell = pressure_cell++;
      if (!cell->is_locally_owned())
        continue;
      const CellMark mark = CellMark::of(cell->material_id(), spec.soil.layers.size());
      u.reinit(cell);
      p.reinit(same_cell);
      lumped.reinit(cell);
      append_unknowns(unknowns, cell, same_cell, t);
      append_gradients(u, t.n_nodes, t.n_gauss, t.gradient);
      append_gradients(p, t.pressure_nodes_per_cell(), t.n_gauss, t.pressure_gradient);
      append_shares(lumped, t.n_nodes, t.nodal_share);
      const double least_share = *std::min_element(t.nodal_share.end() - t.n_nodes, t.nodal_share.end());
      for (std::size_t q = 0; q < t.n_gauss; ++q)
        {
          if (!(u.JxW(q) > 0) || least_share <= 0)
            throw InputError(fmt::format("mesh: the cell around x = {:.6g} m, z = {:.6g} m is folded or flat; must be "
                                         "convex",
                                         cell->center()[0], cell->center()[dim - 1]));
          t.weight.push_back(u.JxW(q));
          t.position.push_back(place_of<dim>(u.quadrature_point(q)));
          t.point_id.push_back(mark.number * t.n_gauss + q);
        }
      for (const unsigned v : cell->vertex_indices())
        t.corner.push_back(place_of<dim>(cell->vertex(v)));
      t.cell_layer.push_back(mark.layer);
      t.cell_is_wet.push_back(spec.given || !spec.ground.is_level() || spec.soil.is_wet(cell->center()[dim - 1]));
      if (t.shape.empty())
        {
          t.shape = shapes(u, t.n_nodes, t.n_gauss);
          t.pressure_shape = shapes(p, t.pressure_nodes_per_cell(), t.n_gauss);
        }
    }
  return t;
}

template CellTables make_tables<1>(const MeshSpec &, const Unknowns<1> &);
template CellTables make_tables<2>(const MeshSpec &, const Unknowns<2> &);
template CellTables make_tables<3>(const MeshSpec &, const Unknowns<3> &);
} // namespace isostat

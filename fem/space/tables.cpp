// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/tables.hpp"

#include "base/error.hpp"
#include "fem/space/unknowns.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
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

/// Rows over the nodes of a cell that become rows over those its functions belong to: row T.
/// @param values  the last of them are those of the cell: [row][node][width]
void combine(const std::vector<double> &weights, std::size_t n_rows, std::size_t width, std::vector<double> &values)
{
  const auto n = static_cast<std::size_t>(std::lround(std::sqrt(weights.size())));
  for (auto row = values.end() - static_cast<std::ptrdiff_t>(n_rows * n * width); n > 0 && row != values.end();
       row += static_cast<std::ptrdiff_t>(n * width))
    {
      const std::vector<double> own(row, row + static_cast<std::ptrdiff_t>(n * width));
      for (std::size_t b = 0; b < n; ++b)
        for (std::size_t d = 0; d < width; ++d)
          {
            double sum = 0;
            for (std::size_t a = 0; a < n; ++a)
              sum += own[a * width + d] * weights[a * n + b];
            row[static_cast<std::ptrdiff_t>(b * width + d)] = sum;
          }
    }
}

/// The set of shape functions of a cell where nodes hang, by those of other cells.
void add_shape_set(const std::vector<double> &weights, const std::vector<double> &pressure_weights, CellTables &t)
{
  const std::size_t n_a = t.n_nodes, n_i = t.pressure_nodes_per_cell();
  const auto append = [&t](std::vector<double> &sets, std::size_t n, const std::vector<double> &of_cell) {
    const std::vector<double> first(sets.begin(), sets.begin() + static_cast<std::ptrdiff_t>(t.n_gauss * n));
    sets.insert(sets.end(), first.begin(), first.end());
    combine(of_cell, t.n_gauss, 1, sets);
  };
  append(t.shape, n_a, weights);
  append(t.pressure_shape, n_i, pressure_weights);
  t.hanging_weight.insert(t.hanging_weight.end(), weights.begin(), weights.end());
  t.shape_set.resize(t.n_cells());
  t.shape_set.back() = static_cast<unsigned>(t.hanging_weight.size() / (n_a * n_a));
}

/// Local unknowns of a cell, and what nodes that hang make of its shape functions.   @pre all else of it is there
template <int dim, typename Cell, typename PressureCell>
void append_unknowns(const Unknowns<dim> &unknowns, const Cell &cell, const PressureCell &same_cell, CellTables &t)
{
  const auto [nodes, weights] = unknowns.hanging().of_cell(cell);
  const auto [corners, pressure_weights] = unknowns.hanging_pressures().of_cell(same_cell);
  for (Index n : nodes)
    for (unsigned c = 0; c < 3; ++c)
      t.cell_dofs.push_back(unknowns.dof_of_node(n, c));
  for (Index n : corners)
    t.cell_pressures.push_back(unknowns.pressure_of_node(n));
  if (!t.shape_set.empty())
    t.shape_set.push_back(0);
  if (weights.empty())
    return;
  combine(weights, t.n_gauss, dim, t.gradient);
  combine(pressure_weights, t.n_gauss, dim, t.pressure_gradient);
  combine(weights, 1, 1, t.nodal_share);
  add_shape_set(weights, pressure_weights, t);
}

/// Gauss points of a cell.
/// @throws InputError  it is not convex
template <int dim, typename Values>
void append_points(const Values &values, std::size_t number, CellTables &t)
{
  const double least_share =
      *std::min_element(t.nodal_share.end() - static_cast<std::ptrdiff_t>(t.n_nodes), t.nodal_share.end());
  for (std::size_t q = 0; q < t.n_gauss; ++q)
    {
      if (!(values.JxW(q) > 0) || least_share <= 0)
        throw InputError(
            fmt::format("mesh: the cell around x = {:.6g} m, z = {:.6g} m is folded or flat; must be convex",
                        values.get_cell()->center()[0], values.get_cell()->center()[dim - 1]));
      t.weight.push_back(values.JxW(q));
      t.position.push_back(place_of<dim>(values.quadrature_point(q)));
      t.point_id.push_back(number * t.n_gauss + q);
    }
}
} // namespace

double CellTables::at_node(std::span<const double> displacement, std::size_t cell, std::size_t node,
                           unsigned component) const
{
  const unsigned *dofs = &cell_dofs[cell * n_nodes * 3 + component], set = shape_set.empty() ? 0 : shape_set[cell];
  if (set == 0)
    return displacement[dofs[3 * node]];
  double sum = 0;
  for (std::size_t b = 0; b < n_nodes; ++b)
    sum += hanging_weight[((set - 1) * n_nodes + node) * n_nodes + b] * displacement[dofs[3 * b]];
  return sum;
}

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
      append_gradients(u, t.n_nodes, t.n_gauss, t.gradient);
      append_gradients(p, t.pressure_nodes_per_cell(), t.n_gauss, t.pressure_gradient);
      append_shares(lumped, t.n_nodes, t.nodal_share);
      append_points<dim>(u, mark.number, t);
      for (const unsigned v : cell->vertex_indices())
        t.corner.push_back(place_of<dim>(cell->vertex(v)));
      t.cell_layer.push_back(mark.layer);
      t.cell_is_wet.push_back(spec.given || !spec.ground.is_level() || spec.soil.is_wet(cell->center()[dim - 1]));
      if (t.shape.empty())
        {
          t.shape = shapes(u, t.n_nodes, t.n_gauss);
          t.pressure_shape = shapes(p, t.pressure_nodes_per_cell(), t.n_gauss);
        }
      append_unknowns(unknowns, cell, same_cell, t);
    }
  return t;
}

template CellTables make_tables<1>(const MeshSpec &, const Unknowns<1> &);
template CellTables make_tables<2>(const MeshSpec &, const Unknowns<2> &);
template CellTables make_tables<3>(const MeshSpec &, const Unknowns<3> &);
} // namespace isostat

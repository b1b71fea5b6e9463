// SPDX-License-Identifier: BSD-3-Clause
// The flat tables of a mesh, its masses and areas, where its nodes are.
#include "fem/space/axes.hpp"

#include "base/error.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>

#include <fmt/format.h>
#include <limits>

namespace isostat
{
namespace
{
using Index = dealii::types::global_dof_index;

template <typename Values>
void append_shapes(const Values &values, std::size_t n_shapes, std::size_t n_points, std::vector<double> &gradient)
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

template <int dim>
std::size_t number_in_mesh(const typename dealii::DoFHandler<dim>::active_cell_iterator &cell)
{
  return cell->id().get_coarse_cell_id();
}
} // namespace

template <int dim>
void Discretisation<dim>::make_tables()
{
  using namespace dealii;
  const unsigned n_gauss =
      mesh_.points_per_direction ? mesh_.points_per_direction : (dim == 1 ? mesh_.degree : mesh_.degree + 1);
  const QGauss<dim> gauss(n_gauss);
  const QGaussLobatto<dim> lobatto(mesh_.degree + 1);
  FEValues<dim> u(displacement_element_, gauss,
                  update_values | update_gradients | update_JxW_values | update_quadrature_points);
  FEValues<dim> p(pressure_element_, gauss, update_values | update_gradients);
  FEValues<dim> lumped(displacement_element_, lobatto, update_values | update_JxW_values);
  nodes_per_cell_ = displacement_element_.n_dofs_per_cell();
  points_per_cell_ = gauss.size();
  std::vector<Index> node(nodes_per_cell_), corner(pressure_nodes_per_cell());
  auto pressure_cell = pressures_.begin_active();
  for (const auto &cell : nodes_.active_cell_iterators())
    {
      const auto same_cell = pressure_cell++;
      if (!cell->is_locally_owned())
        continue;
      u.reinit(cell);
      p.reinit(same_cell);
      lumped.reinit(cell);
      cell->get_dof_indices(node);
      same_cell->get_dof_indices(corner);
      for (Index n : node)
        for (unsigned c = 0; c < 3; ++c)
          cell_dofs.push_back(dof_of_node(n, c));
      for (Index n : corner)
        cell_pressures.push_back(pressure_of_node(n));
      append_shapes(u, nodes_per_cell_, points_per_cell_, gradient);
      append_shapes(p, corner.size(), points_per_cell_, pressure_gradient);
      for (std::size_t q = 0; q < points_per_cell_; ++q)
        {
          weight.push_back(u.JxW(q));
          position.push_back(place_of<dim>(u.quadrature_point(q)));
          point_id.push_back(number_in_mesh<dim>(cell) * points_per_cell_ + q);
        }
      for (std::size_t a = 0; a < nodes_per_cell_; ++a)
        {
          double share = 0;
          for (unsigned q = 0; q < lobatto.size(); ++q)
            share += lumped.shape_value(a, q) * lumped.JxW(q);
          nodal_share.push_back(share);
        }
      cell_layer.push_back(mesh_.soil.layer_at(cell->center()[dim - 1]));
      if (shape.empty())
        {
          shape = shapes(u, nodes_per_cell_, points_per_cell_);
          pressure_shape = shapes(p, corner.size(), points_per_cell_);
        }
    }
  make_supports();
}

namespace
{
/// Nodes on a face that this rank's own cells have.
template <int dim>
std::vector<Index> nodes_on_face(const dealii::DoFHandler<dim> &nodes, Face face)
{
  const int id = boundary_id<dim>(face);
  if (id < 0)
    throw InputError("supports: a face of an axis that is not meshed; remove it");
  std::vector<Index> on_face(nodes.get_fe().n_dofs_per_face()), all;
  for (const auto &cell : nodes.active_cell_iterators())
    if (cell->is_locally_owned())
      for (const auto &f : cell->face_iterators())
        if (f->at_boundary() && f->boundary_id() == static_cast<unsigned>(id))
          {
            f->get_dof_indices(on_face);
            all.insert(all.end(), on_face.begin(), on_face.end());
          }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}
} // namespace

template <int dim>
void Discretisation<dim>::make_supports()
{
  for (const FaceComponent &support : supports_.fixed)
    for (Index node : nodes_on_face(nodes_, support.face))
      fixed_dofs.push_back(dof_of_node(node, support.component));
  for (Face face : supports_.drained)
    for (Index node : nodes_on_face(pressures_, face))
      drained_pressures.push_back(pressure_of_node(node));
  for (std::vector<unsigned> *list : {&fixed_dofs, &drained_pressures})
    {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
}

template <int dim>
Vector Discretisation<dim>::lumped_mass() const
{
  Vector mass = displacement_vector();
  for (std::size_t cell = 0; cell < n_cells(); ++cell)
    for (std::size_t a = 0; a < nodes_per_cell_; ++a)
      for (unsigned c = 0; c < 3; ++c)
        mass.local_element(cell_dofs[(cell * nodes_per_cell_ + a) * 3 + c]) +=
            mesh_.soil.layers[cell_layer[cell]].density * nodal_share[cell * nodes_per_cell_ + a];
  mass.compress(dealii::VectorOperation::add);
  return mass;
}

namespace
{
/// Gauss-Lobatto at the nodes of a face; a face of a column is a point.
template <int dim>
dealii::Quadrature<dim - 1> nodal_quadrature(unsigned degree)
{
  if constexpr (dim == 1)
    return dealii::QGauss<0>(degree);
  else
    return dealii::QGaussLobatto<dim - 1>(degree + 1);
}
} // namespace

template <int dim>
Vector Discretisation<dim>::face_area(Face face) const
{
  using namespace dealii;
  const int id = boundary_id<dim>(face);
  if (id < 0)
    throw InputError("load: a face of an axis that is not meshed; remove it");
  Vector area = displacement_vector();
  FEFaceValues<dim> values(displacement_element_, nodal_quadrature<dim>(mesh_.degree),
                           update_values | update_JxW_values);
  std::vector<Index> node(nodes_per_cell_);
  for (const auto &cell : nodes_.active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned f : cell->face_indices())
        if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == static_cast<unsigned>(id))
          {
            values.reinit(cell, f);
            cell->get_dof_indices(node);
            for (std::size_t a = 0; a < nodes_per_cell_; ++a)
              for (unsigned q = 0; q < values.n_quadrature_points; ++q)
                for (unsigned c = 0; c < 3; ++c)
                  area.local_element(dof_of_node(node[a], c)) += values.shape_value(a, q) * values.JxW(q);
          }
  area.compress(VectorOperation::add);
  return area;
}

template <int dim>
std::vector<std::array<double, 3>> Discretisation<dim>::node_places() const
{
  std::vector<std::array<double, 3>> places(displacement_partition_->locally_owned_size());
  const auto &support = nodes_.get_fe().get_unit_support_points();
  std::vector<Index> node(nodes_per_cell_);
  const dealii::MappingQ1<dim> mapping;
  for (const auto &cell : nodes_.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        cell->get_dof_indices(node);
        for (unsigned a = 0; a < node.size(); ++a)
          for (unsigned c = 0; c < 3; ++c)
            if (const unsigned i = dof_of_node(node[a], c); i < places.size() && masters_[c].count(node[a]) == 0)
              places[i] = place_of<dim>(mapping.transform_unit_to_real_cell(cell, support[a]));
      }
  return places;
}

namespace
{
/// The owned node nearest to a place, invalid on the ranks that do not have the nearest of all.
template <int dim>
Index nearest_node(const dealii::DoFHandler<dim> &nodes, const std::array<double, 3> &place, MPI_Comm communicator)
{
  const auto &support = nodes.get_fe().get_unit_support_points();
  std::vector<Index> of_cell(nodes.get_fe().n_dofs_per_cell());
  struct
  {
    double distance = std::numeric_limits<double>::max();
    int rank = 0;
  } best;
  MPI_Comm_rank(communicator, &best.rank);
  Index nearest = dealii::numbers::invalid_dof_index;
  const dealii::MappingQ1<dim> mapping;
  for (const auto &cell : nodes.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        cell->get_dof_indices(of_cell);
        for (unsigned a = 0; a < of_cell.size(); ++a)
          {
            const auto at = place_of<dim>(mapping.transform_unit_to_real_cell(cell, support[a]));
            double distance = 0;
            for (int d = 0; d < dim; ++d)
              distance += std::pow(at[mesh_axes<dim>[d]] - place[mesh_axes<dim>[d]], 2);
            if (distance < best.distance && nodes.locally_owned_dofs().is_element(of_cell[a]))
              {
                best.distance = distance;
                nearest = of_cell[a];
              }
          }
      }
  const int rank = best.rank;
  MPI_Allreduce(MPI_IN_PLACE, &best, 1, MPI_DOUBLE_INT, MPI_MINLOC, communicator);
  return best.rank == rank ? nearest : dealii::numbers::invalid_dof_index;
}
} // namespace

template <int dim>
long Discretisation<dim>::find_dof(const std::array<double, 3> &place, unsigned component) const
{
  const Index node = nearest_node(nodes_, place, communicator_);
  return node == dealii::numbers::invalid_dof_index ? -1 : static_cast<long>(dof_of_node(node, component));
}

template <int dim>
long Discretisation<dim>::find_pressure(const std::array<double, 3> &place) const
{
  const Index node = nearest_node(pressures_, place, communicator_);
  return node == dealii::numbers::invalid_dof_index ? -1 : static_cast<long>(pressure_of_node(node));
}

template class Discretisation<1>;
template class Discretisation<2>;
template class Discretisation<3>;
} // namespace isostat

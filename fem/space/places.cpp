// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/places.hpp"

#include "base/error.hpp"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat
{
namespace
{
using Index = dealii::types::global_dof_index;

template <int dim>
unsigned number_of(Face face, const char *whose)
{
  const int id = boundary_id<dim>(face);
  if (id < 0)
    throw InputError(std::string(whose) + ": a face of an axis that is not meshed; remove it");
  return static_cast<unsigned>(id);
}

/// Nodes on a face that this rank's own cells have.
template <int dim>
std::vector<Index> nodes_on_face(const dealii::DoFHandler<dim> &nodes, Face face)
{
  const unsigned id = number_of<dim>(face, "supports");
  std::vector<Index> on_face(nodes.get_fe().n_dofs_per_face()), all;
  for (const auto &cell : nodes.active_cell_iterators())
    if (cell->is_locally_owned())
      for (const auto &f : cell->face_iterators())
        if (f->at_boundary() && f->boundary_id() == id)
          {
            f->get_dof_indices(on_face);
            all.insert(all.end(), on_face.begin(), on_face.end());
          }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// f(node, place) for the nodes of this rank's cells, cell by cell: a node as often as it has cells.
template <int dim, typename F>
void for_each_node(const dealii::DoFHandler<dim> &nodes, const F &f)
{
  const auto &support = nodes.get_fe().get_unit_support_points();
  std::vector<Index> of_cell(support.size());
  const dealii::MappingQ1<dim> mapping;
  for (const auto &cell : nodes.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        cell->get_dof_indices(of_cell);
        for (unsigned a = 0; a < of_cell.size(); ++a)
          f(of_cell[a], place_of<dim>(mapping.transform_unit_to_real_cell(cell, support[a])));
      }
}

/// The owned node nearest to a place, invalid on the ranks that do not have the nearest of all.
template <int dim>
Index nearest_node(const dealii::DoFHandler<dim> &nodes, const Place &place, MPI_Comm communicator)
{
  struct
  {
    double distance = std::numeric_limits<double>::max();
    int rank = 0;
  } best;
  MPI_Comm_rank(communicator, &best.rank);
  Index nearest = dealii::numbers::invalid_dof_index;
  for_each_node(nodes, [&](Index node, const Place &at) {
    double distance = 0;
    for (int d = 0; d < dim; ++d)
      distance += std::pow(at[mesh_axes<dim>[d]] - place[mesh_axes<dim>[d]], 2);
    if (distance < best.distance && nodes.locally_owned_dofs().is_element(node))
      {
        best.distance = distance;
        nearest = node;
      }
  });
  const int rank = best.rank;
  MPI_Allreduce(MPI_IN_PLACE, &best, 1, MPI_DOUBLE_INT, MPI_MINLOC, communicator);
  return best.rank == rank ? nearest : dealii::numbers::invalid_dof_index;
}

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
std::vector<unsigned> displacements_on(const Unknowns<dim> &unknowns, FaceComponent of)
{
  std::vector<unsigned> found;
  for (Index node : nodes_on_face(unknowns.nodes(), of.face))
    found.push_back(unknowns.dof_of_node(node, of.component));
  return found;
}

template <int dim>
std::vector<unsigned> pressures_on(const Unknowns<dim> &unknowns, Face face)
{
  std::vector<unsigned> found;
  for (Index node : nodes_on_face(unknowns.pressure_nodes(), face))
    found.push_back(unknowns.pressure_of_node(node));
  return found;
}

template <int dim>
long nearest_displacement(const Unknowns<dim> &unknowns, const Place &place, unsigned component)
{
  const Index node = nearest_node(unknowns.nodes(), place, unknowns.communicator());
  return node == dealii::numbers::invalid_dof_index ? -1 : static_cast<long>(unknowns.dof_of_node(node, component));
}

template <int dim>
long nearest_pressure(const Unknowns<dim> &unknowns, const Place &place)
{
  const Index node = nearest_node(unknowns.pressure_nodes(), place, unknowns.communicator());
  return node == dealii::numbers::invalid_dof_index ? -1 : static_cast<long>(unknowns.pressure_of_node(node));
}

template <int dim>
std::vector<Place> displacement_places(const Unknowns<dim> &unknowns)
{
  std::vector<Place> places(Vector(unknowns.displacements()).locally_owned_size());
  for_each_node(unknowns.nodes(), [&](Index node, const Place &at) {
    for (unsigned c = 0; c < 3; ++c)
      if (const unsigned i = unknowns.dof_of_node(node, c); i < places.size() && !unknowns.is_removed(node, c))
        places[i] = at;
  });
  return places;
}

template <int dim>
Vector area_of(const Unknowns<dim> &unknowns, Face face)
{
  using namespace dealii;
  const unsigned id = number_of<dim>(face, "load");
  const auto &element = unknowns.nodes().get_fe();
  Vector area(unknowns.displacements());
  FEFaceValues<dim> values(element, nodal_quadrature<dim>(element.degree), update_values | update_JxW_values);
  std::vector<Index> node(element.n_dofs_per_cell());
  for (const auto &cell : unknowns.nodes().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned f : cell->face_indices())
        if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == id)
          {
            values.reinit(cell, f);
            cell->get_dof_indices(node);
            for (std::size_t a = 0; a < node.size(); ++a)
              for (unsigned q = 0; q < values.n_quadrature_points; ++q)
                for (unsigned c = 0; c < 3; ++c)
                  area.local_element(unknowns.dof_of_node(node[a], c)) += values.shape_value(a, q) * values.JxW(q);
          }
  area.add_ghosts_to_owners();
  return area;
}

#define ISOSTAT_INSTANTIATE(dim) \
  template std::vector<unsigned> displacements_on<dim>(const Unknowns<dim> &, FaceComponent); \
  template std::vector<unsigned> pressures_on<dim>(const Unknowns<dim> &, Face); \
  template long nearest_displacement<dim>(const Unknowns<dim> &, const Place &, unsigned); \
  template long nearest_pressure<dim>(const Unknowns<dim> &, const Place &); \
  template std::vector<Place> displacement_places<dim>(const Unknowns<dim> &); \
  template Vector area_of<dim>(const Unknowns<dim> &, Face);
ISOSTAT_INSTANTIATE(1)
ISOSTAT_INSTANTIATE(2)
ISOSTAT_INSTANTIATE(3)
} // namespace isostat

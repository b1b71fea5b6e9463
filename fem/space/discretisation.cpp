// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/discretisation.hpp"

#include "base/error.hpp"
#include "fem/space/unknowns.hpp"

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
constexpr Index nowhere = dealii::numbers::invalid_dof_index;

int n_ranks(MPI_Comm communicator)
{
  int size = 1;
  MPI_Comm_size(communicator, &size);
  return size;
}

void sort_unique(std::vector<unsigned> &list)
{
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

template <int dim>
unsigned number_of(Face face, const char *whose)
{
  const int id = boundary_id<dim>(face);
  if (id < 0)
    throw InputError(std::string(whose) + ": a face of an axis that is not meshed; remove it");
  return static_cast<unsigned>(id);
}

/// Nodes on a face that this rank's own cells have, cell by cell; in place of one that hangs those it depends on.
template <int dim>
std::vector<Index> nodes_on_face(const dealii::DoFHandler<dim> &nodes, const HangingNodes<dim> &hanging, Face face)
{
  const unsigned id = number_of<dim>(face, "supports");
  std::vector<Index> on_face(nodes.get_fe().n_dofs_per_face()), all;
  for (const auto &cell : nodes.active_cell_iterators())
    if (cell->is_locally_owned())
      for (const auto &f : cell->face_iterators())
        if (f->at_boundary() && f->boundary_id() == id)
          {
            f->get_dof_indices(on_face);
            for (Index node : on_face)
              hanging.for_each_master(node, [&](Index master) { all.push_back(master); });
          }
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

/// The owned node nearest to a place that does not hang, `nowhere` on the ranks that do not have the nearest of all.
template <int dim>
Index nearest_node(const dealii::DoFHandler<dim> &nodes, const HangingNodes<dim> &hanging, const Place &place,
                   MPI_Comm communicator)
{
  struct
  {
    double distance = std::numeric_limits<double>::max();
    int rank = 0;
  } best;
  MPI_Comm_rank(communicator, &best.rank);
  Index nearest = nowhere;
  for_each_node(nodes, [&](Index node, const Place &at) {
    double distance = 0;
    for (int d = 0; d < dim; ++d)
      distance += std::pow(at[mesh_axes[dim][d]] - place[mesh_axes[dim][d]], 2);
    if (distance < best.distance && nodes.locally_owned_dofs().is_element(node) && !hanging.hangs(node))
      {
        best.distance = distance;
        nearest = node;
      }
  });
  const int rank = best.rank;
  MPI_Allreduce(MPI_IN_PLACE, &best, 1, MPI_DOUBLE_INT, MPI_MINLOC, communicator);
  return best.rank == rank ? nearest : nowhere;
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

FiniteElementSpace::FiniteElementSpace(const MeshSpec &mesh, const Supports &supports, int dim, MPI_Comm communicator)
    : mesh_(mesh), supports_(supports), shared_out_(dim > 1 && n_ranks(communicator) > 1),
      communicator_(dim == 1 ? MPI_COMM_SELF : communicator)
{}

void FiniteElementSpace::sum_over_ranks(std::span<double> values) const
{
  if (shared_out_)
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM, communicator_);
}

bool FiniteElementSpace::on_every_rank(bool here) const
{
  if (shared_out_)
    MPI_Allreduce(MPI_IN_PLACE, &here, 1, MPI_C_BOOL, MPI_LAND, communicator_);
  return here;
}

template <int dim>
Discretisation<dim>::Discretisation(const MeshSpec &mesh, const Supports &supports, MPI_Comm communicator)
    : FiniteElementSpace(mesh, supports, dim, communicator),
      unknowns_(std::make_unique<Unknowns<dim>>(mesh_, supports_, shared_out_, communicator_))
{
  displacements_ = unknowns_->displacements();
  pressures_ = unknowns_->pressures();
  static_cast<CellTables &>(*this) = make_tables(mesh_, *unknowns_);
  for (const FaceComponent &support : supports_.fixed)
    for (Index node : nodes_on_face(unknowns_->nodes(), unknowns_->hanging(), support.face))
      fixed_dofs.push_back(unknowns_->dof_of_node(node, support.component));
  for (Face face : supports_.drained)
    for (Index node : nodes_on_face(unknowns_->pressure_nodes(), unknowns_->hanging_pressures(), face))
      drained_pressures.push_back(unknowns_->pressure_of_node(node));
  if (mesh_.soil.water_table > 0)
    for_each_node(unknowns_->pressure_nodes(), [&](Index node, const Place &at) {
      if (!mesh_.soil.is_wet(at[2] * (1 + 1e-9)) && // at the table, whatever the rounding
          !unknowns_->hanging_pressures().hangs(node))
        drained_pressures.push_back(unknowns_->pressure_of_node(node));
    });
  sort_unique(fixed_dofs);
  sort_unique(drained_pressures);
  if (!mesh_.refine.empty())
    share_out_masses();
}

template <int dim>
Discretisation<dim>::~Discretisation() = default;

template <int dim>
long Discretisation<dim>::find_dof(const Place &place, unsigned component) const
{
  const Index node = nearest_node(unknowns_->nodes(), unknowns_->hanging(), place, communicator_);
  return node == nowhere ? -1 : static_cast<long>(unknowns_->dof_of_node(node, component));
}

template <int dim>
long Discretisation<dim>::find_pressure(const Place &place) const
{
  const Index node = nearest_node(unknowns_->pressure_nodes(), unknowns_->hanging_pressures(), place, communicator_);
  return node == nowhere ? -1 : static_cast<long>(unknowns_->pressure_of_node(node));
}

template <int dim>
std::vector<Place> Discretisation<dim>::node_places() const
{
  std::vector<Place> places(displacement_vector().locally_owned_size());
  for_each_node(unknowns_->nodes(), [&](Index node, const Place &at) {
    for (unsigned c = 0; c < 3; ++c)
      if (!unknowns_->is_removed(node, c))
        if (const unsigned i = unknowns_->dof_of_node(node, c); i < places.size())
          places[i] = at;
  });
  return places;
}

template <int dim>
Vector Discretisation<dim>::face_area(Face face) const
{
  using namespace dealii;
  const unsigned id = number_of<dim>(face, "load");
  const auto &element = unknowns_->nodes().get_fe();
  Vector area = displacement_vector();
  FEFaceValues<dim> values(element, nodal_quadrature<dim>(element.degree), update_values | update_JxW_values);
  for (const auto &cell : unknowns_->nodes().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned f : cell->face_indices())
        if (cell->face(f)->at_boundary() && cell->face(f)->boundary_id() == id)
          {
            values.reinit(cell, f);
            const auto [node, weights] = unknowns_->hanging().of_cell(cell);
            for (std::size_t a = 0; a < node.size(); ++a)
              for (unsigned q = 0; q < values.n_quadrature_points; ++q)
                for (std::size_t b = 0; b < node.size(); ++b)
                  if (const double weight = weights.empty() ? a == b : weights[a * node.size() + b]; weight != 0)
                    for (unsigned c = 0; c < 3; ++c)
                      area.local_element(unknowns_->dof_of_node(node[b], c)) +=
                          weight * values.shape_value(a, q) * values.JxW(q);
          }
  area.add_ghosts_to_owners();
  return area;
}

template class Discretisation<1>;
template class Discretisation<2>;
template class Discretisation<3>;
} // namespace isostat

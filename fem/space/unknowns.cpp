// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/unknowns.hpp"

#include "base/error.hpp"

#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/affine_constraints.h>

#include <span>

namespace isostat
{
namespace
{
using Index = dealii::types::global_dof_index;
static_assert(sizeof(Index) == sizeof(unsigned));

/// Nodes that a tie of opposite faces removes, with the node that stays.
template <int dim>
std::map<Index, Index> tied_nodes(const dealii::DoFHandler<dim> &nodes)
{
  std::map<Index, Index> masters;
  if constexpr (dim > 1)
    {
      dealii::IndexSet relevant;
      dealii::DoFTools::extract_locally_relevant_dofs(nodes, relevant);
      dealii::AffineConstraints<double> ties(relevant);
      for (int axis = 0; axis + 1 < dim; ++axis)
        dealii::DoFTools::make_periodicity_constraints(nodes, 2 * axis, 2 * axis + 1, axis, ties);
      ties.close();
      for (const auto &line : ties.get_lines())
        masters[line.index] = line.entries.at(0).first;
    }
  return masters;
}

Index master_of(const std::map<Index, Index> &masters, Index node)
{
  const auto found = masters.find(node);
  return found == masters.end() ? node : found->second;
}

/// Unknowns that this rank's cells use, one component for each of `masters`.
template <int dim>
VectorPartition partition(const dealii::DoFHandler<dim> &nodes, const HangingNodes<dim> &hanging,
                          std::span<const std::map<Index, Index>> masters, MPI_Comm communicator)
{
  const Index n = masters.size(), total = nodes.n_dofs() * n;
  dealii::IndexSet owned(total), used(total);
  const dealii::IndexSet &owned_nodes = nodes.locally_owned_dofs();
  if (owned_nodes.n_elements() > 0)
    owned.add_range(owned_nodes.nth_index_in_set(0) * n,
                    (owned_nodes.nth_index_in_set(0) + owned_nodes.n_elements()) * n);
  for (const auto &cell : nodes.active_cell_iterators())
    if (cell->is_locally_owned())
      for (Index node : hanging.of_cell(cell).nodes)
        for (Index c = 0; c < n; ++c)
          used.add_index(master_of(masters[c], node) * n + c);
  used.compress();
  return std::make_shared<const dealii::Utilities::MPI::Partitioner>(owned, used, communicator);
}
} // namespace

template <int dim>
Unknowns<dim>::Unknowns(const MeshSpec &spec, const Supports &supports, bool shared_out, MPI_Comm communicator)
    : communicator_(communicator), mesh_(make_mesh<dim>(spec, supports.tied_sides, shared_out, communicator)),
      displacement_element_(spec.degree), pressure_element_(1), nodes_(*mesh_), pressures_(*mesh_)
{
  nodes_.distribute_dofs(displacement_element_);
  pressures_.distribute_dofs(pressure_element_);
  hanging_ = HangingNodes<dim>(nodes_);
  hanging_pressures_ = HangingNodes<dim>(pressures_);
  if (supports.tied_sides)
    {
      masters_.fill(tied_nodes(nodes_));
      pressure_masters_ = tied_nodes(pressures_);
    }
  tie_faces(supports);
  displacement_partition_ = partition<dim>(nodes_, hanging_, masters_, communicator_);
  pressure_partition_ = partition<dim>(pressures_, hanging_pressures_, std::span(&pressure_masters_, 1), communicator_);
}

/// Faces whose nodes move together: the node with the smallest number stays.
template <int dim>
void Unknowns<dim>::tie_faces(const Supports &supports)
{
  for (const FaceComponent &tie : supports.together)
    {
      const int id = boundary_id<dim>(tie.face);
      if (id < 0)
        throw InputError("supports: a face of an axis that is not meshed; remove it");
      std::vector<Index> on_face;
      dealii::DoFTools::extract_boundary_dofs(nodes_, dealii::ComponentMask(),
                                              {static_cast<dealii::types::boundary_id>(id)})
          .fill_index_vector(on_face);
      std::erase_if(on_face, [this](Index node) { return hanging_.hangs(node); });
      Masters &masters = masters_[tie.component];
      Index minimum = nodes_.n_dofs();
      for (Index node : on_face)
        minimum = std::min(minimum, master_of(masters, node));
      MPI_Allreduce(MPI_IN_PLACE, &minimum, 1, MPI_UNSIGNED, MPI_MIN, communicator_);
      for (Index node : on_face)
        if (node != minimum)
          masters[node] = minimum;
    }
}

template <int dim>
unsigned Unknowns<dim>::dof_of_node(Index node, unsigned component) const
{
  return displacement_partition_->global_to_local(master_of(masters_[component], node) * 3 + component);
}

template <int dim>
unsigned Unknowns<dim>::pressure_of_node(Index node) const
{
  return pressure_partition_->global_to_local(master_of(pressure_masters_, node));
}

template class Unknowns<1>;
template class Unknowns<2>;
template class Unknowns<3>;
} // namespace isostat

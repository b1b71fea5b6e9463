// SPDX-License-Identifier: BSD-3-Clause
// Mesh, unknowns and ties.
#include "fem/space/discretisation.hpp"

#include "base/error.hpp"
#include "fem/space/axes.hpp"

#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/lac/affine_constraints.h>

#include <fmt/format.h>

namespace isostat
{
namespace
{
using Index = dealii::types::global_dof_index;

int n_ranks(MPI_Comm communicator)
{
  int size = 1;
  MPI_Comm_size(communicator, &size);
  return size;
}

void check(const MeshSpec &mesh, int dim)
{
  if (mesh.degree != 1 && mesh.degree != 2)
    throw InputError(fmt::format("mesh: degree = {}; must be 1 or 2", mesh.degree));
  if (mesh.soil.layers.empty())
    throw InputError("mesh: no layers; give at least one");
  for (const Layer &layer : mesh.soil.layers)
    {
      if (!(layer.thickness > 0))
        throw InputError(fmt::format("layer {}: thickness = {} m; must be > 0", layer.name, layer.thickness));
      if (layer.n_cells() == 0)
        throw InputError(fmt::format("layer {}: no cells; give at least one", layer.name));
      if (!(layer.density > 0))
        throw InputError(fmt::format("layer {}: density = {} kg/m3; must be > 0", layer.name, layer.density));
      if (!(layer.permeability >= 0))
        throw InputError(fmt::format("layer {}: permeability = {} m/s; must be >= 0", layer.name, layer.permeability));
    }
  for (int k = 0; k + 1 < dim; ++k)
    if (!(mesh.width[k] > 0) || mesh.cells_across[k] == 0)
      throw InputError(
          fmt::format("mesh: {} m wide in {} cells; both must be > 0", mesh.width[k], mesh.cells_across[k]));
}

/// Heights of the cells from the base up.
std::vector<double> cell_heights(const SoilProfile &soil)
{
  std::vector<double> heights;
  for (auto layer = soil.layers.rbegin(); layer != soil.layers.rend(); ++layer)
    heights.insert(heights.end(), layer->n_cells(), layer->thickness / layer->n_cells());
  return heights;
}

template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> empty_mesh(bool shared_out, MPI_Comm communicator)
{
  if constexpr (dim > 1)
    if (shared_out)
      return std::make_unique<dealii::parallel::distributed::Triangulation<dim>>(communicator);
  return std::make_unique<dealii::Triangulation<dim>>();
}

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

/// Unknowns that this rank's cells use, `n_components` to a node.
template <int dim>
std::shared_ptr<const dealii::Utilities::MPI::Partitioner>
partition(const dealii::DoFHandler<dim> &nodes, std::span<const std::map<Index, Index>> masters, MPI_Comm communicator)
{
  const Index n = masters.size(), total = nodes.n_dofs() * n;
  dealii::IndexSet owned(total), used(total);
  const dealii::IndexSet &owned_nodes = nodes.locally_owned_dofs();
  if (owned_nodes.n_elements() > 0)
    owned.add_range(owned_nodes.nth_index_in_set(0) * n,
                    (owned_nodes.nth_index_in_set(0) + owned_nodes.n_elements()) * n);
  std::vector<Index> of_cell(nodes.get_fe().n_dofs_per_cell());
  for (const auto &cell : nodes.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        cell->get_dof_indices(of_cell);
        for (Index node : of_cell)
          for (Index c = 0; c < n; ++c)
            used.add_index(master_of(masters[c], node) * n + c);
      }
  used.compress();
  return std::make_shared<const dealii::Utilities::MPI::Partitioner>(owned, used, communicator);
}
} // namespace

template <int dim>
Discretisation<dim>::Discretisation(const MeshSpec &mesh, const Supports &supports, MPI_Comm communicator)
    : mesh_(mesh), supports_(supports), communicator_(communicator), shared_out_(dim > 1 && n_ranks(communicator) > 1),
      displacement_element_(std::max(mesh.degree, 1u)), pressure_element_(1)
{
  check(mesh_, dim);
  if (dim == 1)
    communicator_ = MPI_COMM_SELF;
  make_mesh();
  make_unknowns();
  make_tables();
  make_frequencies();
}

template <int dim>
void Discretisation<dim>::make_mesh()
{
  triangulation_ = empty_mesh<dim>(shared_out_, communicator_);
  std::vector<std::vector<double>> steps;
  dealii::Point<dim> low, high;
  for (int axis = 0; axis + 1 < dim; ++axis)
    {
      steps.emplace_back(mesh_.cells_across[axis], mesh_.width[axis] / mesh_.cells_across[axis]);
      high[axis] = mesh_.width[axis];
    }
  steps.push_back(cell_heights(mesh_.soil));
  for (double h : steps.back())
    high[dim - 1] += h;
  dealii::GridGenerator::subdivided_hyper_rectangle(*triangulation_, steps, low, high, true);
  if constexpr (dim > 1)
    if (supports_.tied_sides)
      {
        std::vector<dealii::GridTools::PeriodicFacePair<typename dealii::Triangulation<dim>::cell_iterator>> pairs;
        for (int axis = 0; axis + 1 < dim; ++axis)
          dealii::GridTools::collect_periodic_faces(*triangulation_, 2 * axis, 2 * axis + 1, axis, pairs);
        triangulation_->add_periodicity(pairs);
      }
}

/// Faces whose nodes move together: the node with the smallest number stays.
template <int dim>
void Discretisation<dim>::tie_faces()
{
  for (const FaceComponent &tie : supports_.together)
    {
      const int id = boundary_id<dim>(tie.face);
      if (id < 0)
        throw InputError("supports: a face of an axis that is not meshed");
      dealii::IndexSet on_face;
      dealii::DoFTools::extract_boundary_dofs(nodes_, dealii::ComponentMask(), on_face,
                                              {static_cast<dealii::types::boundary_id>(id)});
      std::map<Index, Index> &masters = masters_[tie.component];
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
void Discretisation<dim>::make_unknowns()
{
  nodes_.reinit(*triangulation_);
  nodes_.distribute_dofs(displacement_element_);
  pressures_.reinit(*triangulation_);
  pressures_.distribute_dofs(pressure_element_);
  if (supports_.tied_sides)
    {
      masters_.fill(tied_nodes(nodes_));
      pressure_masters_ = tied_nodes(pressures_);
    }
  static_assert(sizeof(Index) == sizeof(unsigned));
  tie_faces();
  displacement_partition_ = partition<dim>(nodes_, masters_, communicator_);
  pressure_partition_ = partition<dim>(pressures_, std::span(&pressure_masters_, 1), communicator_);
}

template <int dim>
unsigned Discretisation<dim>::dof_of_node(Index node, unsigned component) const
{
  return displacement_partition_->global_to_local(master_of(masters_[component], node) * 3 + component);
}

template <int dim>
unsigned Discretisation<dim>::pressure_of_node(Index node) const
{
  return pressure_partition_->global_to_local(master_of(pressure_masters_, node));
}

template class Discretisation<1>;
template class Discretisation<2>;
template class Discretisation<3>;
} // namespace isostat

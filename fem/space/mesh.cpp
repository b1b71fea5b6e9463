// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/mesh.hpp"

#include "base/error.hpp"

#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <fmt/format.h>

namespace isostat
{
namespace
{
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

/// Heights of the cells from the base up, m.
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

template <int dim>
void tie_sides(dealii::Triangulation<dim> &mesh)
{
  if constexpr (dim > 1)
    {
      std::vector<dealii::GridTools::PeriodicFacePair<typename dealii::Triangulation<dim>::cell_iterator>> pairs;
      for (int axis = 0; axis + 1 < dim; ++axis)
        dealii::GridTools::collect_periodic_faces(mesh, 2 * axis, 2 * axis + 1, axis, pairs);
      mesh.add_periodicity(pairs);
    }
}
} // namespace

template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> make_mesh(const MeshSpec &spec, bool tied_sides, bool shared_out,
                                                      MPI_Comm communicator)
{
  check(spec, dim);
  auto mesh = empty_mesh<dim>(shared_out, communicator);
  std::vector<std::vector<double>> steps;
  dealii::Point<dim> low, high;
  for (int axis = 0; axis + 1 < dim; ++axis)
    {
      steps.emplace_back(spec.cells_across[axis], spec.width[axis] / spec.cells_across[axis]);
      high[axis] = spec.width[axis];
    }
  steps.push_back(cell_heights(spec.soil));
  for (double h : steps.back())
    high[dim - 1] += h;
  dealii::GridGenerator::subdivided_hyper_rectangle(*mesh, steps, low, high, true);
  if (tied_sides)
    tie_sides(*mesh);
  return mesh;
}

template std::unique_ptr<dealii::Triangulation<1>> make_mesh<1>(const MeshSpec &, bool, bool, MPI_Comm);
template std::unique_ptr<dealii::Triangulation<2>> make_mesh<2>(const MeshSpec &, bool, bool, MPI_Comm);
template std::unique_ptr<dealii::Triangulation<3>> make_mesh<3>(const MeshSpec &, bool, bool, MPI_Comm);
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "fem/space/mesh.hpp"

#include "base/error.hpp"

#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

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
      if (!mesh.given && !(layer.thickness > 0))
        throw InputError(fmt::format("layer {}: thickness = {} m; must be > 0", layer.name, layer.thickness));
      if (!mesh.given && layer.n_cells() == 0)
        throw InputError(fmt::format("layer {}: no cells; give at least one", layer.name));
      if (!(layer.density > 0))
        throw InputError(fmt::format("layer {}: density = {} kg/m3; must be > 0", layer.name, layer.density));
      if (!(layer.permeability >= 0))
        throw InputError(fmt::format("layer {}: permeability = {} m/s; must be >= 0", layer.name, layer.permeability));
    }
  if (mesh.given && mesh.given->dimension != static_cast<unsigned>(dim))
    throw InputError(
        fmt::format("mesh: given in {} dimensions, meshed in {}; must be the same", mesh.given->dimension, dim));
  if (mesh.given)
    return;
  for (int k = 0; k + 1 < dim; ++k)
    if (!(mesh.width[k] > 0) || mesh.cells_across[k] == 0)
      throw InputError(
          fmt::format("mesh: {} m wide in {} cells; both must be > 0", mesh.width[k], mesh.cells_across[k]));
  if (mesh.ground.is_level())
    return;
  mesh.ground.check();
  if (dim != 2)
    throw InputError(fmt::format("ground in {} dimensions; must be in 2", dim));
  if (std::abs(mesh.ground.highest() - mesh.soil.height()) > 1e-6 * mesh.soil.height())
    throw InputError(fmt::format("ground: its highest point is {} m above the base, the layers reach {} m; must be the "
                                 "same",
                                 mesh.ground.highest(), mesh.soil.height()));
}

/// What lies between ends, of which the first is above 0, times the size of a unit.
std::vector<double> sizes_between(const std::vector<double> &ends, double unit)
{
  std::vector<double> sizes;
  for (std::size_t k = 0; k < ends.size(); ++k)
    sizes.push_back(unit * (ends[k] - (k > 0 ? ends[k - 1] : 0)));
  return sizes;
}

/// Heights of the cells from the base up, m.
std::vector<double> cell_heights(const MeshSpec &mesh)
{
  std::vector<double> heights;
  for (std::size_t k = 0; k < mesh.soil.layers.size(); ++k)
    {
      const Layer &layer = mesh.soil.layers[k];
      const std::vector<double> of_layer = sizes_between(mesh.cell_ends(2, k), layer.thickness / layer.n_cells());
      heights.insert(heights.begin(), of_layer.rbegin(), of_layer.rend());
    }
  return heights;
}

/// Marks each cell with its number and its layer: CellMark.   @pre layers are level, the mesh is whole
template <int dim>
void mark_cells(const SoilProfile &soil, dealii::Triangulation<dim> &mesh)
{
  for (const auto &cell : mesh.active_cell_iterators())
    cell->set_material_id(
        CellMark{cell->active_cell_index(), static_cast<unsigned>(soil.layer_at(cell->center()[dim - 1]))}.packed(
            soil.layers.size()));
}

/// Raises the level surface to the ground, and all below it in proportion.
template <int dim>
void shape_ground(const MeshSpec &spec, dealii::Triangulation<dim> &mesh)
{
  const double height = spec.soil.height();
  dealii::GridTools::transform(
      [&](const dealii::Point<dim> &point) {
        dealii::Point<dim> moved = point;
        moved[dim - 1] *= spec.ground.at(point[0]) / height;
        return moved;
      },
      mesh);
}

/// A block of rectangles.
template <int dim>
void make_block(const MeshSpec &spec, dealii::Triangulation<dim> &mesh)
{
  std::vector<std::vector<double>> steps;
  dealii::Point<dim> low, high;
  for (int axis = 0; axis + 1 < dim; ++axis)
    {
      steps.push_back(sizes_between(spec.cell_ends(axis), spec.width[axis] / spec.cells_across[axis]));
      high[axis] = spec.width[axis];
    }
  steps.push_back(cell_heights(spec));
  for (double h : steps.back())
    high[dim - 1] += h;
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, steps, low, high, true);
  mark_cells(spec.soil, mesh);
  if (!spec.ground.is_level())
    shape_ground(spec, mesh);
}

/// The mesh as it was given.
template <int dim>
void make_given(const MeshSpec &spec, dealii::Triangulation<dim> &mesh)
{
  using namespace dealii;
  if constexpr (dim > 1)
    {
      std::vector<Point<dim>> places;
      for (const Place &place : spec.given->places)
        for (int d = 0; d < dim; ++d)
          (d == 0 ? places.emplace_back() : places.back())[d] = place[mesh_axes[dim][d]];
      std::vector<CellData<dim>> cells;
      for (const auto &[corners, layer] : spec.given->cells)
        {
          const CellMark mark{static_cast<unsigned>(cells.size()), layer};
          cells.emplace_back().vertices.assign(corners.begin(), corners.begin() + (1 << dim));
          cells.back().material_id = mark.packed(spec.soil.layers.size());
        }
      std::vector<CellData<dim - 1>> sides;
      for (const auto &[corners, face] : spec.given->sides)
        {
          sides.emplace_back().vertices.assign(corners.begin(), corners.begin() + (1 << (dim - 1)));
          sides.back().boundary_id = static_cast<types::boundary_id>(boundary_id<dim>(face));
        }
      SubCellData of_boundary;
      if constexpr (dim == 2)
        of_boundary.boundary_lines = sides;
      else
        of_boundary.boundary_quads = sides;
      GridTools::invert_cells_with_negative_measure(places, cells);
      GridTools::consistently_order_cells(cells);
      mesh.create_triangulation(places, cells, of_boundary);
    }
}

/// Gives the faces of elements that a patch covers its number.
/// @throws InputError  a patch of a face that is not meshed, or whose ends are not on boundaries between elements
template <int dim>
void cut_patch(const MeshSpec &spec, std::size_t k, dealii::Triangulation<dim> &mesh)
{
  const Patch &patch = spec.patches[k];
  if (dim == 1 || is_patch(patch.of) || boundary_id<dim>(patch.of) < 0)
    throw InputError(fmt::format("patch {}: must be of a face of a mesh in 2 or 3 dimensions", k));
  const int along = patch.of == Face::base || patch.of == Face::surface ? 0 : dim - 1;
  const auto id = static_cast<dealii::types::boundary_id>(boundary_id<dim>(patch.of));
  double from = patch.to, to = patch.from;
  for (const auto &cell : mesh.active_cell_iterators())
    for (const auto &face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == id && face->center()[along] > patch.from &&
          face->center()[along] < patch.to)
        {
          face->set_boundary_id(static_cast<dealii::types::boundary_id>(boundary_id<dim>(patch_face(k))));
          for (unsigned v = 0; v < face->n_vertices(); ++v)
            {
              from = std::min(from, face->vertex(v)[along]);
              to = std::max(to, face->vertex(v)[along]);
            }
        }
  const double near = 1e-6 * (patch.to - patch.from);
  if (!(std::abs(from - patch.from) <= near && std::abs(to - patch.to) <= near))
    throw InputError(fmt::format("patch {} from {} m to {} m: its elements reach from {:.6g} m to {:.6g} m; must begin "
                                 "and end on boundaries between elements, inside its face",
                                 k, patch.from, patch.to, from, to));
}

/// The mesh, each rank with a part of it.
template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> shared(const dealii::Triangulation<dim> &whole, MPI_Comm communicator)
{
  auto mesh =
      std::make_unique<dealii::parallel::distributed::Triangulation<dim>>(communicator, whole.get_mesh_smoothing());
  mesh->copy_triangulation(whole);
  return mesh;
}

template <int dim>
bool lies_in(const Refinement &box, const dealii::Point<dim> &point)
{
  const Place place = place_of<dim>(point);
  return std::ranges::all_of(mesh_axes[dim],
                             [&](int axis) { return place[axis] > box.from[axis] && place[axis] < box.to[axis]; });
}

/// The same for any number of ranks.
template <int dim>
void halve_cells(const MeshSpec &spec, dealii::Triangulation<dim> &mesh)
{
  const unsigned most = std::ranges::max_element(spec.refine, {}, &Refinement::levels)->levels;
  for (unsigned level = 0; level < most; ++level)
    {
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned() && std::ranges::any_of(spec.refine, [&](const Refinement &box) {
              return cell->level() < static_cast<int>(box.levels) && lies_in<dim>(box, cell->center());
            }))
          cell->set_refine_flag();
      mesh.execute_coarsening_and_refinement();
    }
}

/// Centres of the cells' faces on a side and their levels in place of the axis across it, sorted.
template <int dim>
std::vector<dealii::Point<dim>> levels_on_side(const dealii::Triangulation<dim> &mesh, unsigned axis, unsigned side)
{
  std::vector<dealii::Point<dim>> faces;
  for (const auto &cell : mesh.active_cell_iterators())
    for (const auto &face : cell->face_iterators())
      if (face->at_boundary() && face->boundary_id() == 2 * axis + side)
        {
          faces.push_back(face->center());
          faces.back()[axis] = cell->level();
        }
  std::ranges::sort(faces, [](const auto &one, const auto &other) {
    for (unsigned d = 0; d < dim; ++d)
      if (std::abs(one[d] - other[d]) > 1e-9)
        return one[d] < other[d];
    return false;
  });
  return faces;
}

/// Cells in the boxes of the spec are halved, and numbered again.   @param whole  of a mesh that is shared out
/// @throws InputError  a box without a cell, or that ends within one side of two that are tied
template <int dim>
void refine(const MeshSpec &spec, bool tied_sides, dealii::Triangulation<dim> &mesh, dealii::Triangulation<dim> *whole)
{
  dealii::Triangulation<dim> &all = whole ? *whole : mesh;
  const std::size_t n_layers = spec.soil.layers.size();
  for (std::size_t k = 0; k < spec.refine.size(); ++k)
    {
      bool is_empty = true;
      for (const auto &cell : all.active_cell_iterators())
        is_empty = is_empty && !lies_in<dim>(spec.refine[k], cell->center());
      if (is_empty)
        throw InputError(fmt::format("refine.{}: no element has its centre in the box; give a larger one", k));
    }
  halve_cells(spec, all);
  // Halves keep the mark of the cell that they were; with the way to them it says which they are on any rank.
  const auto way = [](const auto &cell) {
    const auto halves = cell->id().get_child_indices();
    return std::pair(cell->material_id(), std::vector<unsigned>(halves.begin(), halves.end()));
  };
  std::map<std::pair<unsigned, std::vector<unsigned>>, unsigned> marks;
  for (const auto &cell : all.active_cell_iterators())
    {
      const CellMark mark{cell->active_cell_index(), CellMark::of(cell->material_id(), n_layers).layer};
      if (whole)
        marks[way(cell)] = mark.packed(n_layers);
      cell->set_material_id(mark.packed(n_layers));
    }
  for (unsigned axis = 0; tied_sides && axis + 1 < dim; ++axis)
    if (!std::ranges::equal(levels_on_side(all, axis, 0), levels_on_side(all, axis, 1),
                            [](const auto &one, const auto &other) { return one.distance(other) < 1e-6; }))
      throw InputError("refine: elements at opposite sides, which are tied, must be refined alike; let both ends of a "
                       "box reach a side, or none, or give the block walls");
  if (!whole)
    return;
  halve_cells(spec, mesh);
  for (const auto &cell : mesh.active_cell_iterators())
    if (!cell->is_artificial())
      cell->set_material_id(marks.at(way(cell)));
}

template <int dim>
void tie_sides(dealii::Triangulation<dim> &mesh)
{
  if constexpr (dim > 1)
    {
      std::vector<dealii::GridTools::PeriodicFacePair<typename dealii::Triangulation<dim>::cell_iterator>> pairs;
      try
        {
          for (int axis = 0; axis + 1 < dim; ++axis)
            dealii::GridTools::collect_periodic_faces(mesh, 2 * axis, 2 * axis + 1, axis, pairs);
          mesh.add_periodicity(pairs);
        }
      catch (const dealii::ExceptionBase &)
        {
          throw InputError("mesh: opposite sides do not have corners at the same heights, so they cannot be tied. Draw "
                           "them alike, or give the block walls.");
        }
    }
}
} // namespace

template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> make_mesh(const MeshSpec &spec, bool tied_sides, bool shared_out,
                                                      MPI_Comm communicator)
{
  check(spec, dim);
  auto mesh =
      std::make_unique<dealii::Triangulation<dim>>(dealii::Triangulation<dim>::limit_level_difference_at_vertices);
  if (spec.given)
    make_given(spec, *mesh);
  else
    make_block(spec, *mesh);
  for (std::size_t k = 0; k < spec.patches.size(); ++k)
    cut_patch(spec, k, *mesh);
  std::unique_ptr<dealii::Triangulation<dim>> whole;
  if constexpr (dim > 1)
    if (shared_out)
      {
        whole = std::move(mesh);
        mesh = shared(*whole, communicator);
      }
  if (tied_sides)
    tie_sides(*mesh);
  if (!spec.refine.empty())
    refine(spec, tied_sides, *mesh, whole.get());
  return mesh;
}

template std::unique_ptr<dealii::Triangulation<1>> make_mesh<1>(const MeshSpec &, bool, bool, MPI_Comm);
template std::unique_ptr<dealii::Triangulation<2>> make_mesh<2>(const MeshSpec &, bool, bool, MPI_Comm);
template std::unique_ptr<dealii::Triangulation<3>> make_mesh<3>(const MeshSpec &, bool, bool, MPI_Comm);
} // namespace isostat

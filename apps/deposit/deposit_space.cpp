// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/deposit_space.hpp"

#include "fem/water/drainage.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace isostat
{
namespace
{
/// M of a layer at a height, infinite if its material does not say. Pa
double constrained_modulus(const ColumnScene &scene, const SoilProfile &soil, const ColumnLayer &layer, double z,
                           const UserMaterials &user)
{
  constexpr double unknown = std::numeric_limits<double>::infinity();
  if (layer.material == LayerMaterial::grains) // which costs a specimen
    return unknown;
  const std::array<Stress, 1> stress{level_stress(scene, soil, layer.k0, z)};
  try
    {
      const std::unique_ptr<Material> material = layer_material(layer, 1, user);
      material->set_initial_stress(stress);
      std::array<WaveModuli, 1> moduli;
      material->wave_moduli(moduli);
      return moduli[0].p;
    }
  catch (const std::exception &) // which soil_material() meets again, unless it is the one point that it minds
    {
      return unknown;
    }
}

Supports supports_of(const ColumnScene &scene)
{
  if (scene.analysis.kind == AnalysisKind::biaxial)
    return {.fixed = {{Face::base, 2}, {Face::surface, 2}}};
  Supports supports = shaken_supports(scene.base.compliant(), scene.mesh.sides, scene.mesh.dimension);
  if (scene.water.drained_base)
    supports.drained.push_back(Face::base);
  if (scene.analysis.kind != AnalysisKind::plate)
    return supports;
  supports.fixed.push_back({patch_face(0), scene.plate.axis()});
  supports.fixed.push_back({patch_face(0), 1}); // plane strain
  if (scene.plate.rough)
    supports.fixed.push_back({patch_face(0), 2 - scene.plate.axis()});
  return supports;
}

MeshSpec cut_mesh(const ColumnScene &scene, const UserMaterials &user)
{
  MeshSpec mesh = mesh_spec(scene);
  if (scene.analysis.kind != AnalysisKind::consolidation || mesh.given)
    return mesh;
  std::vector<double> moduli;
  double top = mesh.soil.height();
  for (const ColumnLayer &layer : scene.layers)
    {
      moduli.push_back(constrained_modulus(scene, mesh.soil, layer, top - layer.thickness / 2, user));
      top -= layer.thickness;
    }
  const auto planes = drainage_planes(mesh, supports_of(scene).drained, moduli, scene.analysis.first_time);
  mesh.fine.assign(planes.begin(), planes.end());
  return mesh;
}

/// Cells at a side of a box whose elements are refined, from the surface down.
std::vector<GivenMesh::Length> cells_at(MeshSpec box, double x)
{
  box.degree = 1;
  const Discretisation<2> block(box, {});
  std::vector<GivenMesh::Length> lengths;
  for (std::size_t cell = 0; cell < block.n_cells(); ++cell)
    {
      std::vector<double> ends;
      for (std::size_t k = 4 * cell; k < 4 * cell + 4; ++k)
        if (std::abs(block.corner[k][0] - x) < 1e-9 * box.width[0])
          ends.push_back(block.corner[k][2]);
      if (ends.size() == 2)
        lengths.push_back({std::min(ends[0], ends[1]), std::max(ends[0], ends[1]), block.cell_layer[cell]});
    }
  std::ranges::sort(lengths, std::greater(), &GivenMesh::Length::high);
  return lengths;
}

/// The ground of a box at x, and the numbers that its layers have in the scene.
std::pair<MeshSpec, std::vector<unsigned>> column_at(const ColumnScene &scene, double x)
{
  const MeshSpec box = mesh_spec(scene);
  MeshSpec column{.soil = box.soil, .degree = box.degree, .points_per_direction = box.gauss_points(2)};
  std::vector<unsigned> numbers;
  if (!box.refine.empty())
    {
      column.soil.layers.clear();
      for (const auto &[low, high, layer] : cells_at(box, x))
        {
          column.soil.layers.push_back(box.soil.layers[layer]);
          column.soil.layers.back().thickness = high - low;
          column.soil.layers.back().cells = 1;
          numbers.push_back(layer);
        }
      return {column, numbers};
    }
  if (box.given)
    {
      column.soil = box.given->borehole(box.soil, x);
      for (const auto &[low, high, layer] : box.given->on_vertical(x))
        numbers.push_back(layer);
      return {column, numbers};
    }
  for (Layer &layer : column.soil.layers)
    {
      layer.cells = layer.n_cells();
      layer.thickness *= box.ground_at({x, 0, 0}) / box.soil.height();
      numbers.push_back(static_cast<unsigned>(numbers.size()));
    }
  return {column, numbers};
}

template <int dim>
std::unique_ptr<FiniteElementSpace> made(const MeshSpec &mesh, const Supports &supports, MPI_Comm communicator)
{
  return std::make_unique<Discretisation<dim>>(mesh, supports, communicator);
}
} // namespace

std::unique_ptr<FiniteElementSpace> discretised(const ColumnScene &scene, const MeshSpec &mesh,
                                                const Supports &supports)
{
  constexpr std::array of_dimension = {made<1>, made<2>, made<3>};
  return of_dimension[scene.mesh.dimension - 1](mesh, supports,
                                                scene.mesh.distributed ? MPI_COMM_WORLD : MPI_COMM_SELF);
}

std::unique_ptr<const FiniteElementSpace> deposit_space(const ColumnScene &scene, const UserMaterials &user)
{
  std::unique_ptr<FiniteElementSpace> space = discretised(scene, cut_mesh(scene, user), supports_of(scene));
  if (scene.analysis.kind != AnalysisKind::biaxial)
    return space;
  std::vector<unsigned> &fixed = space->fixed_dofs;
  fixed.push_back(static_cast<unsigned>(space->find_dof({scene.mesh.width / 2, 0, 0}, 0)));
  for (unsigned i = 1; i < space->displacement_vector().locally_owned_size(); i += 3)
    fixed.push_back(i);
  std::ranges::sort(fixed);
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  return space;
}

std::vector<std::shared_ptr<FreeField>> free_fields(const ColumnScene &scene, const DynamicsSettings &settings,
                                                    int threads, const UserMaterials &user)
{
  std::vector<std::shared_ptr<FreeField>> fields;
  if (scene.mesh.sides != Sides::free_field)
    return fields;
  ColumnScene alone = scene; // a column is a whole on every rank
  alone.mesh.distributed = false;
  for (const Face side : {Face::x_low, Face::x_high})
    {
      const double x = side == Face::x_low ? 0 : scene.mesh.width;
      auto [mesh, layers] = column_at(scene, x);
      auto space = std::make_unique<Discretisation<1>>(mesh, supports_of(alone));
      CellTables tables = *space; // with the places and layers of the scene
      for (Place &place : tables.position)
        place[0] = x;
      for (unsigned &layer : tables.cell_layer)
        layer = layers[layer];
      auto material = soil_material(alone, tables, threads, user).material;
      fields.push_back(std::make_shared<FreeField>(side, std::move(space), std::move(material), settings));
    }
  return fields;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "apps/biaxial/material.hpp"

#include "apps/deposit/soil_material.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
/// Specimen of every point. Those of the weak zone are not drawn.
std::vector<SpecimenRequest> requests(const BiaxialScene &scene, const Discretisation<2> &space)
{
  std::vector<SpecimenRequest> all;
  for (const auto &place : space.position)
    {
      SpecimenRequest &request =
          all.emplace_back(in_weak_zone(scene, place) ? scene.weak.grains : drawn(scene.soil.grains, place));
      if (!request.relative_density)
        request.relative_density = scene.soil.grains.relative_density;
    }
  return all;
}

std::unique_ptr<Material> formula_block(const BiaxialScene &scene, const Discretisation<2> &space)
{
  std::vector<std::size_t> places[2];
  for (std::size_t q = 0; q < space.n_points(); ++q)
    places[in_weak_zone(scene, space.position[q])].push_back(q);
  ColumnLayer weak = scene.soil;
  *weak.shear_modulus *= scene.weak.factor;
  weak.iwan.strength_ratio *= scene.weak.factor;
  weak.iwan.phase_transformation_ratio *= scene.weak.factor;
  weak.mohr_coulomb = weakened(weak.mohr_coulomb, scene.weak.factor);
  std::vector<CompositeMaterial::Part> parts;
  for (int k = 0; k < 2; ++k)
    if (!places[k].empty())
      parts.push_back({formula_material(k ? weak : scene.soil, places[k].size()), places[k]});
  return std::make_unique<CompositeMaterial>(std::move(parts));
}

MeshSpec mesh_of(const BiaxialScene &scene)
{
  Layer layer;
  layer.thickness = scene.mesh.height;
  layer.k0 = 1;
  layer.cells = scene.mesh.cells_up;
  layer.porosity = scene.water.porosity;
  layer.permeability = scene.water.permeability;
  MeshSpec mesh;
  mesh.soil.layers = {layer};
  mesh.width = {scene.mesh.width, 1};
  mesh.cells_across = {scene.mesh.cells_across, 1};
  mesh.degree = scene.mesh.degree;
  mesh.points_per_direction = scene.mesh.points;
  return mesh;
}
} // namespace

BlockMesh::BlockMesh(const BiaxialScene &scene)
    : Discretisation<2>(
          mesh_of(scene),
          {.tied_sides = false, .fixed = {{Face::base, 2}, {Face::surface, 2}}, .together = {}, .drained = {}})
{
  fixed_dofs.push_back(static_cast<unsigned>(find_dof({scene.mesh.width / 2, 0, 0}, 0)));
  for (unsigned i = 1; i < displacement_vector().locally_owned_size(); i += 3)
    fixed_dofs.push_back(i);
  std::sort(fixed_dofs.begin(), fixed_dofs.end());
  fixed_dofs.erase(std::unique(fixed_dofs.begin(), fixed_dofs.end()), fixed_dofs.end());
}

bool in_weak_zone(const BiaxialScene &scene, const std::array<double, 3> &place)
{
  const auto inside = [&](double x, double size, unsigned cells, unsigned first) {
    const double cell = x / size * cells;
    return cell > first && cell < first + scene.weak.cells;
  };
  return inside(place[0], scene.mesh.width, scene.mesh.cells_across, scene.weak.column) &&
         inside(place[2], scene.mesh.height, scene.mesh.cells_up, scene.weak.row);
}

BlockMaterial block_material(const BiaxialScene &scene, const Discretisation<2> &space, int threads)
{
  BlockMaterial block;
  if (scene.has_grains())
    {
      RveMaterialSettings settings = scene.grains;
      check_seeds(settings.library, scene.soil.grains, settings.realisations, "soil", "soil");
      settings.undrained = false;
      settings.threads = threads;
      auto grains = std::make_unique<RveMaterial>(requests(scene, space), settings, MPI_COMM_SELF);
      block.grains = grains.get();
      block.material = std::move(grains);
    }
  else
    block.material = formula_block(scene, space);
  if (scene.nonlocal.length > 0)
    {
      auto nonlocal =
          std::make_unique<Nonlocal>(std::move(block.material), scene.nonlocal, space.position, space.weight);
      block.nonlocal = nonlocal.get();
      block.material = std::move(nonlocal);
    }
  const double p = -scene.test.confinement;
  block.material->set_initial_stress(std::vector<Stress>(space.n_points(), Stress{p, p, p, 0, 0, 0}));
  return block;
}
} // namespace isostat

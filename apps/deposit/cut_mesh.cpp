// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/cut_mesh.hpp"

#include "fem/water/drainage.hpp"

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
} // namespace

MeshSpec cut_mesh(const ColumnScene &scene, const UserMaterials &user)
{
  MeshSpec mesh = mesh_spec(scene);
  if (scene.analysis.kind != AnalysisKind::consolidation)
    return mesh;
  std::vector<double> moduli;
  double top = mesh.soil.height();
  for (const ColumnLayer &layer : scene.layers)
    {
      moduli.push_back(constrained_modulus(scene, mesh.soil, layer, top - layer.thickness / 2, user));
      top -= layer.thickness;
    }
  const auto planes = drainage_planes(mesh, {Face::surface}, moduli, scene.analysis.first_time);
  mesh.fine.assign(planes.begin(), planes.end());
  return mesh;
}
} // namespace isostat

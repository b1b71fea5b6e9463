// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/resistance.hpp"

#include "apps/deposit/layer_curve.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace isostat
{
namespace
{
/// As in_situ_stress(), Pa.
double surcharge_on_all(const ColumnScene &scene) { return scene.load.bears_on_all() ? scene.load.surcharge : 0; }

/// Vertical effective stress in situ at top and bottom of a layer, of a mesh from a file in the middles of its highest
/// and lowest triangle, Pa.
std::array<double, 2> end_stresses(const ColumnScene &scene, const SoilProfile &soil, std::size_t layer)
{
  const double surcharge = surcharge_on_all(scene);
  std::array<double, 2> ends;
  if (!scene.mesh.given)
    {
      const double middle = soil.height() - scene.layers[layer].in_situ_depth, half = soil.layers[layer].thickness / 2;
      for (std::size_t end : {0, 1})
        ends[end] = soil.vertical_effective_stress(end == 0 ? middle + half : middle - half, surcharge);
      return ends;
    }
  ends = {std::numeric_limits<double>::max(), 0};
  const MeshSpec mesh = mesh_spec(scene);
  for (const GivenMesh::Part &part : scene.mesh.given->parts(static_cast<unsigned>(layer)))
    {
      const double stress = surcharge + mesh.vertical_effective_stress(part.middle);
      ends = {std::min(ends[0], stress), std::max(ends[1], stress)};
    }
  return ends;
}
} // namespace

Stress middle_stress(const ColumnScene &scene, std::size_t layer)
{
  if (scene.analysis.kind == AnalysisKind::biaxial)
    return {-scene.biaxial.confinement, -scene.biaxial.confinement, -scene.biaxial.confinement, 0, 0, 0};
  const SoilProfile soil = soil_profile(scene);
  double z = soil.height() - soil.layers[layer].thickness / 2;
  for (std::size_t k = 0; k < layer; ++k)
    z -= soil.layers[k].thickness;
  const double surcharge = surcharge_on_all(scene), k0 = soil.layers[layer].k0;
  double vertical = 0;
  if (scene.mesh.given)
    vertical =
        surcharge + scene.mesh.given->mean(static_cast<unsigned>(layer), [mesh = mesh_spec(scene)](const Place &place) {
          return mesh.vertical_effective_stress(place);
        });
  else
    vertical = soil.vertical_effective_stress(z, surcharge);
  return {-k0 * vertical, -k0 * vertical, -vertical, 0, 0, 0};
}

std::optional<double> layer_resistance(const ColumnScene &scene, std::size_t layer)
{
  const ColumnLayer &soil = scene.layers[layer];
  if (soil.material != LayerMaterial::iwan || !soil.sand_density.given())
    return {};
  return resistance(soil.sand_density, -middle_stress(scene, layer)[2]);
}

ColumnLayer resisting_layer(const ColumnScene &scene, std::size_t layer)
{
  ColumnLayer soil = scene.layers[layer];
  if (soil.material != LayerMaterial::iwan)
    return soil;
  try
    {
      soil.iwan =
          resisting(soil.sand(), soil.sand_density, middle_stress(scene, layer), [&](const IwanParameters &sand) {
            ColumnLayer tried = soil;
            tried.iwan = sand;
            return damped_material(tried, 1);
          });
    }
  catch (const InputError &error)
    {
      throw InputError(fmt::format("layer.{} ({}): {}.", layer, soil.name, error.what()));
    }
  return soil;
}

std::vector<ColumnLayer> resisting_layers(const ColumnScene &scene)
{
  std::vector<ColumnLayer> layers;
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    layers.push_back(resisting_layer(scene, k));
  return layers;
}

std::vector<std::string> resistance_warnings(const ColumnScene &scene, const std::vector<ColumnLayer> &layers)
{
  constexpr double most = 0.1; // of K_sigma
  const SoilProfile profile = soil_profile(scene);
  std::vector<std::string> warnings;
  for (std::size_t k = 0; k < scene.layers.size(); ++k)
    {
      const std::optional<double> ratio = layer_resistance(scene, k);
      if (!ratio)
        continue;
      const ColumnLayer &soil = scene.layers[k];
      const Stress stress = middle_stress(scene, k);
      const double strength = soil.sand().strength_ratio * (stress[0] + stress[1] + stress[2]) / (3 * stress[2]);
      if (layers[k].iwan.contraction == 0)
        warnings.push_back(fmt::format("layer.{} ({}) does not liquefy: its cyclic resistance of {:.3g} sigma'_v0 "
                                       "comes up to its strength, {:.3g} sigma'_v0, so it does not contract in shear. "
                                       "Check its strength_ratio.",
                                       k, soil.name, *ratio, strength));
      if (scene.analysis.kind == AnalysisKind::biaxial)
        continue;
      const auto factor = [&](double vertical) { return overburden_factor(soil.sand_density, std::max(1., vertical)); };
      double largest = 0;
      for (const double vertical : end_stresses(scene, profile, k))
        largest = std::max(largest, std::abs(factor(vertical) / factor(-stress[2]) - 1));
      if (largest > most)
        warnings.push_back(fmt::format("layer.{} ({}) has the cyclic resistance of its middle, from which that of its "
                                       "top or bottom differs by {:.0f} %. Split the layer.",
                                       k, soil.name, 100 * largest));
    }
  return warnings;
}
} // namespace isostat

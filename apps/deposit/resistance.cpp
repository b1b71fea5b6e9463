// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/resistance.hpp"

#include "apps/deposit/layer_curve.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
Stress middle_stress(const ColumnScene &scene, std::size_t layer)
{
  if (scene.analysis.kind == AnalysisKind::biaxial)
    return {-scene.biaxial.confinement, -scene.biaxial.confinement, -scene.biaxial.confinement, 0, 0, 0};
  const SoilProfile soil = soil_profile(scene);
  double z = soil.height() - soil.layers[layer].thickness / 2;
  for (std::size_t k = 0; k < layer; ++k)
    z -= soil.layers[k].thickness;
  const double surcharge = scene.load.bears_on_all() ? scene.load.surcharge : 0; // as in_situ_stress()
  const double k0 = soil.layers[layer].k0,
               vertical = scene.mesh.given ? surcharge + mesh_spec(scene).vertical_effective_stress(
                                                             scene.mesh.given->middle(static_cast<unsigned>(layer)))
                                           : soil.vertical_effective_stress(z, surcharge);
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
  const double surcharge = scene.load.bears_on_all() ? scene.load.surcharge : 0;
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
      const double middle = profile.height() - soil.in_situ_depth;
      const auto factor = [&](double height) {
        return overburden_factor(soil.sand_density, std::max(1., profile.vertical_effective_stress(height, surcharge)));
      };
      double largest = 0;
      for (const double way : {-soil.thickness / 2, soil.thickness / 2})
        largest = std::max(largest, std::abs(factor(middle + way) / factor(middle) - 1));
      if (largest > most)
        warnings.push_back(fmt::format("layer.{} ({}) has the cyclic resistance of its middle, from which that of its "
                                       "top or bottom differs by {:.0f} %. Split the layer.",
                                       k, soil.name, 100 * largest));
    }
  return warnings;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/resistance.hpp"

#include "apps/deposit/layer_curve.hpp"
#include "base/scene/document.hpp"

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
  const double vertical = soil.vertical_effective_stress(z, surcharge), k0 = soil.layers[layer].k0;
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

void check_resistance(const SceneDocument &document, const ColumnScene &scene, std::size_t layer)
{
  const std::optional<double> ratio = layer_resistance(scene, layer);
  if (!ratio)
    return;
  const ColumnLayer &soil = scene.layers[layer];
  const Stress stress = middle_stress(scene, layer);
  const double strength = soil.sand().strength_ratio * (stress[0] + stress[1] + stress[2]) / (3 * stress[2]);
  const SandDensity &density = soil.sand_density;
  const char *key = density.n1_60cs ? "n1_60cs" : density.qc1ncs ? "qc1ncs" : "relative_density";
  if (*ratio >= strength)
    document.refuse(
        fmt::format("layer.{}.{}", layer, key),
        fmt::format(
            "gives a cyclic resistance of {:.3g} sigma'_v0 in the middle of the layer, where its "
            "strength is {:.3g} sigma'_v0. Give a higher strength_ratio or shear_strength, a k0 nearer to 1, or a "
            "lower value.",
            *ratio, strength));
}
} // namespace isostat

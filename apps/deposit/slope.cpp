// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/slope.hpp"

#include "base/scene/document.hpp"
#include "base/scene/ranges.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr const char *water_choices[] = {"seepage", "submerged"};
constexpr double near = 1e-6; ///< m
/// Friction angle beyond that of any packing, deg. Dense ones reach q/p' = 1.61 in compression, which is 39 deg
/// (docs/results/paper.md); dense sands at a few kPa some 50.
constexpr double largest_friction = 60;

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

// clang-format off
constexpr Key in_slope[] = {
  {.path = "angle", .field = member<&Slope::tangent>, .unit = unit::deg, .value = "0 deg", .range = {0, 60},
   .reason = "because x points down the slope, and no slope of soil is steeper than 60 deg",
   .text = "Inclination of the surface to the horizontal. Less than the soil can bear; packings must not need more "
           "than 60 deg of friction."},
  {.path = "water", .field = member<&Slope::water>, .value = "seepage", .choices = water_choices,
   .text = "Water that flows parallel to the surface, below a water table parallel to it, and drags the soil "
           "downslope; or a slope submerged by water at rest. Ignored without water."},
};
// clang-format on

/// f(layer, depth, stresses there) at the ends of all stretches of uniform density and buoyancy. In a stretch stresses
/// are linear over the depth, so that the ratio of two is largest at an end; where nothing lies above it is the same
/// in all of the stretch.
template <typename Visit>
void for_each_end(const ColumnScene &scene, const Visit &f)
{
  const SoilProfile soil = soil_profile(scene);
  const double height = soil.height();
  double top = 0;
  for (std::size_t k = 0; k < soil.layers.size(); ++k)
    {
      const double bottom = top + soil.layers[k].thickness;
      for (const double depth : {top, std::clamp(soil.water_table, top, bottom), bottom})
        if (const PlaneStress stress = soil.in_situ(height - depth, scene.load.surcharge); stress.normal > 0)
          f(k, depth, stress);
      top = bottom;
    }
}

double mean_pressure(const ColumnLayer &layer, const PlaneStress &stress)
{
  return (1 + 2 * layer.k0) / 3 * stress.normal;
}

bool has_known_strength(const ColumnLayer &layer)
{
  return layer.material == LayerMaterial::iwan || layer.material == LayerMaterial::mohr_coulomb;
}

/// Static shear stress that Iwan sand bears in addition to the deviator of its K0: docs/theory_column.md (33); of a
/// Mohr-Coulomb soil, before it softens, by its circle in the plane. Pa
double shear_strength(const ColumnLayer &layer, const PlaneStress &stress)
{
  if (layer.material == LayerMaterial::mohr_coulomb)
    {
      const double friction = layer.mohr_coulomb.friction, cohesion = layer.mohr_coulomb.cohesion;
      const double mean = (1 + layer.k0) / 2 * stress.normal, half = (1 - layer.k0) / 2 * stress.normal,
                   radius = (mean * friction + cohesion) / std::hypot(1, friction);
      return std::sqrt(std::max(0.0, radius * radius - half * half));
    }
  const double strength = layer.sand().strength_ratio * mean_pressure(layer, stress),
               normal = layer.curve.is_given() ? 0 : (1 - layer.k0) * stress.normal / std::sqrt(3.0);
  return std::sqrt(std::max(0.0, strength * strength - normal * normal));
}

/// Friction angle that packings would have to mobilise at the start: of the largest and the smallest principal stress,
/// or, where they find their horizontal stress themselves, that of the plane along the surface. deg
double mobilised_friction(const ColumnScene &scene, const ColumnLayer &layer, const PlaneStress &stress)
{
  if (scene.grains.in_situ.path == InSituPath::no_lateral_strain)
    return degrees(std::atan(stress.shear / stress.normal));
  const double mean = (1 + layer.k0) / 2 * stress.normal,
               radius = std::hypot((1 - layer.k0) / 2 * stress.normal, stress.shear);
  return degrees(std::asin(std::min(1.0, radius / mean)));
}

/// @throws InputError  packings at a depth that no packing can carry
void check_packings_on_slope(const SceneDocument &document, const ColumnScene &scene, std::size_t k, double depth,
                             const PlaneStress &stress)
{
  const ColumnLayer &layer = scene.layers[k];
  const double friction = mobilised_friction(scene, layer, stress);
  if (friction <= largest_friction)
    return;
  document.refuse(
      "slope.angle",
      fmt::format(
          "is too steep for the packings of layer.{}{}: at a depth of {:.4g} m a static shear stress of {:.4g} kPa "
          "at a normal effective stress of {:.4g} kPa{} mobilises {}, and no packing "
          "carries more than {:g} deg. Give a smaller slope.angle, a k0 nearer to 1, or a deeper water.table.",
          k, layer.name.empty() ? "" : " (" + layer.name + ")", depth, stress.shear / 1e3, stress.normal / 1e3,
          scene.grains.in_situ.path == InSituPath::no_lateral_strain
              ? ""
              : fmt::format(" and with k0 = {}", number_text(layer.k0)),
          friction > 89.9 ? "more than any friction" : fmt::format("a friction angle of {:.3g} deg", friction),
          largest_friction));
}

/// Distance of a depth to the nearest boundary between elements, and that boundary. m
std::array<double, 2> nearest_boundary(const ColumnScene &scene, double depth)
{
  std::array<double, 2> best = {depth, 0};
  double top = 0;
  for (const ColumnLayer &layer : scene.layers)
    {
      const unsigned n = std::max(1u, layer.n_cells());
      for (unsigned k = 1; k <= n; ++k)
        if (const double z = top + layer.thickness * k / n; std::abs(z - depth) < best[0])
          best = {std::abs(z - depth), z};
      top += layer.thickness;
    }
  return best;
}

void check_table(const SceneDocument &document, const ColumnScene &scene)
{
  const double table = scene.water.table;
  if (table == 0)
    return;
  if (scene.water.drainage == Drainage::dry)
    document.refuse("water.table", "has no meaning if water.drainage is \"dry\". Give drainage = \"undrained\" or "
                                   "\"coupled\", or remove it.");
  double top = 0; // depth
  for (const ColumnLayer &layer : scene.layers)
    {
      if (layer.material == LayerMaterial::grains && scene.water.drainage == Drainage::undrained && top < table - near)
        document.refuse("water.table", "must not be below the top of packings if water.drainage is \"undrained\", as "
                                       "packings then keep their volume. Give drainage = \"coupled\" with a "
                                       "permeability of 0 m/s.");
      top += layer.thickness;
    }
  if (scene.slope.water == SlopeWater::submerged)
    document.refuse("water.table", "must be 0 m if slope.water is \"submerged\": the water is above the surface. "
                                   "Remove one of them.");
  if (table >= scene.height() - near)
    document.refuse("water.table", fmt::format("must be less than the height of the soil, {} m. Give drainage = "
                                               "\"dry\" if there is no water.",
                                               number_text(scene.height())));
  const SoilProfile soil = soil_profile(scene);
  const bool has_cells =
      soil.layers[soil.layer_at(soil.height() - table)].n_cells() > 0; // else choose_cells() minds it
  if (const auto [distance, boundary] = nearest_boundary(scene, table); has_cells && distance > near)
    document.refuse("water.table", fmt::format("must be on a boundary between elements, of which the nearest is at {} "
                                               "m. Give that, or end a layer at the table.",
                                               number_text(boundary)));
}
} // namespace

SceneFragment<Slope> slope_keys() { return {in_slope}; }

std::optional<SlopeSafety> slope_safety(const ColumnScene &scene)
{
  std::optional<SlopeSafety> least;
  for_each_end(scene, [&](std::size_t k, double depth, const PlaneStress &stress) {
    const ColumnLayer &layer = scene.layers[k];
    if (!has_known_strength(layer) || stress.shear <= 0)
      return;
    const double factor = shear_strength(layer, stress) / stress.shear;
    if (!least || factor < least->factor)
      least = {factor, depth, k};
  });
  return least;
}

void check_slope(const SceneDocument &document, const ColumnScene &scene)
{
  check_table(document, scene);
  for_each_end(scene, [&](std::size_t k, double depth, const PlaneStress &stress) {
    const ColumnLayer &layer = scene.layers[k];
    if (layer.material == LayerMaterial::grains && stress.shear > 0)
      check_packings_on_slope(document, scene, k, depth, stress);
    if (!has_known_strength(layer) || stress.shear <= 0)
      return;
    if (stress.shear > shear_strength(layer, stress))
      {
        const char *key = layer.material == LayerMaterial::iwan ? "strength_ratio" : "friction_angle";
        document.refuse(
            fmt::format("layer.{}.{}", k, key),
            fmt::format(
                "is too low for a stable slope: at a depth of {:.4g} m the static shear stress is {:.4g} kPa, at a "
                "normal effective stress of {:.4g} kPa and with k0 = {}. Give a smaller slope.angle, a larger {}, a "
                "k0 nearer to 1, or a deeper water.table.",
                depth, stress.shear / 1e3, stress.normal / 1e3, number_text(layer.k0), key));
      }
  });
}
} // namespace isostat

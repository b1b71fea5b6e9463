// SPDX-License-Identifier: BSD-3-Clause
#include "fem/water/pore_fluid_scene.hpp"

#include "base/scene/ranges.hpp"

namespace isostat
{
namespace
{
using namespace ranges;
constexpr const char *air_names[] = {"constant", "boyle"};

// clang-format off
constexpr Key of_water[] = {
  {.path = "relative_viscosity", .field = member<&Water::relative_viscosity>, .value = "1", .range = positive,
   .reason = "because it divides the permeability",
   .text = "Viscosity of the pore fluid over that of water, for which permeabilities are given: in a centrifuge at N g "
           "a fluid N times as viscous as water (docs/theory_column.md)."},
  {.path = "air", .field = member<&Water::air>, .value = "constant", .choices = air_names,
   .text = "constant: air in the pores has the stiffness of its pressure in situ; boyle: it follows Boyle's law at the "
           "pressure of the moment, stiffer and at last dissolved when the pressure rises, softer when it falls "
           "(cavitation). A consolidation takes constant alone. boyle needs air, by `layer.saturation` or `henry`."},
  {.path = "henry", .field = member<&Water::henry>, .value = "0", .range = {0, 0.1},
   .reason = "because water dissolves no less than nothing, and of air 0.02 at 20 C",
   .text = "Volume of air, at its pressure, that a volume of water dissolves at once: 0.02 at 20 C; 0: none, as if the "
           "shaking were too short for it. Above 0 only where the volume may change: drainage \"coupled\", or "
           "undrained with `lagged_compressibility`."},
  {.path = "atmospheric_pressure", .field = member<&Water::atmospheric_pressure>, .unit = unit::kPa,
   .value = "101.325 kPa", .range = {5000, infinity}, .reason = "because water boils at 2.3 kPa",
   .text = "Absolute pressure at the water table, which air in the pores feels beside that of the water below it. On a "
           "submerged slope add the weight of the water above the surface."},
};

constexpr Key of_layers[] = {
  {.path = "saturation", .field = member<&Layer::saturation>, .value = "1", .range = {0.8, 1},
   .reason = "because water fills no more than the pores, and below 0.8 their air has a pressure of its own",
   .text = "Volume of water over that of the pores in situ; the rest is air: 1/K_f = S/K_w + (1 - S)/p_abs (Wood), "
           "p_abs the absolute pressure of the water at rest. Below 1 only below the water table, and where the volume "
           "may change (`water.henry`)."},
};
// clang-format on
} // namespace

SceneFragment<Water> pore_fluid_keys() { return {of_water}; }
SceneFragment<Layer> saturation_keys() { return {of_layers}; }
} // namespace isostat

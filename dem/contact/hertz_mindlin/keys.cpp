// SPDX-License-Identifier: BSD-3-Clause
// The parameters as keys of a scene; all else that knows them by name follows from this table.
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/contact/rolling_resistance_keys.hpp"

namespace isostat
{
namespace
{
// clang-format off
constexpr auto keys_of_law = with_rolling_resistance(std::array{
  Key{.path = "young", .field = member<&HertzMindlin::young>, .unit = unit::GPa, .value = "64.96 GPa",
      .range = ranges::moduli, .reason = ranges::because_moduli,
      .text = "Young's modulus of the grains. The default is that of quartz, 2 (1 + nu) G with G = 29 GPa and nu = "
              "0.12."},
  Key{.path = "poisson", .field = member<&HertzMindlin::poisson>, .value = "0.12", .range = {0, 0.5},
      .reason = "because a grain is an isotropic elastic body that does not bulge when it is pulled",
      .text = "Poisson's ratio nu of the grains; tangential over normal stiffness is 2 (1 - nu)/(2 - nu)."},
  Key{.path = "exponent", .field = member<&HertzMindlin::exponent>, .value = "1.5", .range = {1.5, 2},
      .reason = "because 1.5 is that of spheres and 2 that of cones",
      .text = "n of the normal force, which rises with the overlap to this power. Above 1.5 grains touch with pointed "
              "asperities: they are softer under small forces and stiffer under large ones, and the modulus of a "
              "packing rises more with pressure."},
  Key{.path = "asperity", .field = member<&HertzMindlin::asperity>, .value = "0.1", .range = {1e-3, 1},
      .reason = "because an asperity is a part of its grain",
      .text = "Radius of an asperity over R* = R1 R2/(R1 + R2): there it is as high as a sphere, nearer to the axis "
              "more pointed. Of no effect with the exponent 1.5."},
});
// clang-format on
} // namespace

std::span<const Key> HertzMindlin::keys() const { return keys_of_law; }
} // namespace isostat

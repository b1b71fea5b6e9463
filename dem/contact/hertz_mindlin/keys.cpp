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
  Key{.path = "young", .kind = Kind::quantity, .dimension = Dimension::pressure, .unit = "GPa",
   .value = "64.96 GPa", .range = ranges::positive,
   .text = "Young's modulus of the grains. The default is that of quartz, 2 (1 + nu) G with G = 29 GPa and nu = 0.12.",
   .field = law_field<&HertzMindlin::young>},
  Key{.path = "poisson", .value = "0.12", .range = {0, 0.5},
   .reason = "because a grain is an isotropic elastic body that does not bulge when it is pulled",
   .text = "Poisson's ratio nu of the grains; tangential over normal stiffness is 2 (1 - nu)/(2 - nu).",
   .field = law_field<&HertzMindlin::poisson>},
});
// clang-format on
} // namespace

std::span<const Key> HertzMindlin::keys() const { return keys_of_law; }
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// The parameters as keys of a scene; all else that knows them by name follows from this table.
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/contact/rolling_resistance_keys.hpp"

namespace isostat
{
namespace
{
// clang-format off
constexpr auto keys_of_law = with_rolling_resistance(std::array{
  Key{.path = "young", .field = member<&LinearRolling::young>, .unit = unit::GPa, .value = "10 GPa",
      .range = ranges::moduli, .reason = ranges::because_moduli,
      .text = "Contact modulus E; the normal stiffness is 2 E R1 R2/(R1+R2)."},
  Key{.path = "stiffness_ratio", .field = member<&LinearRolling::stiffness_ratio>, .value = "0.3",
      .range = ranges::to_ten,
      .reason = "because without tangential stiffness friction does not act (leave friction out instead), and no law of " "contact has more than a few times the normal one",
      .text = "Tangential over normal stiffness, ks/kn."},
});
// clang-format on
} // namespace

std::span<const Key> LinearRolling::keys() const { return keys_of_law; }
} // namespace isostat

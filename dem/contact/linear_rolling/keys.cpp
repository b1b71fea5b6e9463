// SPDX-License-Identifier: BSD-3-Clause
// The parameters as keys of a scene; all else that knows them by name follows from this table.
#include "base/scene/ranges.hpp"
#include "dem/contact/law_parameters.hpp"
#include "dem/contact/linear_rolling/law.hpp"

namespace isostat
{
namespace
{
using ranges::positive;

// clang-format off
constexpr Key keys_of_law[] = {
  {.path = "young", .kind = Kind::quantity, .dimension = Dimension::pressure, .unit = "GPa",
   .value = "10 GPa", .range = positive, .text = "Contact modulus E; the normal stiffness is 2 E R1 R2/(R1+R2).",
   .field = law_field<&LinearRolling::young>},
  {.path = "stiffness_ratio", .value = "0.3", .range = positive,
   .reason = "because without tangential stiffness friction does not act (leave friction out instead)",
   .text = "Tangential over normal stiffness, ks/kn.",
   .field = law_field<&LinearRolling::stiffness_ratio>},
  {.path = "friction", .kind = Kind::quantity, .dimension = Dimension::angle, .unit = "deg",
   .presence = Presence::experiment, .value = "18 deg", .range = ranges::right_angle,
   .reason = ranges::because_tan,
   .text = "Angle of friction between grains while the specimen is tested; left out or 0 deg: frictionless, and "
           "then without rolling and twisting resistance too. Walls are always frictionless.",
   .field = law_field<&LinearRolling::friction>},
  {.path = "rolling", .kind = Kind::table, .presence = Presence::experiment,
   .value = "{ stiffness = 0.3, limit = 0.5 }", .text = "Rolling resistance; left out: none.",
   .field = law_field<&LinearRolling::rolling>},
  {.path = "rolling.stiffness", .value = "0.3", .range = positive,
   .reason = "because zero means no resistance (leave the table out instead)",
   .text = "alpha_r: rolling stiffness over R1 R2 ks.",
   .field = law_field<&LinearRolling::rolling_stiffness>},
  {.path = "rolling.limit", .value = "0.5", .range = positive,
   .reason = "because zero means no resistance (leave the table out instead)",
   .text = "eta_r: the rolling moment stays below eta_r min(R1,R2) times the normal force.",
   .field = law_field<&LinearRolling::rolling_limit>},
  {.path = "twisting", .kind = Kind::table, .presence = Presence::experiment, .value = "{ stiffness = 0.3 }",
   .text = "Twisting resistance, elastic without limit; left out: none.",
   .field = law_field<&LinearRolling::twisting>},
  {.path = "twisting.stiffness", .value = "0.3", .range = positive,
   .reason = "because zero means no resistance (leave the table out instead)",
   .text = "alpha_t: twisting stiffness over R1 R2 ks; not given in the paper.",
   .field = law_field<&LinearRolling::twisting_stiffness>},
};
// clang-format on
} // namespace

std::span<const Key> LinearRolling::keys() const { return keys_of_law; }
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/friction.hpp"

#include "base/scene/ranges.hpp"

namespace isostat
{
void Friction::begin(const StageContext &c) const
{
  Law law = c.assembly.law();
  law->friction = friction;
  c.assembly.set_law(law);
}

std::vector<Key> Friction::keys()
{
  return {{.path = "friction",
           .kind = Kind::quantity,
           .dimension = Dimension::angle,
           .unit = "deg",
           .presence = Presence::required,
           .value = "18 deg",
           .range = ranges::right_angle,
           .reason = ranges::because_tan,
           .text = "Angle of friction between grains from here on.",
           .field = InStage<&Friction::friction>{}}};
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/undrained_cyclic.hpp"

#include "base/scene/ranges.hpp"

namespace isostat
{
std::vector<Key> UndrainedCyclic::keys()
{
  return keys_with({.path = "deviator_amplitude",
                    .kind = Kind::quantity,
                    .dimension = Dimension::pressure,
                    .unit = "kPa",
                    .value = "60 kPa",
                    .range = ranges::positive,
                    .text = "q_amp: loading turns when |q| reaches it.",
                    .field = InStage<&UndrainedCyclic::deviator_amplitude>{}},
                   {.path = "until.strain",
                    .value = "0.15",
                    .range = ranges::to_one,
                    .reason = "because this is a strain, not percent",
                    .text = "When the amount of the axial strain exceeds this.",
                    .field = InStage<&CyclicConstantVolume::max_strain>{}});
}
} // namespace isostat

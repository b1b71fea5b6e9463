// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/undrained_cyclic_simple_shear.hpp"

#include "base/scene/ranges.hpp"

namespace isostat
{
std::vector<Key> UndrainedCyclicSimpleShear::keys()
{
  return keys_with({.path = "stress_ratio",
                    .value = "0.15",
                    .range = ranges::to_one,
                    .reason = "because this is a ratio of stresses that friction has to carry",
                    .text = "tau_amp over the vertical effective stress at the start of the stage (CSR): loading turns "
                            "when |tau| reaches tau_amp.",
                    .field = InStage<&UndrainedCyclicSimpleShear::stress_ratio>{}},
                   {.path = "until.strain",
                    .value = "0.15",
                    .range = ranges::to_ten,
                    .reason = "because this is a shear strain, not percent: 1 is 100 percent",
                    .text = "When the amount of the shear strain gamma_xy exceeds this.",
                    .field = InStage<&CyclicConstantVolume::max_strain>{}});
}
} // namespace isostat

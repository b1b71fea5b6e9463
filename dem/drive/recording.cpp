// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/recording.hpp"

#include <cmath>

namespace isostat
{
bool row_due(const RecordSpec &spec, const RecordMoment &now, const RecordedState &last)
{
  return now.edge || now.notable || std::abs(now.p - last.p) >= spec.record_stress ||
         std::abs(now.load - last.load) >= spec.record_stress ||
         std::abs(now.strain - last.strain) >= spec.record_strain || !last.step ||
         now.step - *last.step >= spec.record_steps;
}

bool snapshot_due(const RecordSpec &spec, const RecordMoment &now, const RecordedState &last)
{
  if (spec.snapshots == "none")
    return false;
  const bool by_strain =
      spec.snapshots == "strain" && std::abs(now.strain - last.snapshot_strain) >= spec.snapshot_strain;
  return now.edge || now.notable || by_strain;
}
} // namespace isostat

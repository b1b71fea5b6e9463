// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/undrained.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
void observe_liquefaction(const Stage &stage, const Observation &seen, DriveState &state, Verdict &verdict)
{
  if (state.liquefied != 0)
    return;
  state.greatest_strain_before = std::max(state.greatest_strain_before, std::abs(seen.axial));
  if (seen.p >= stage.liquefaction_ratio * state.p0)
    return;
  state.liquefied = 1;
  state.liquefaction_step = static_cast<double>(seen.step);
  state.liquefaction_reversals = state.reversals;
  state.liquefaction_strain = seen.axial;
  verdict.notable = true;
  verdict.event =
      fmt::format("initial liquefaction (p'/p0 < {:g}) at step {}, after {:g} reversals, axial strain {:.4g} %",
                  stage.liquefaction_ratio, seen.step, state.reversals, 100 * seen.axial);
}

void turn(const Stage &stage, const Observation &seen, DriveState &state, Verdict &verdict)
{
  state.worst_overshoot = std::max(state.worst_overshoot, std::abs(seen.q) - stage.deviator_amplitude);
  state.reversals += 1;
  state.direction = -state.direction;
  state.signed_rate = 0;
  state.slope = 0;
  state.slope_q = seen.q;
  state.slope_axial = state.axial;
  verdict.notable = true;
  verdict.event = fmt::format("reversal {:g} at step {}: axial strain {:.4g} %, p' {:.2f} kPa, q {:.2f} kPa",
                              state.reversals, seen.step, 100 * seen.axial, seen.p / 1e3, seen.q / 1e3);
}
} // namespace

Verdict observe_undrained(const Stage &stage, const Observation &seen, DriveState &state)
{
  Verdict verdict;
  observe_liquefaction(stage, seen, state, verdict);
  if (stage.kind == StageKind::undrained_monotonic)
    {
      verdict.finished = std::abs(state.axial) >= stage.strain;
      return verdict;
    }
  if (state.direction * seen.q >= stage.deviator_amplitude)
    turn(stage, seen, state, verdict);
  const bool enough_after =
      state.liquefied != 0 &&
      state.reversals >= state.liquefaction_reversals + static_cast<double>(stage.reversals_after_liquefaction);
  verdict.finished = enough_after || state.reversals >= 2.0 * static_cast<double>(stage.max_cycles) ||
                     std::abs(seen.axial) >= stage.max_strain;
  return verdict;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/undrained.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
namespace
{
const char *strain_name(StageKind kind) { return is_simple_shear(kind) ? "gamma" : "axial strain"; }

void observe_liquefaction(const Stage &stage, const Observation &seen, DriveState &state, Verdict &verdict)
{
  if (state.liquefied != 0)
    return;
  const double strain = driven_strain(stage.kind, seen);
  state.max_strain_before = std::max(state.max_strain_before, std::abs(strain));
  if (seen.p >= stage.liquefaction_ratio * state.p0)
    return;
  state.liquefied = 1;
  state.liquefaction_step = static_cast<double>(seen.step);
  state.liquefaction_reversals = state.reversals;
  state.liquefaction_strain = strain;
  verdict.notable = true;
  verdict.event =
      fmt::format("initial liquefaction (p'/p0 < {:g}) at step {}, after {:g} reversals, {} {:.4g} %",
                  stage.liquefaction_ratio, seen.step, state.reversals, strain_name(stage.kind), 100 * strain);
}

void turn(const Stage &stage, const Observation &seen, DriveState &state, Verdict &verdict)
{
  const double load = driven_load(stage.kind, seen);
  state.worst_overshoot = std::max(state.worst_overshoot, std::abs(load) - load_limit(stage, state));
  state.reversals += 1;
  state.direction = -state.direction;
  state.signed_rate = 0;
  state.slope = 0;
  state.slope_q = load;
  state.slope_axial = state.axial;
  verdict.notable = true;
  verdict.event = fmt::format("reversal {:g} at step {}: {} {:.4g} %, p' {:.2f} kPa, {} {:.2f} kPa", state.reversals,
                              seen.step, strain_name(stage.kind), 100 * driven_strain(stage.kind, seen), seen.p / 1e3,
                              is_simple_shear(stage.kind) ? "tau" : "q", load / 1e3);
}
} // namespace

double driven_load(StageKind kind, const Observation &seen) { return is_simple_shear(kind) ? seen.tau : seen.q; }

double driven_strain(StageKind kind, const Observation &seen)
{
  return is_simple_shear(kind) ? seen.gamma : seen.axial;
}

double load_limit(const Stage &stage, const DriveState &state)
{
  if (stage.kind == StageKind::undrained_cyclic)
    return stage.deviator_amplitude;
  return stage.kind == StageKind::undrained_cyclic_simple_shear ? stage.stress_ratio * state.lateral_target[1] : 0.0;
}

Verdict observe_undrained(const Stage &stage, const Observation &seen, DriveState &state)
{
  Verdict verdict;
  observe_liquefaction(stage, seen, state, verdict);
  if (!is_cyclic(stage.kind))
    {
      verdict.finished = std::abs(state.axial) >= stage.strain;
      return verdict;
    }
  if (state.direction * driven_load(stage.kind, seen) >= load_limit(stage, state))
    turn(stage, seen, state, verdict);
  const bool enough_after =
      state.liquefied != 0 &&
      state.reversals >= state.liquefaction_reversals + static_cast<double>(stage.reversals_after_liquefaction);
  verdict.finished = enough_after || state.reversals >= 2.0 * static_cast<double>(stage.max_cycles) ||
                     std::abs(driven_strain(stage.kind, seen)) >= stage.max_strain;
  return verdict;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/constant_volume.hpp"

#include "dem/drive/stages/cyclic_response.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
RigidBox ConstantVolume::next_box(const StageContext &c, const Observation &seen) const
{
  driven_step(c, seen);
  return c.state.path.reference.strained(isochoric(c.state.loading.strain));
}

Mat3 ConstantVolume::next_gradient(const StageContext &c, const Observation &seen) const
{
  return mode().constant_volume(driven_step(c, seen));
}

void LiquefiableShear::note_liquefaction(const Observation &seen, DriveState &state, Verdict &verdict) const
{
  UndrainedRecord &record = state.undrained;
  if (record.liquefaction)
    return;
  record.max_strain_before = std::max(record.max_strain_before, std::abs(strain(seen)));
  if (seen.p >= liquefaction_ratio * state.path.p0())
    return;
  record.liquefaction = Liquefaction{seen.step, record.reversals, strain(seen)};
  verdict.notable = true;
  verdict.event = fmt::format("initial liquefaction (p'/p0 < {:g}) at step {}, after {} reversals, {} {:.4g} %",
                              liquefaction_ratio, seen.step, record.reversals, mode().strain_name, 100 * strain(seen));
}

Verdict LiquefiableShear::reached(const StageContext &c, const Observation &seen) const
{
  DriveState &state = c.state;
  Verdict verdict;
  if (shears() && keeps_volume())
    note_liquefaction(seen, state, verdict);
  if (notes_response())
    follow_response(load(seen), strain(seen), load_amplitude(state), mode(), seen.step, state, verdict);
  const double direction = sign(state.loading.direction);
  if (turns() && (direction * load(seen) >= direction * turning_load(state) ||
                  direction * state.loading.strain >= direction * turning_strain(state)))
    turn_round(c, seen, verdict);
  verdict.end = ends(c, seen);
  return verdict;
}

void LiquefiableShear::turn_round(const StageContext &c, const Observation &seen, Verdict &verdict) const
{
  DriveState &state = c.state;
  UndrainedRecord &record = state.undrained;
  const double now = load(seen), over = sign(state.loading.direction) * (now - turning_load(state));
  if (std::isfinite(over))
    record.worst_overshoot = std::max(record.worst_overshoot, over);
  record.reversals += 1;
  state.loading.direction = opposite(state.loading.direction);
  if (notes_response())
    turn_response(now, state, over >= 0);
  load_from_rest(c, now);
  verdict.notable = true;
  verdict.event =
      fmt::format("reversal {} at step {}: {} {:.4g} %, p' {:.2f} kPa, {} {:.2f} kPa", record.reversals, seen.step,
                  mode().strain_name, 100 * strain(seen), seen.p / 1e3, mode().load_name, now / 1e3);
}

double CyclicConstantVolume::turning_load(const DriveState &state) const
{
  const double sigma_v = state.path.lateral_target[1];
  return average(sigma_v) + sign(state.loading.direction) * amplitude(sigma_v);
}

std::optional<LoadRange> CyclicConstantVolume::required_loads(double sigma_v) const
{
  const double middle = average(sigma_v), low = middle - amplitude(sigma_v), high = middle + amplitude(sigma_v);
  if (middle == 0)
    return std::nullopt;
  return LoadRange{low, high, fmt::format("{} = {:.4g} and {:.4g} kPa", limits_text(), low / 1e3, high / 1e3)};
}

Conditions CyclicConstantVolume::conditions(const StageFigures &reached) const
{
  const std::string after = reached.since_liquefied ? std::to_string(*reached.since_liquefied) : "not liquefied";
  return {
      {EndCondition::cycles,
       fmt::format("until.cycles = {} ({:g} reached)", max_cycles, static_cast<double>(reached.reversals) / 2)},
      {EndCondition::reversals_after_liquefaction,
       fmt::format("until.reversals_after_liquefaction = {} ({})", reversals_after_liquefaction, after)},
      {EndCondition::strain, fmt::format("until.strain = {:g} % ({:.4g} %)", 100 * max_strain, 100 * reached.strain)}};
}

std::optional<EndCondition> CyclicConstantVolume::ends(const StageContext &c, const Observation &seen) const
{
  const UndrainedRecord &record = c.state.undrained;
  if (record.liquefaction && record.reversals >= record.liquefaction->reversals + reversals_after_liquefaction)
    return EndCondition::reversals_after_liquefaction;
  if (record.reversals >= 2 * max_cycles)
    return EndCondition::cycles;
  return std::abs(strain(seen)) >= max_strain ? std::optional(EndCondition::strain) : std::nullopt;
}

std::optional<double> CyclicConstantVolume::fraction_done(const DriveState &state) const
{
  const UndrainedRecord &record = state.undrained;
  if (record.liquefaction && reversals_after_liquefaction > 0)
    return static_cast<double>(record.reversals - record.liquefaction->reversals) /
           static_cast<double>(reversals_after_liquefaction);
  return static_cast<double>(record.reversals) / (2.0 * static_cast<double>(max_cycles));
}
} // namespace isostat

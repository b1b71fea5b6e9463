// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/constant_volume.hpp"

#include "base/scene/ranges.hpp"
#include "dem/drive/strain_path.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
RigidBox ConstantVolume::next_box(const StageContext &c, const Observation &seen) const
{
  driven_step(c, seen);
  return StrainPath{c.state.path.reference}.box(isochoric(c.state.loading.strain));
}

Mat3 ConstantVolume::next_gradient(const StageContext &c, const Observation &seen) const
{
  return mode().constant_volume(driven_step(c, seen));
}

Verdict ConstantVolume::reached(const StageContext &c, const Observation &seen) const
{
  UndrainedRecord &record = c.state.undrained;
  if (record.liquefaction)
    return {};
  const double now = strain(seen);
  record.max_strain_before = std::max(record.max_strain_before, std::abs(now));
  if (seen.p >= liquefaction_ratio * c.state.path.p0())
    return {};
  record.liquefaction = Liquefaction{seen.step, record.reversals, now};
  return {.notable = true,
          .event = fmt::format("initial liquefaction (p'/p0 < {:g}) at step {}, after {} reversals, {} {:.4g} %",
                               liquefaction_ratio, seen.step, record.reversals, mode().strain_name, 100 * now)};
}

Key ConstantVolume::liquefaction_ratio_key()
{
  return {.path = "liquefaction_ratio",
          .value = "0.01",
          .range = ranges::fraction,
          .text = "p'/p0' below which the specimen counts as liquefied.",
          .field = InStage<&ConstantVolume::liquefaction_ratio>{}};
}

Verdict MonotonicConstantVolume::reached(const StageContext &c, const Observation &seen) const
{
  Verdict verdict = ConstantVolume::reached(c, seen);
  verdict.finished = strained_to(c.state, strain_end);
  return verdict;
}

std::vector<Key> MonotonicConstantVolume::keys_with(const Key &strain)
{
  return {direction_key(), strain, liquefaction_ratio_key(), strain_rate_key(), max_steps_key()};
}

Verdict CyclicConstantVolume::reached(const StageContext &c, const Observation &seen) const
{
  Verdict verdict = ConstantVolume::reached(c, seen);
  const UndrainedRecord &record = c.state.undrained;
  if (sign(c.state.loading.direction) * load(seen) >= load_limit(c.state))
    turn(seen, c.state, verdict);
  const bool enough_after =
      record.liquefaction && record.reversals >= record.liquefaction->reversals + reversals_after_liquefaction;
  verdict.finished = enough_after || record.reversals >= 2 * max_cycles || std::abs(strain(seen)) >= max_strain;
  return verdict;
}

void CyclicConstantVolume::turn(const Observation &seen, DriveState &state, Verdict &verdict) const
{
  const double now = load(seen);
  UndrainedRecord &record = state.undrained;
  record.worst_overshoot = std::max(record.worst_overshoot, std::abs(now) - load_limit(state));
  record.reversals += 1;
  Loading &loading = state.loading;
  loading.direction = opposite(loading.direction);
  loading.signed_rate = 0;
  loading.slope = 0;
  loading.window_load = now;
  loading.window_strain = loading.strain;
  verdict.notable = true;
  verdict.event =
      fmt::format("reversal {} at step {}: {} {:.4g} %, p' {:.2f} kPa, {} {:.2f} kPa", record.reversals, seen.step,
                  mode().strain_name, 100 * strain(seen), seen.p / 1e3, mode().load_name, now / 1e3);
}

std::optional<double> CyclicConstantVolume::fraction_done(const DriveState &state) const
{
  const UndrainedRecord &record = state.undrained;
  if (record.liquefaction && reversals_after_liquefaction > 0)
    return static_cast<double>(record.reversals - record.liquefaction->reversals) /
           static_cast<double>(reversals_after_liquefaction);
  return static_cast<double>(record.reversals) / (2.0 * static_cast<double>(max_cycles));
}

std::vector<Key> CyclicConstantVolume::keys_with(const Key &amplitude, const Key &strain)
{
  const Key until = {.path = "until",
                     .kind = Kind::table,
                     .presence = Presence::optional,
                     .value = "{ reversals_after_liquefaction = 10 }",
                     .text = "When the stage ends: at whichever of its conditions comes first.",
                     .field = [](StageBehaviour &) -> Field { return {}; }};
  const Key cycles = {.path = "until.cycles",
                      .kind = Kind::integer,
                      .value = "200",
                      .range = {1, 1e9},
                      .text = "After so many cycles.",
                      .field = InStage<&CyclicConstantVolume::max_cycles>{}};
  const Key reversals = {.path = "until.reversals_after_liquefaction",
                         .kind = Kind::integer,
                         .value = "10",
                         .text =
                             "After so many reversals of loading since p'/p0' first fell below `liquefaction_ratio`.",
                         .field = InStage<&CyclicConstantVolume::reversals_after_liquefaction>{}};
  return {direction_key(), amplitude, liquefaction_ratio_key(), until,          cycles,
          reversals,       strain,    strain_rate_key(),        max_steps_key()};
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/stage_end.hpp"

#include "dem/drive/stages/cycles.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace isostat
{
StageFigures StageBehaviour::figures(const StageContext &c, const Observation &seen) const
{
  const UndrainedRecord &record = c.state.undrained;
  StageFigures now;
  now.driven = std::abs(c.state.loading.strain);
  now.strain = std::abs(strain(seen));
  now.p = seen.p;
  now.q = seen.q;
  now.unbalanced = c.assembly.unbalanced_force_ratio();
  now.reversals = record.reversals;
  if (record.liquefaction)
    now.since_liquefied = record.reversals - record.liquefaction->reversals;
  return now;
}

bool note_end(const StageBehaviour &stage, const StageContext &c, const Observation &seen, EndCondition by)
{
  const ProgrammePlace &place = c.state.place;
  const bool at_once = place.steps == 0 && by != EndCondition::max_steps;
  for (StageEnd &end : c.state.ends)
    if (end.stage == place.stage && end.at_once == at_once && end.by == by)
      {
        end.times += 1;
        return false;
      }
  c.state.ends.push_back({place.stage, place.done, seen.step, 1, at_once, by, stage.figures(c, seen)});
  return true;
}

bool is_early(const StageEnd &end, const std::vector<Stage> &stages)
{
  return end.at_once ||
         (end.by == EndCondition::max_steps && !behaviour(stages[end.stage]).conditions(end.figures).empty());
}

std::string to_text(const Conditions &conditions)
{
  std::string text;
  for (const Condition &condition : conditions)
    text += (text.empty() ? "" : ", ") + condition.text;
  return text;
}

std::string to_text(const StageEnd &end, const std::vector<Stage> &stages)
{
  const StageBehaviour &stage = behaviour(stages[end.stage]);
  const auto *stepped = as<SteppedStage>(stages[end.stage]);
  Conditions met = stage.conditions(end.figures), others;
  std::string how;
  if (end.by == EndCondition::max_steps)
    how = fmt::format("ended by max_steps = {}{}{}", stepped ? stepped->max_steps : 0,
                      met.empty() ? "" : " before any of its conditions was met: ", to_text(met));
  else if (end.at_once)
    how = fmt::format("ended in its first step, because one of its conditions was met when it began: {}", to_text(met));
  else
    {
      std::ranges::copy_if(met, std::back_inserter(others), [&](const Condition &c) { return c.which != end.by; });
      std::erase_if(met, [&](const Condition &c) { return c.which != end.by; });
      how = fmt::format("ended by {}{}{}", to_text(met), others.empty() ? "" : ", before ", to_text(others));
    }
  const std::string more = end.times > 1 ? fmt::format("; {} times in all, the first time here", end.times) : "";
  return fmt::format("stage {} ({}){}: {}{}", end.stage, stage.kind(), cycle_text(stages, end.done), how, more);
}

const char *name_of(EndCondition condition)
{
  constexpr const char *names[] = {
      "max_steps", "strain", "volumetric_strain", "q", "p", "stress_ratio", "cycles", "reversals_after_liquefaction",
      "balance",   "course"};
  static_assert(std::size(names) == static_cast<std::size_t>(last_of(EndCondition{})) + 1);
  return names[static_cast<std::size_t>(condition)];
}
} // namespace isostat

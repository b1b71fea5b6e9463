// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/early_end.hpp"

#include "dem/drive/stages/cycles.hpp"

#include <cmath>
#include <fmt/format.h>

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

bool note_early_end(const StageBehaviour &stage, const StageContext &c, const Observation &seen, bool at_once)
{
  const ProgrammePlace &place = c.state.place;
  const StageFigures figures = stage.figures(c, seen);
  if (stage.conditions(figures).empty())
    return false;
  for (EarlyEnd &end : c.state.early_ends)
    if (end.stage == place.stage && end.at_once == at_once)
      {
        end.times += 1;
        return false;
      }
  c.state.early_ends.push_back({place.stage, place.done, seen.step, 1, at_once, figures});
  return true;
}

std::string to_text(const EarlyEnd &end, const std::vector<Stage> &stages)
{
  const StageBehaviour &stage = behaviour(stages[end.stage]);
  const auto *stepped = as<SteppedStage>(stages[end.stage]);
  const std::string name = fmt::format("stage {} ({}){}", end.stage, stage.kind(), cycle_text(stages, end.done));
  const std::string how = end.at_once ? "ended in its first step, because one of its conditions was met when it began"
                                      : fmt::format("ended by max_steps = {} before any of its conditions was met",
                                                    stepped ? stepped->max_steps : 0);
  const std::string more = end.times > 1 ? fmt::format("; {} times in all, the first time here", end.times) : "";
  return fmt::format("{}: {}: {}{}", name, how, stage.conditions(end.figures), more);
}
} // namespace isostat

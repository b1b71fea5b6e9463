// SPDX-License-Identifier: BSD-3-Clause
// From the history of a test and the driver's state to what is reported of it.
#include "apps/common/test_summary.hpp"

#include "dem/drive/programme.hpp"
#include "dem/drive/stages/cyclic_response.hpp"

#include <algorithm>
#include <cmath>

namespace isostat
{
namespace
{
enum Column
{
  stage,
  eps,
  liquefied,
  p,
  q,
  ir,
  ir_eq2,
  constraints,
  indicator,
  reversals,
  work,
  residual
};

HistoryRows rows_of(const RunHistory &run, bool energy)
{
  std::vector<std::string> names = {"stage", "eps_y",  "liquefied",      "p",         "q",
                                    "IR",    "IR_eq2", "IR_constraints", "indicator", "reversals"};
  if (energy)
    names.insert(names.end(), {"W_boundary", "residual"});
  return run.of(names);
}

bool is_simple_shear(const Stage &stage)
{
  const auto *shear = as<ShearStage>(stage);
  return shear && &shear->mode() == &simple_shear_mode;
}

bool is_cyclic(const Stage &stage)
{
  const auto *path = as<Path>(stage);
  return as<CyclicConstantVolume>(stage) || (path && path->turns());
}

bool turns_at_a_load(const Stage &stage)
{
  const auto *path = as<Path>(stage);
  return as<CyclicConstantVolume>(stage) || (path && (path->turn.low || path->turn.high));
}

bool is_driven(const Stage &stage)
{
  const auto *path = as<Path>(stage);
  return as<ShearStage>(stage) && !(path && path->drive == DrivenComponent::none);
}

/// It looks for liquefaction.
bool may_liquefy(const Stage &stage)
{
  const auto *path = as<Path>(stage);
  return as<ConstantVolume>(stage) || (path && path->shears() && path->keeps_volume());
}

RedundancyOfRow redundancy(const HistoryRows &history, std::size_t row)
{
  return {history(row, ir), history(row, ir_eq2), static_cast<int>(history(row, constraints))};
}

/// The stages of a history's rows.
class StageOfRow
{
public:
  StageOfRow(const HistoryRows &history, const Scene &scene) : history_(history), scene_(scene) {}
  const Stage &operator()(std::size_t row) const
  {
    return scene_.stages[static_cast<std::size_t>(history_(row, stage))];
  }

private:
  const HistoryRows &history_;
  const Scene &scene_;
};

/// I_R in the last row of each half cycle after the onset in which p'/p0 comes back above the ratio, and the smallest.
void add_recoveries(const HistoryRows &history, double limit, LiquefactionRecord &record)
{
  double sum = 0, last = 0, half_cycle = history(record.row, reversals);
  const auto count = [&] {
    sum += last;
    record.n_recoveries += last > 0;
    last = 0;
  };
  for (std::size_t row = record.row + 1; row < history.n_rows(); ++row)
    {
      if (history(row, reversals) != half_cycle)
        count();
      half_cycle = history(row, reversals);
      record.least_redundancy = std::min(record.least_redundancy, history(row, ir));
      if (history(row - 1, p) < limit && history(row, p) >= limit)
        last = history(row, ir);
    }
  count();
  record.recovered = record.n_recoveries > 0 ? sum / record.n_recoveries : 0;
}

std::optional<LiquefactionRecord> liquefaction(const HistoryRows &history, const StageOfRow &stage_of,
                                               const DriveState &state)
{
  std::size_t row = 0;
  while (row < history.n_rows() && history(row, liquefied) == 0)
    ++row;
  if (row == history.n_rows())
    return std::nullopt;
  const Stage &of = stage_of(row);
  LiquefactionRecord record;
  record.row = row;
  record.reversals = static_cast<double>(state.undrained.reversals_to_liquefaction());
  record.simple_shear = is_simple_shear(of);
  record.cyclic = is_cyclic(of);
  record.strain_before = state.undrained.max_strain_before;
  record.ratio = as<LiquefactionLimit>(of)->liquefaction_ratio;
  const std::size_t before = row > 0 ? row - 1 : row;
  record.before = redundancy(history, before);
  record.ratio_before = history(before, p) / state.path.p0();
  record.at_onset = redundancy(history, row);
  record.least_redundancy = record.at_onset.index;
  add_recoveries(history, record.ratio * state.path.p0(), record);
  return record;
}

std::optional<ShearRecord> shear_record(const HistoryRows &history, const StageOfRow &stage_of, double p0)
{
  std::optional<ShearRecord> record;
  for (std::size_t row = 0; row < history.n_rows(); ++row)
    {
      if (!behaviour(stage_of(row)).shears())
        continue;
      if (!record)
        record = ShearRecord{row, p0, p0, redundancy(history, row), {}, {}, {}};
      record->min_p = std::min(record->min_p, history(row, p));
      if (is_driven(stage_of(row)) && history(row, liquefied) == 0 && history(row, indicator) > 0)
        record->max_indicator = std::max(record->max_indicator.value_or(0), history(row, indicator));
      if (is_simple_shear(stage_of(row)))
        continue;
      if (!record->axial)
        record->axial = AxialExtremes{};
      record->axial->strain = std::max(record->axial->strain, std::abs(history(row, eps)));
      record->axial->q = std::max(record->axial->q, std::abs(history(row, q)));
    }
  return record;
}

/// Of two stages the one with a CSR, or with the larger ratio.
bool comes_first(const ShearExtremes &a, const ShearExtremes &b)
{
  const bool has = a.requested_ratio > 0, other_has = b.requested_ratio > 0;
  return has != other_has ? has : a.max_ratio > b.max_ratio;
}

std::optional<ShearExtremes> shear_extremes(const RunHistory &run, const Scene &scene)
{
  if (std::none_of(scene.stages.begin(), scene.stages.end(), is_simple_shear))
    return std::nullopt;
  enum
  {
    at_stage,
    gamma,
    tau,
    sigma_y,
    done
  };
  std::vector<std::string> names = {"stage", "gamma_xy", "tau_xy", "sigma_y"};
  const bool repeated =
      std::any_of(scene.stages.begin(), scene.stages.end(), [](const Stage &s) { return as<Repeat>(s); });
  if (repeated)
    names.push_back("done");
  const HistoryRows history = run.of(names);
  const std::size_t which = repeated ? done : at_stage; // what changes from one stage to the next
  ShearExtremes all, now;
  for (std::size_t row = 0; row < history.n_rows(); ++row)
    {
      const Stage &s = scene.stages[static_cast<std::size_t>(history(row, at_stage))];
      if (!is_simple_shear(s) || !behaviour(s).shears())
        continue;
      if (now.sigma_v0 == 0 || history(row, which) != history(row - 1, which))
        {
          const auto *cyclic = as<UndrainedCyclicSimpleShear>(s);
          now = {0, 0, history(row, sigma_y), 0, cyclic ? cyclic->stress_ratio : 0};
        }
      all.gamma = std::max(all.gamma, std::abs(history(row, gamma)));
      all.tau = std::max(all.tau, std::abs(history(row, tau)));
      now.max_ratio = std::max(now.max_ratio, std::abs(history(row, tau)) / now.sigma_v0);
      if (all.sigma_v0 == 0 || comes_first(now, all))
        all = {all.gamma, all.tau, now.sigma_v0, now.max_ratio, now.requested_ratio};
    }
  return all;
}

double energy_residual(const HistoryRows &history)
{
  double done = 0, worst = 0;
  for (std::size_t row = 1; row < history.n_rows(); ++row)
    {
      done += std::abs(history(row, work) - history(row - 1, work));
      worst = std::max(worst, std::abs(history(row, residual)));
    }
  return done > 0 ? worst / done : 0;
}

void add_specimen(const std::map<std::string, double> &specimen, TestSummary &summary)
{
  const auto number = [&](const char *name, double otherwise) {
    const auto found = specimen.find(name);
    return found == specimen.end() ? otherwise : found->second;
  };
  summary.grains = static_cast<std::size_t>(number("grains", 0));
  summary.void_ratio = number("void_ratio", 0);
  for (auto &[name, value] :
       {std::pair{"relative_density", &summary.relative_density}, {"e_min", &summary.e_min}, {"e_max", &summary.e_max}})
    if (specimen.contains(name))
      *value = specimen.at(name);
  summary.preparation_friction = number("preparation_friction_deg", -1);
}
} // namespace

TestSummary summarise(const RunHistory &run, const Scene &scene, const std::map<std::string, double> &specimen,
                      const DriveState &state, double seconds)
{
  const auto any = [&](bool (*is)(const Stage &)) { return std::ranges::any_of(scene.stages, is); };
  TestSummary summary;
  summary.title = scene.title;
  summary.law = scene.contact->name();
  add_specimen(specimen, summary);
  summary.seconds = seconds;
  summary.cyclic = any(is_cyclic);
  summary.may_liquefy = any(may_liquefy);
  summary.reversals = static_cast<double>(state.undrained.reversals);
  if (state.undrained.reversals > 0 && any(turns_at_a_load))
    summary.worst_overshoot = state.undrained.worst_overshoot;
  summary.losses = state.control.losses;
  summary.stages = stages_text(state, scene);
  summary.ends = told_ends(state, scene);
  for (const Stage &s : scene.stages)
    if (const auto *shear = as<ShearStage>(s);
        shear && shear->notes_response() && (summary.reversals > 0 || state.undrained.response.flow))
      summary.response = response_name(state.undrained, shear->mode());
  summary.drained = drained_stages(run, scene);
  summary.cycles = state.undrained.response;
  const HistoryRows history = rows_of(run, scene.output.energy);
  const StageOfRow stage_of(history, scene);
  for (std::size_t row = 0; row < history.n_rows(); ++row)
    if (const int n = redundancy(history, row).constraints;
        summary.constraints.empty() || n != summary.constraints.back())
      summary.constraints.push_back(n);
  summary.shearing = shear_record(history, stage_of, state.path.p0());
  if (summary.shearing)
    summary.shearing->simple_shear = shear_extremes(run, scene);
  summary.liquefaction = liquefaction(history, stage_of, state);
  if (const std::size_t n = history.n_rows(); n > 0)
    summary.last = LastRow{history(n - 1, p), redundancy(history, n - 1)};
  if (scene.output.energy)
    summary.energy_residual = energy_residual(history);
  return summary;
}
} // namespace isostat

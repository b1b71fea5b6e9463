// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/test_summary.hpp"

#include "base/files/json.hpp"
#include "dem/drive/programme.hpp"
#include "dem/drive/rate_control.hpp"
#include "dem/drive/stages/cyclic_response.hpp"
#include "dem/prepare/relative_density.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>
#include <set>

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
  indicator,
  reversals,
  work,
  residual
};

HistoryRows rows_of(const RunHistory &run, bool energy)
{
  std::vector<std::string> names = {"stage", "eps_y", "liquefied", "p", "q", "IR", "indicator", "reversals"};
  if (energy)
    names.insert(names.end(), {"W_boundary", "residual"});
  return run.of(names);
}

double liquefaction_ratio(const Scene &scene)
{
  for (const Stage &stage : scene.stages)
    if (behaviour(stage).shears())
      {
        const auto *undrained = as<LiquefactionLimit>(stage);
        return undrained ? undrained->liquefaction_ratio : UndrainedMonotonic{}.liquefaction_ratio;
      }
  return UndrainedMonotonic{}.liquefaction_ratio;
}

/// I_R in the last row of each half cycle after liquefaction in which p'/p0 comes back above the ratio, and the
/// smallest.
void add_recoveries(const HistoryRows &history, double limit, TestSummary &summary)
{
  double sum = 0, last = 0, half_cycle = 0;
  const auto count = [&] {
    if (last > 0)
      {
        sum += last;
        summary.n_recoveries += 1;
      }
    last = 0;
  };
  for (std::size_t row = summary.onset_row + 1; summary.liquefied && row < history.n_rows(); ++row)
    {
      if (history(row, reversals) != half_cycle)
        count();
      half_cycle = history(row, reversals);
      summary.redundancy_min = std::min(summary.redundancy_min, history(row, ir));
      if (history(row - 1, p) < limit && history(row, p) >= limit)
        last = history(row, ir);
    }
  count();
  summary.redundancy_recovered = summary.n_recoveries > 0 ? sum / summary.n_recoveries : 0;
}

void add_path(const HistoryRows &history, const Scene &scene, TestSummary &summary)
{
  bool started = false;
  summary.min_p = summary.p0;
  for (std::size_t row = 0; row < history.n_rows(); ++row)
    {
      if (!behaviour(scene.stages[static_cast<std::size_t>(history(row, stage))]).shears())
        continue;
      if (!started)
        {
          summary.first_row = row;
          summary.redundancy_initial = history(row, ir);
          started = true;
        }
      if (!summary.liquefied && history(row, liquefied) != 0)
        {
          summary.liquefied = true;
          summary.onset_row = row;
          summary.redundancy_at_onset = summary.redundancy_min = history(row, ir);
        }
      summary.max_strain = std::max(summary.max_strain, std::abs(history(row, eps)));
      summary.max_q = std::max(summary.max_q, std::abs(history(row, q)));
      summary.min_p = std::min(summary.min_p, history(row, p));
      if (!summary.liquefied)
        summary.max_indicator = std::max(summary.max_indicator, history(row, indicator));
    }
}

/// "I = 4e-05 at p0'" or "2 1/s", of all stages that shear, with their numbers unless they are the same.
std::string rate_text(const Scene &scene)
{
  std::set<std::string> rates;
  std::vector<std::string> lines;
  bool bounded = false;
  for (std::size_t k = 0; k < scene.stages.size(); ++k)
    if (const auto *shear = as<ShearStage>(scene.stages[k]))
      {
        const StageRate rate = rate_in_force(scene.motion, {shear->strain_rate, shear->inertial_number()});
        bounded |= !rate.fixed;
        const std::string text =
            rate.fixed ? fmt::format("{:g} 1/s", *rate.fixed) : fmt::format("I = {:g} at p0'", rate.inertial_number);
        rates.insert(text);
        lines.push_back(fmt::format("stage {}: {}", k, text));
      }
  std::string text = rates.size() == 1 ? *rates.begin() : fmt::format("{}", fmt::join(lines, "; "));
  if (bounded && scene.motion.load_per_wave > 0)
    text += fmt::format(", or less: the load changes by {:g} % of p0' at most in a wave time",
                        100 * scene.motion.load_per_wave);
  return text;
}

bool is_cyclic(const Stage &stage)
{
  const auto *path = as<Path>(stage);
  return as<CyclicConstantVolume>(stage) || (path && path->turns());
}

bool shears_in(const Stage &stage, const ShearMode &mode)
{
  const auto *shear = as<ShearStage>(stage);
  return shear && &shear->mode() == &mode;
}
bool is_simple_shear(const Stage &stage) { return shears_in(stage, simple_shear_mode); }
bool is_axial(const Stage &stage) { return as<ShearStage>(stage) && !is_simple_shear(stage); }

std::optional<ShearExtremes> shear_extremes(const RunHistory &run, const Scene &scene)
{
  if (std::none_of(scene.stages.begin(), scene.stages.end(), is_simple_shear))
    return std::nullopt;
  enum
  {
    at_stage,
    gamma,
    tau,
    sigma_y
  };
  const HistoryRows history = run.of({"stage", "gamma_xy", "tau_xy", "sigma_y"});
  ShearExtremes shear;
  for (const Stage &s : scene.stages)
    if (const auto *cyclic = as<UndrainedCyclicSimpleShear>(s))
      shear.requested_ratio = std::max(shear.requested_ratio, cyclic->stress_ratio);
  for (std::size_t row = 0; row < history.n_rows(); ++row)
    {
      if (!is_simple_shear(scene.stages[static_cast<std::size_t>(history(row, at_stage))]))
        continue;
      if (shear.sigma_v0 == 0)
        shear.sigma_v0 = history(row, sigma_y);
      shear.gamma = std::max(shear.gamma, std::abs(history(row, gamma)));
      shear.tau = std::max(shear.tau, std::abs(history(row, tau)));
    }
  shear.max_ratio = shear.sigma_v0 > 0 ? shear.tau / shear.sigma_v0 : 0;
  return shear;
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
std::string axial_text(const TestSummary &s)
{
  return fmt::format("\n  largest |strain|         {:.4f} %\n  largest |q|, lowest p'   {:.2f} kPa, {:.3f} kPa",
                     100 * s.max_strain, s.max_q / 1e3, s.min_p / 1e3);
}

std::string shear_text(const TestSummary &s)
{
  const ShearExtremes &shear = *s.shear;
  std::string text;
  if (s.axial) // triaxial stages as well
    text = fmt::format("\n  largest |axial strain|   {:.4f} %\n  largest |q|              {:.2f} kPa",
                       100 * s.max_strain, s.max_q / 1e3);
  text += fmt::format("\n  largest |gamma|          {:.4f} %\n  largest |tau|, lowest p' {:.2f} kPa, {:.3f} kPa",
                      100 * shear.gamma, shear.tau / 1e3, s.min_p / 1e3);
  const std::string ratio =
      fmt::format("|tau| reached {:.4f} sigma'_v0, sigma'_v0 {:.2f} kPa", shear.max_ratio, shear.sigma_v0 / 1e3);
  return text + (shear.requested_ratio > 0
                     ? fmt::format("\n  CSR                      {:g} ({})", shear.requested_ratio, ratio)
                     : fmt::format("\n  stress ratio             {}", ratio));
}

/// Members of summary.json that only simple shear has.
Json shear_json(const ShearExtremes &shear)
{
  return {{"gamma_max", shear.gamma},
          {"tau_max", shear.tau},
          {"sigma_v0", shear.sigma_v0},
          {"stress_ratio_max", shear.max_ratio},
          {"CSR", shear.requested_ratio > 0 ? Json(shear.requested_ratio) : Json()}};
}

Json or_null(std::optional<double> value) { return value ? Json(*value) : Json(); }

/// "D_r = 0.640 (e_min 0.568, e_max 0.841)"
std::string density_text(const TestSummary &s)
{
  if (!s.relative_density)
    return "D_r unknown (no e_min and e_max)";
  const std::string limits =
      s.e_min && s.e_max ? fmt::format(" (e_min {:g}, e_max {:g})", *s.e_min, *s.e_max) : std::string();
  return fmt::format("D_r = {:.3f}{}{}", *s.relative_density, limits, density_remark(*s.relative_density));
}

Json liquefaction_json(const TestSummary &s)
{
  if (!s.liquefied)
    return nullptr;
  return {{"row", s.onset_row},
          {"cycle", s.cycles_to_liquefaction},
          {"strain_before", s.strain_before},
          {"IR_at_onset", s.redundancy_at_onset},
          {"IR_min", s.redundancy_min},
          {"IR_recovered", s.redundancy_recovered}};
}
} // namespace

TestSummary summarise(const RunHistory &run, const Scene &scene, const std::map<std::string, double> &specimen,
                      const DriveState &state, double seconds)
{
  TestSummary summary;
  const auto number = [&](const char *name, double otherwise) {
    const auto found = specimen.find(name);
    return found == specimen.end() ? otherwise : found->second;
  };
  summary.title = scene.title;
  summary.law = scene.contact->name();
  summary.grains = static_cast<std::size_t>(number("grains", 0));
  summary.void_ratio = number("void_ratio", 0);
  for (auto &[name, value] :
       {std::pair{"relative_density", &summary.relative_density}, {"e_min", &summary.e_min}, {"e_max", &summary.e_max}})
    if (specimen.contains(name))
      *value = specimen.at(name);
  summary.preparation_friction = number("preparation_friction_deg", -1);
  summary.p0 = state.path.p0();
  summary.seconds = seconds;
  summary.reversals = static_cast<double>(state.undrained.reversals);
  summary.worst_overshoot = state.undrained.worst_overshoot;
  summary.cyclic = std::any_of(scene.stages.begin(), scene.stages.end(), is_cyclic);
  summary.axial = std::any_of(scene.stages.begin(), scene.stages.end(), is_axial);
  summary.shear = shear_extremes(run, scene);
  summary.cycles_to_liquefaction = static_cast<double>(state.undrained.reversals_to_liquefaction()) / 2;
  summary.losses = state.control.losses;
  summary.stages = stages_text(state, scene);
  summary.ends = told_ends(state, scene);
  for (const Stage &stage : scene.stages)
    if (const auto *shear = as<ShearStage>(stage); shear && shear->notes_response())
      summary.response = response_name(state.undrained, shear->mode());
  summary.drained = drained_stages(run, scene);
  summary.cycles = state.undrained.response;
  summary.strain_before = state.undrained.max_strain_before;
  const HistoryRows history = rows_of(run, scene.output.energy);
  add_path(history, scene, summary);
  add_recoveries(history, liquefaction_ratio(scene) * state.path.p0(), summary);
  if (scene.output.energy)
    summary.energy_residual = energy_residual(history);
  return summary;
}

std::string to_text(const TestSummary &s, const Scene &scene)
{
  std::string text = fmt::format("\n{}\n  specimen                 {} grains, e = {:.4f}, {}", s.title, s.grains,
                                 s.void_ratio, density_text(s));
  if (s.preparation_friction >= 0)
    text += fmt::format(", prepared at {:.2f} deg", s.preparation_friction);
  text += fmt::format("\n  contact law              {}\n  p0'                      {:.2f} kPa\n  run                   "
                      "   {:.0f} steps{} in {:.1f} s ({:.0f} steps/s)",
                      s.law, s.p0 / 1e3, s.steps,
                      s.last_steps < s.steps ? fmt::format(", the last {:.0f}", s.last_steps) : "", s.seconds,
                      s.last_steps / std::max(s.seconds, 1e-9));
  text +=
      fmt::format("\n  strain rate              {}\n  largest indicator        {:.4f} (recorded before liquefaction)",
                  rate_text(scene), s.max_indicator);
  text += fmt::format("\n  I_R at the start         {:.3f}", s.redundancy_initial);
  if (s.cyclic && s.liquefied)
    text += fmt::format("\n  cycles to liquefaction   {:.1f} ({:.0f} reversals)", s.cycles_to_liquefaction,
                        2 * s.cycles_to_liquefaction);
  if (s.liquefied)
    text +=
        fmt::format("\n  {:<25}{:.4f} %\n  I_R at onset             {:.3f}\n  smallest I_R after       "
                    "{:.3f}\n  I_R as p'/p0 recovers    {}",
                    s.shear ? "|gamma| before it" : "strain before it", 100 * s.strain_before, s.redundancy_at_onset,
                    s.redundancy_min,
                    s.n_recoveries > 0 ? fmt::format("{:.3f} (mean of {:.0f})", s.redundancy_recovered, s.n_recoveries)
                                       : "it does not recover");
  else
    text += "\n  liquefaction             none";
  if (s.cyclic)
    text += fmt::format("\n  reversals                {:.0f}, worst overshoot {:.4f} kPa", s.reversals,
                        s.worst_overshoot / 1e3);
  if (!s.response.empty())
    text += response_text(s.response, s.cycles);
  text += s.shear ? shear_text(s) : axial_text(s);
  if (s.energy_residual >= 0)
    text += fmt::format("\n  energy residual          {:.2e} of the work exchanged", s.energy_residual);
  return text + to_text(s.drained) + s.stages + "\n";
}

Json to_json(const TestSummary &s)
{
  Json json{{"title", s.title},
            {"contact_law", s.law},
            {"grains", s.grains},
            {"void_ratio", s.void_ratio},
            {"relative_density", or_null(s.relative_density)},
            {"e_min", or_null(s.e_min)},
            {"e_max", or_null(s.e_max)},
            {"preparation_friction_deg", s.preparation_friction < 0 ? Json() : Json(s.preparation_friction)},
            {"p0", s.p0},
            {"steps", std::llround(s.steps)},
            {"steps_since_resumed", std::llround(s.last_steps)},
            {"seconds", s.seconds},
            {"shear_stage_first_row", s.first_row},
            {"reversals", std::llround(s.reversals)},
            {"worst_overshoot", s.worst_overshoot}};
  if (s.shear)
    json.update(shear_json(*s.shear));
  json["energy_residual"] = s.energy_residual >= 0 ? Json(s.energy_residual) : Json();
  if (!s.response.empty())
    json["cyclic_response"] = response_json(s.response, s.cycles);
  if (!s.drained.empty())
    json["drained"] = to_json(s.drained);
  json["control_lost"] = control_json(s.losses);
  json["ended"] = ends_json(s.ends);
  json["ended_early"] = early_ends_json(s.ends);
  json["liquefaction"] = liquefaction_json(s);
  return json;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// The summary of a test as text and as summary.json.
#include "apps/common/test_summary.hpp"
#include "base/files/json.hpp"
#include "dem/drive/rate_control.hpp"
#include "dem/measure/redundancy.hpp"
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
/// "I = 4e-05 at p0'" or "2 1/s", of all stages that shear, with their numbers unless they are the same.
std::string rate_text(const Scene &scene)
{
  if (const StaticDrive &drive = scene.drive; drive.on)
    return fmt::format("none: increments of {:g}, each to balance within {:g} for all but {:g} % of the loaded grains",
                       drive.increment, drive.balance.tolerance, 100 * drive.balance.left_out);
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

/// "3.000 (Eq. 2: 6.000)"
std::string to_text(const RedundancyOfRow &row)
{
  return fmt::format("{:.3f}", row.index) + (row.constraints < 6 ? fmt::format(" (Eq. 2: {:.3f})", row.eq2) : "");
}

std::string extremes_text(const ShearRecord &s)
{
  std::string text;
  if (s.axial)
    text += fmt::format("\n  largest |axial strain|   {:.4f} %\n  largest |q|              {:.2f} kPa",
                        100 * s.axial->strain, s.axial->q / 1e3);
  if (s.simple_shear)
    text += fmt::format("\n  largest |gamma|          {:.4f} %\n  largest |tau|            {:.2f} kPa",
                        100 * s.simple_shear->gamma, s.simple_shear->tau / 1e3);
  text += fmt::format("\n  lowest p'                {:.3f} kPa", s.min_p / 1e3);
  if (!s.simple_shear)
    return text;
  const ShearExtremes &shear = *s.simple_shear;
  const std::string ratio =
      fmt::format("|tau| reached {:.4f} sigma'_v0, sigma'_v0 {:.2f} kPa", shear.max_ratio, shear.sigma_v0 / 1e3);
  return text + (shear.requested_ratio > 0
                     ? fmt::format("\n  CSR                      {:g} ({})", shear.requested_ratio, ratio)
                     : fmt::format("\n  stress ratio             {}", ratio));
}

std::string liquefaction_text(const LiquefactionRecord &l)
{
  std::string text;
  if (l.cyclic)
    text += fmt::format("\n  cycles to liquefaction   {:.1f} ({:.0f} reversals)", l.reversals / 2, l.reversals);
  return text +
         fmt::format(
             "\n  {:<25}{:.4f} %\n  I_R in the row before    {} at p'/p0' = {:.3f}\n  I_R at onset             {}"
             "\n  smallest I_R after       {:.3f}\n  I_R as p'/p0 recovers    {}",
             l.simple_shear ? "|gamma| before it" : "strain before it", 100 * l.strain_before, to_text(l.before),
             l.ratio_before, to_text(l.at_onset), l.least_redundancy,
             l.n_recoveries > 0 ? fmt::format("{:.3f} (mean of {:.0f})", l.recovered, l.n_recoveries)
                                : "it does not recover");
}

std::string index_names(const std::vector<int> &constraints)
{
  std::vector<std::string> names;
  std::ranges::transform(constraints, std::back_inserter(names), index_name);
  return fmt::format("{}", fmt::join(names, "; then "));
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

Json liquefaction_json(const LiquefactionRecord &l)
{
  return {{"row", l.row},
          {"ratio", l.ratio},
          {"cycle", l.reversals / 2},
          {"strain_before", l.strain_before},
          {"p_ratio_before", l.ratio_before},
          {"IR_before", l.before.index},
          {"IR_at_onset", l.at_onset.index},
          {"IR_min", l.least_redundancy},
          {"IR_recovered", l.n_recoveries > 0 ? Json(l.recovered) : Json()}};
}
} // namespace

std::string to_text(const TestSummary &s, const Scene &scene)
{
  std::string text = fmt::format("\n{}\n  specimen                 {} grains, e = {:.4f}, {}",
                                 s.title.empty() ? "Element test" : s.title, s.grains, s.void_ratio, density_text(s));
  const auto line = [&](std::string_view name, const std::string &value) {
    text += fmt::format("\n  {:<25}{}", name, value);
  };
  if (s.preparation_friction >= 0)
    text += fmt::format(", prepared at {:.2f} deg", s.preparation_friction);
  line("contact law", s.law);
  if (s.last)
    line("redundancy index I_R", index_names(s.constraints));
  if (s.shearing)
    line("p0'", fmt::format("{:.2f} kPa", s.shearing->p0 / 1e3));
  line("run", fmt::format("{:.0f} steps{} in {:.1f} s ({:.0f} steps/s)", s.steps,
                          s.last_steps < s.steps ? fmt::format(", the last {:.0f}", s.last_steps) : "", s.seconds,
                          s.last_steps / std::max(s.seconds, 1e-9)));
  if (const std::string rate = rate_text(scene); !rate.empty())
    line("strain rate", rate);
  if (s.shearing && s.shearing->max_indicator)
    line("largest indicator",
         fmt::format("{:.4f} (recorded{})", *s.shearing->max_indicator, s.may_liquefy ? " before liquefaction" : ""));
  if (s.shearing)
    line("I_R at the start", to_text(s.shearing->at_start));
  if (s.liquefaction)
    text += liquefaction_text(*s.liquefaction);
  else if (s.may_liquefy)
    line("liquefaction", "none");
  if (s.cyclic)
    line("reversals",
         fmt::format("{:.0f}", s.reversals) +
             (s.worst_overshoot ? fmt::format(", worst overshoot {:.4f} kPa", *s.worst_overshoot / 1e3) : ""));
  if (!s.response.empty())
    text += response_text(s.response, s.cycles);
  if (s.shearing)
    text += extremes_text(*s.shearing);
  if (s.last)
    line("at the end", fmt::format("p' {:.2f} kPa, I_R {}", s.last->p / 1e3, to_text(s.last->redundancy)));
  if (s.energy_residual >= 0)
    line("energy residual", fmt::format("{:.2e} of the work exchanged", s.energy_residual));
  return text + to_text(s.drained) + s.stages + "\n";
}

Json to_json(const TestSummary &s)
{
  const std::optional<ShearRecord> &shearing = s.shearing;
  Json json{{"title", s.title},
            {"contact_law", s.law},
            {"grains", s.grains},
            {"void_ratio", s.void_ratio},
            {"relative_density", or_null(s.relative_density)},
            {"e_min", or_null(s.e_min)},
            {"e_max", or_null(s.e_max)},
            {"preparation_friction_deg", s.preparation_friction < 0 ? Json() : Json(s.preparation_friction)},
            {"IR_constraints", s.constraints},
            {"p0", shearing ? Json(shearing->p0) : Json()},
            {"steps", std::llround(s.steps)},
            {"steps_since_resumed", std::llround(s.last_steps)},
            {"seconds", s.seconds},
            {"shear_stage_first_row", shearing ? Json(shearing->first_row) : Json()},
            {"IR_at_start", shearing ? Json(shearing->at_start.index) : Json()},
            {"p_end", s.last ? Json(s.last->p) : Json()},
            {"IR_at_end", s.last ? Json(s.last->redundancy.index) : Json()},
            {"reversals", std::llround(s.reversals)},
            {"worst_overshoot", or_null(s.worst_overshoot)}};
  if (shearing && shearing->simple_shear)
    json.update(shear_json(*shearing->simple_shear));
  json["energy_residual"] = s.energy_residual >= 0 ? Json(s.energy_residual) : Json();
  if (!s.response.empty())
    json["cyclic_response"] = response_json(s.response, s.cycles);
  if (!s.drained.empty())
    json["drained"] = to_json(s.drained);
  json["control_lost"] = control_json(s.losses);
  json["ended"] = ends_json(s.ends);
  json["ended_early"] = early_ends_json(s.ends);
  json["liquefaction"] = s.liquefaction ? liquefaction_json(*s.liquefaction) : Json();
  return json;
}
} // namespace isostat

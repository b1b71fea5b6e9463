// SPDX-License-Identifier: BSD-3-Clause
#include "apps/liquefaction_resistance/campaign.hpp"

#include "base/files/json.hpp"
#include "base/files/replace_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace
{
constexpr double reference_cycles = 15; // a magnitude 7.5 earthquake

std::string cycles_text(const RunResult &r)
{
  if (r.status == RunStatus::liquefied)
    return fmt::format("{:g}", *r.to_liquefaction);
  if (r.status == RunStatus::censored)
    return fmt::format(">{:g}", r.cycles);
  return r.status == RunStatus::missing ? "-" : to_string(r.status);
}

/// Geometric mean over the runs of a ratio; empty unless each of them has a value.
std::string mean_text(const std::vector<RunResult> &runs, std::optional<double> RunResult::*value)
{
  double sum = 0;
  for (const RunResult &r : runs)
    {
      if (!(r.*value))
        return "-";
      sum += std::log(*(r.*value));
    }
  return fmt::format("{:.1f}", std::exp(sum / static_cast<double>(runs.size())));
}

std::string table(const std::vector<RunResult> &results, std::vector<double> ratios)
{
  std::sort(ratios.begin(), ratios.end());
  std::string text = fmt::format("\n  {:>6}  {:>8}  {:>9}  {:>12}  {}", "CSR", "mean N", "N 3 % DA", "N 3.75 % SA",
                                 "N to liquefaction, seed by seed");
  for (double ratio : ratios)
    {
      std::vector<RunResult> runs;
      std::string each;
      for (const RunResult &r : results)
        if (r.ratio == ratio)
          {
            runs.push_back(r);
            each += (each.empty() ? "" : ", ") + cycles_text(r);
          }
      text += fmt::format("\n  {:>6g}  {:>8}  {:>9}  {:>12}  {}", ratio, mean_text(runs, &RunResult::to_liquefaction),
                          mean_text(runs, &RunResult::to_double_amplitude),
                          mean_text(runs, &RunResult::to_single_amplitude), each);
    }
  return text;
}

/// A line through two points has none that can be known.
bool has_error(const PowerLaw &law) { return law.n_runs > 2; }

std::string fit_text(const std::optional<PowerLaw> &law)
{
  if (!law)
    return "\n  fit                      none: fewer than two ratios have a run that liquefied, or all within a cycle";
  const bool inside = law->min_cycles <= reference_cycles && law->most_cycles >= reference_cycles;
  return fmt::format(
      "\n  fit                      CSR = {:.4f} N^-{:.3f}, {}, {} runs{}\n  CSR at 15 cycles         {:.4f}{}", law->a,
      law->b,
      has_error(*law) ? fmt::format("b +- {:.3f}, R^2 = {:.3f}", law->b_error, law->r_squared)
                      : "whose error two runs cannot tell",
      law->n_runs, law->n_left_out > 0 ? fmt::format(" ({} did not liquefy and are left out)", law->n_left_out) : "",
      law->at(reference_cycles), inside ? "" : " (extrapolated)");
}

std::string to_text(const Campaign &campaign, const std::optional<PowerLaw> &law)
{
  const Scene &scene = campaign.shared();
  const std::vector<RunResult> results = campaign.results();
  std::string text = fmt::format("\n{}\n  CSR                      {}, {}\n  liquefied                p'/p0' < {:g}; "
                                 "at most {} cycles\n  cycles      "
                                 "  "
                                 "           half the reversals; means over seeds are geometric, - if a run has none\n",
                                 scene.title, campaign.cyclic().stress_ratio_text(), campaign.cyclic().mode().name,
                                 campaign.cyclic().liquefaction_ratio, campaign.plan().cycles);
  text += table(results, campaign.plan().ratios) + "\n" + fit_text(law);
  double seconds = 0;
  std::vector<double> e;
  for (const RunResult &r : results)
    {
      seconds += r.wall_seconds.value_or(0);
      if (r.void_ratio)
        e.push_back(*r.void_ratio);
    }
  if (!e.empty())
    text += fmt::format("\n  void ratios              {:.4f} to {:.4f}\n  wall time of the runs    {:.1f} min",
                        *std::min_element(e.begin(), e.end()), *std::max_element(e.begin(), e.end()), seconds / 60);
  for (const RunResult &r : results)
    if (r.status == RunStatus::failed)
      text += fmt::format("\n  failed: CSR {:g}, seed {}: {}", r.ratio, r.seed, r.note);
  return text + "\n";
}

Json to_json(const Campaign &campaign, const std::optional<PowerLaw> &law)
{
  Json fit;
  if (law)
    fit = {{"a", law->a},
           {"b", law->b},
           {"b_error", has_error(*law) ? Json(law->b_error) : Json()},
           {"R2", has_error(*law) ? Json(law->r_squared) : Json()},
           {"runs", law->n_runs},
           {"left_out", law->n_left_out},
           {"CSR_15", law->at(reference_cycles)}};
  return {{"title", campaign.shared().title},
          {"test", campaign.cyclic().mode().name},
          {"liquefaction_ratio", campaign.cyclic().liquefaction_ratio},
          {"cycles", campaign.plan().cycles},
          {"fit", fit}};
}
} // namespace

std::string write_report(const Campaign &campaign)
{
  const std::vector<RunResult> results = campaign.results();
  const std::optional<PowerLaw> law = fit_power_law(results);
  write_replacing(campaign.folder() / "resistance.csv", to_csv(results));
  write_json(campaign.folder() / "resistance.json", to_json(campaign, law));
  std::string text = to_text(campaign, law);
  write_replacing(campaign.folder() / "summary.txt", text);
  return text;
}
} // namespace isostat

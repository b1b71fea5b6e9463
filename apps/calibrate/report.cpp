// SPDX-License-Identifier: BSD-3-Clause
#include "apps/calibrate/report.hpp"

#include "base/files/json.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/progress.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
constexpr double at_bound = 0.01; ///< share of the bounds within which a value counts as being at one

std::string place_text(double share)
{
  if (share < at_bound)
    return "  AT THE LOWER BOUND";
  return share > 1 - at_bound ? "  AT THE UPPER BOUND" : "";
}

std::string parameter_table(const CalibrationResult &r)
{
  const Trial &start = r.trials.all()[r.start], &best = r.trials.all()[r.best];
  const std::vector<Parameter> &parameters = r.scenes.parameters();
  const std::size_t width = label_width(parameters);
  std::string text = fmt::format("\n  {:<{}} {:>14} {:>14}\n", "parameter", width, "start", "best");
  for (std::size_t k = 0; k < parameters.size(); ++k)
    text +=
        fmt::format("  {:<{}} {:>14} {:>14}{}\n", parameters[k].label(), width, parameters[k].number(start.values[k]),
                    parameters[k].number(best.values[k]), place_text(parameters[k].share(best.values[k])));
  return text + remarks(parameters);
}

std::string misfit_text(const std::optional<CurveOutcome> &outcome)
{
  return !outcome ? "-" : outcome->failure.empty() ? fmt::format("{:.4f}", outcome->misfit) : "failed";
}

std::string curve_table(const CalibrationResult &r)
{
  const Trial &start = r.trials.all()[r.start], &best = r.trials.all()[r.best];
  std::string text = fmt::format("\n  {:<24} {:>7} {:>10} {:>10} {:>10}  {}\n", "misfit of curve", "weight", "start",
                                 "best", "scatter", "(of the best: standard error of its mean over the seeds)");
  for (std::size_t c = 0; c < r.plan.curves.size(); ++c)
    {
      const PlanCurve &curve = r.plan.curves[c];
      text += fmt::format("  {:<24} {:>7} {:>10} {:>10} {:>10}\n", curve.name,
                          curve.blind ? "blind" : fmt::format("{:g}", curve.weight), misfit_text(start.curves[c]),
                          misfit_text(best.curves[c]),
                          best.curves[c] && best.curves[c]->scatter ? fmt::format("{:.4f}", *best.curves[c]->scatter)
                                                                    : "-");
    }
  return text + fmt::format("  {:<24} {:>7} {:>10.4f} {:>10.4f}\n", "fitted, together", "", start.misfit, best.misfit);
}

/// Curves that were not fitted and became worse by more than the best's scatter: what the set does not transfer to.
std::string worse_blind(const CalibrationResult &r)
{
  const Trial &start = r.trials.all()[r.start], &best = r.trials.all()[r.best];
  std::size_t blind = 0;
  std::vector<std::string> worse;
  for (std::size_t c = 0; c < r.plan.curves.size(); ++c)
    if (const auto &there = start.curves[c], &here = best.curves[c]; r.plan.curves[c].blind && there && here)
      {
        ++blind;
        if (here->misfit > there->misfit + here->scatter.value_or(0))
          worse.push_back(r.plan.curves[c].name);
      }
  return worse.empty()
             ? ""
             : fmt::format("  {} of {} blind curves became WORSE: {}\n", worse.size(), blind, fmt::join(worse, ", "));
}

std::string failures(const CalibrationResult &r)
{
  std::string text;
  for (std::size_t t = 0; t < r.trials.all().size(); ++t)
    for (std::size_t c = 0; c < r.plan.curves.size(); ++c)
      if (const auto &outcome = r.trials.all()[t].curves[c]; outcome && !outcome->failure.empty())
        text += fmt::format("  failed: trial {}, {}, {}\n", t + 1, r.plan.curves[c].name, outcome->failure);
  return text;
}

std::string summary(const CalibrationResult &r)
{
  return fmt::format("\n{}\n  {} trials with {} specimens of {} grains; best: trial {}\n  ended because {}\n",
                     r.plan.title, r.trials.all().size(), r.plan.specimens.seeds, r.plan.specimens.grains, r.best + 1,
                     r.ending) +
         parameter_table(r) + curve_table(r) + worse_blind(r) + failures(r);
}

/// Laboratory, start and best at the compared strains; an empty cell where a run failed.
std::string curves_csv(const CalibrationResult &r)
{
  std::string text = "curve,blind (-),eps_1 (-),q laboratory (Pa),q start (Pa),q best (Pa),q best s.d. (Pa),"
                     "second,second laboratory,second start,second best,second best s.d.\n";
  for (std::size_t c = 0; c < r.plan.curves.size(); ++c)
    {
      const PlanCurve &curve = r.plan.curves[c];
      const auto computed = [&](std::size_t trial) -> std::optional<Comparison> {
        const auto &outcome = r.trials.all()[trial].curves[c];
        return outcome && outcome->failure.empty() ? std::optional(r.trials.comparison(trial, c)) : std::nullopt;
      };
      const std::optional<Comparison> start = computed(r.start), best = computed(r.best);
      if (!start && !best)
        continue;
      const Curve &laboratory = (best ? best : start)->laboratory;
      const auto cell = [](const std::optional<Comparison> &from, Curve Comparison::*which,
                           std::vector<double> Curve::*quantity, std::size_t i) {
        return from ? fmt::format("{:.6g}", ((*from).*which.*quantity)[i]) : std::string();
      };
      for (std::size_t i = 0; i < laboratory.strain.size(); ++i)
        text += fmt::format(
            "{},{},{:.6g},{:.6g},{},{},{},{},{:.6g},{},{},{}\n", curve.name, curve.blind ? 1 : 0, laboratory.strain[i],
            laboratory.q[i], cell(start, &Comparison::mean, &Curve::q, i), cell(best, &Comparison::mean, &Curve::q, i),
            cell(best, &Comparison::deviation, &Curve::q, i),
            curve.test == LaboratoryTest::drained ? "eps_v (-)" : "p' (Pa)", laboratory.other[i],
            cell(start, &Comparison::mean, &Curve::other, i), cell(best, &Comparison::mean, &Curve::other, i),
            cell(best, &Comparison::deviation, &Curve::other, i));
    }
  return text;
}

Json to_json(const CalibrationResult &r)
{
  const Trial &start = r.trials.all()[r.start], &best = r.trials.all()[r.best];
  Json parameters = Json::array(), curves = Json::array();
  for (std::size_t k = 0; k < r.scenes.parameters().size(); ++k)
    {
      const Parameter &p = r.scenes.parameters()[k];
      parameters.push_back({{"label", p.label()},
                            {"key", p.key()},
                            {"curve", p.curve()},
                            {"low", p.number(p.value(0))},
                            {"high", p.number(p.value(1))},
                            {"log", r.plan.parameters[k].logarithmic},
                            {"start", p.text(start.values[k])},
                            {"best", p.text(best.values[k])},
                            {"bound", place_text(p.share(best.values[k]))}});
    }
  for (std::size_t c = 0; c < r.plan.curves.size(); ++c)
    {
      const auto misfit = [&](const Trial &trial) { return trial.curves[c] ? Json(trial.curves[c]->misfit) : Json(); };
      const bool scatters = best.curves[c] && best.curves[c]->scatter;
      const PlanCurve &curve = r.plan.curves[c];
      curves.push_back({{"name", curve.name},
                        {"test", curve.test == LaboratoryTest::drained ? "drained" : "undrained"},
                        {"blind", curve.blind},
                        {"weight", curve.weight},
                        {"start", misfit(start)},
                        {"best", misfit(best)},
                        {"scatter", scatters ? Json(*best.curves[c]->scatter) : Json()},
                        {"failure", best.curves[c] ? best.curves[c]->failure : ""}});
    }
  return {{"title", r.plan.title},
          {"trials", r.trials.all().size()},
          {"start", r.start + 1},
          {"best", r.best + 1},
          {"misfit_start", start.misfit},
          {"misfit_best", best.misfit},
          {"ending", r.ending},
          {"grains", r.plan.specimens.grains},
          {"seeds", r.plan.specimens.seeds},
          {"parameters", std::move(parameters)},
          {"curves", std::move(curves)}};
}
} // namespace

std::string write_report(const CalibrationResult &result, const fs::path &folder)
{
  const std::vector<double> &best = result.trials.all()[result.best].values;
  make_folder(folder / "best");
  write_replacing(folder / "best_scene.toml", to_toml(result.scenes.full_scene(best)));
  for (const PlanCurve &curve : result.plan.curves)
    write_replacing(folder / "best" / (curve.name + ".toml"), to_toml(result.scenes.full_test(best, curve)));
  write_replacing(folder / "curves.csv", curves_csv(result));
  write_json(folder / "calibrate.json", to_json(result));
  const std::string text = summary(result);
  write_replacing(folder / "summary.txt", text + fmt::format("\n  this call: {} runs in {}\n", result.trials.n_runs(),
                                                             duration_text(result.trials.seconds())));
  return text;
}
} // namespace isostat

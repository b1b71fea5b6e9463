// SPDX-License-Identifier: BSD-3-Clause
// calibrate PLAN: finds parameters of a scene from laboratory curves, with element tests of small packings.
//
//     laboratory (CSV)          plan: curves, parameters with bounds, specimens, budget
//        |                        |
//        |    misfit <-- curves <-- element_test, the same seeds in every trial <-- values <--.
//        '------^  |                                                                          |
//                  '--> start, Sobol design, then NLopt from the best of them ----------------'
//
//   calibrate quick_karlsruhe.toml -j 2
//   calibrate apps/scenes/calibrate/karlsruhe_drained.toml --jobs 2 --output results/sand
#include "apps/calibrate/folder.hpp"
#include "apps/calibrate/report.hpp"
#include "apps/calibrate/search.hpp"
#include "apps/common/command_line.hpp"
#include "apps/common/element_test_runs.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "base/error.hpp"
#include "base/record/progress.hpp"
#include "base/scene/reader.hpp"
#include "base/tell.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

struct Options
{
  std::string plan, output, command_line;
  CampaignShare share;
  bool overwrite = false, quiet = false, no_figures = false, dry_run = false, print_defaults = false;
};

/// Values of the parameters at shares of their bounds.
std::vector<double> values_at(const SceneMaker &scenes, const std::vector<double> &shares)
{
  std::vector<double> values;
  for (std::size_t k = 0; k < shares.size(); ++k)
    values.push_back(scenes.parameters()[k].value(shares[k]));
  return values;
}

std::vector<double> shares_of(const SceneMaker &scenes, const std::vector<double> &values)
{
  std::vector<double> shares;
  for (std::size_t k = 0; k < values.size(); ++k)
    shares.push_back(scenes.parameters()[k].share(values[k]));
  return shares;
}

/// The start, and the design; no more than the budget.
std::vector<std::vector<double>> first_points(const CalibrationPlan &plan, const SceneMaker &scenes)
{
  std::vector<double> start;
  for (const Parameter &parameter : scenes.parameters())
    start.push_back(parameter.start());
  std::vector<std::vector<double>> points = {values_at(scenes, start)};
  for (const std::vector<double> &shares : sobol_design(start.size(), plan.search.design))
    if (points.size() < plan.budget.trials)
      points.push_back(values_at(scenes, shares));
  return points;
}

/// What a plan says of the density of a curve's specimens: " (relative_density = 1)".
std::string density_text(const PlanCurve &curve)
{
  if (curve.relative_density)
    return fmt::format(" (relative_density = {:g})", *curve.relative_density);
  return curve.void_ratio ? fmt::format(" (void_ratio = {:g})", *curve.void_ratio) : "";
}

/// A curve that no trial can run says nothing, and never will.
void check_first(const CalibrationPlan &plan, const std::vector<Trial> &trials)
{
  for (std::size_t c = 0; c < plan.curves.size(); ++c)
    {
      const auto failed = [&](const Trial &t) { return t.curves[c] && !t.curves[c]->failure.empty(); };
      if (std::all_of(trials.begin(), trials.end(), failed))
        throw InputError(
            fmt::format("{}: curve \"{}\"{}: none of the first {} trials could be run. The first, {}\n  "
                        "Correct the curve's density or pressure, the bounds, or the number of grains; all "
                        "runs are in the folder of trials.csv.",
                        plan.curves[c].where, plan.curves[c].name, density_text(plan.curves[c]), trials.size(),
                        trials[0].curves[c]->failure));
    }
}

/// Start, design and search.   @return why it ended
std::string find_best(const CalibrationPlan &plan, const SceneMaker &scenes, Trials &trials)
{
  trials.evaluate(first_points(plan, scenes));
  check_first(plan, trials.all());
  const Objective objective = [&](const std::vector<double> &shares) {
    const std::vector<double> values = values_at(scenes, shares);
    if (!trials.is_known(values) && trials.all().size() >= plan.budget.trials)
      throw BudgetUsed{fmt::format("budget.trials = {} are used up", plan.budget.trials)};
    if (!trials.is_known(values) && plan.budget.minutes && trials.seconds() > 60 * *plan.budget.minutes)
      throw BudgetUsed{"budget.time is used up; the same command goes on"};
    const Trial &trial = trials.all()[trials.evaluate({values})[0]];
    return trial.misfit * trial.misfit; // of parameters near the best a parabola, which the misfit itself is not
  };
  return search(plan.search, shares_of(scenes, trials.all()[trials.best()].values), objective);
}

/// What would stop the call before or with its first trial.
void check_start(const CalibrationPlan &plan, const SceneMaker &scenes, const fs::path &folder, bool overwrite)
{
  const std::vector<double> start = first_points(plan, scenes)[0];
  for (const PlanCurve &curve : plan.curves)
    scenes.trial(start, curve, plan.specimens.first_seed);
  if (!overwrite && !is_unused(folder))
    check_calibration_folder(folder, plan, scenes.scene_text());
}

void print_dry_run(const CalibrationPlan &plan, const SceneMaker &scenes)
{
  const auto blind = static_cast<std::size_t>(
      std::count_if(plan.curves.begin(), plan.curves.end(), [](const PlanCurve &c) { return c.blind; }));
  const std::size_t fitted = plan.curves.size() - blind;
  fmt::print("{}\n  runs per trial           {} ({} curves, {} seeds), each of {} grains\n  runs in all              "
             "at most {}, and {} for the blind curves of start and best\n  time                     unknown before "
             "the first trial; the progress lines tell\n",
             plan.title, fitted * plan.specimens.seeds, fitted, plan.specimens.seeds, plan.specimens.grains,
             fitted * plan.specimens.seeds * plan.budget.trials, 2 * blind * plan.specimens.seeds);
  const std::size_t width = label_width(scenes.parameters());
  for (const Parameter &p : scenes.parameters())
    fmt::print("  {:<{}} from {} to {}, start {}\n", p.label(), width, p.text(p.value(0)), p.text(p.value(1)),
               p.text(p.value(p.start())));
  fmt::print("{}", remarks(scenes.parameters()));
}

void leave_report(const CalibrationPlan &plan, const SceneMaker &scenes, const Trials &trials,
                  const std::string &ending, const fs::path &folder)
{
  fmt::print("{}", write_report({plan, scenes, trials, 0, trials.best(), ending}, folder));
  fmt::print("\n  this call: {} runs in {}\n", trials.n_runs(), duration_text(trials.seconds()));
  if (trials.is_complete(trials.all()[trials.best()]))
    fmt::print("  best set ready to run: {}; with the state of each curve: {}\n", (folder / "best_scene.toml").string(),
               (folder / "best").string());
  else
    fmt::print(
        "  NO SET RAN: in every trial a run failed, and none can be recommended. Other bounds or densities may.\n");
}

void calibrate(const Options &options)
{
  if (options.plan.empty())
    throw InputError("no plan given. Try calibrate quick_karlsruhe.toml, or --help.");
  const fs::path folder = output_folder(options.output, results_folder(options.plan));
  if (!options.dry_run && options.share.help(folder))
    return;
  const CalibrationPlan plan = read_plan(options.plan);
  const SceneMaker scenes(plan);
  element_test_program();
  const auto say = [&](const std::string &line) {
    if (!options.quiet)
      tell(fmt::format("{}\n", line));
  };
  TaskQueue queue(folder / "queue");
  Trials trials(plan, scenes, folder, {queue, options.share.jobs}, say); // reads the laboratory before all writing
  if (options.dry_run)
    {
      check_start(plan, scenes, folder, options.overwrite);
      return print_dry_run(plan, scenes);
    }
  open_calibration_folder(folder, plan, scenes.scene_text(), options.command_line, options.overwrite);
  queue.lead();
  catch_signals();
  try
    {
      const std::string ending = find_best(plan, scenes, trials);
      trials.evaluate_blind({0, trials.best()});
      leave_report(plan, scenes, trials, ending, folder);
    }
  catch (const Interrupted &)
    {
      if (trials.best() < trials.all().size())
        leave_report(plan, scenes, trials, "it was interrupted; the same command goes on", folder);
      throw;
    }
  if (!options.no_figures)
    fmt::print("  {}\n", draw_figures(folder, "calibrate"));
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("Calibration: finds parameters of a scene from laboratory curves with small element tests");
  Options options;
  line.add_option("plan", options.plan, "plan file (TOML); see apps/calibrate/README.md")
      ->transform([](const std::string &file) { return shipped_file("scenes/calibrate", file); });
  options.share.add_options(line);
  line.add_option("-o,--output", options.output, "results folder (default: results/<plan name>)");
  line.add_flag("--overwrite", options.overwrite, "start anew: remove another calibration from this folder");
  line.add_flag("-q,--quiet", options.quiet, "no progress on stderr");
  line.add_flag("--no-figures", options.no_figures, "leave no figures and no report");
  line.add_flag("--dry-run", options.dry_run, "check the plan, print how many runs it takes, and stop");
  line.add_flag("--print-defaults", options.print_defaults, "print a commented plan with all keys, units and ranges");
  options.command_line = command_text(argc, argv);
  return run_command(line, argc, argv, [&] {
    if (options.print_defaults)
      fmt::print("{}", default_plan());
    else
      calibrate(options);
  });
}

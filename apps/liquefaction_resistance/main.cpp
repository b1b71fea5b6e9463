// SPDX-License-Identifier: BSD-3-Clause
// liquefaction_resistance SCENE --ratios LIST: the resistance curve of a sand, cyclic stress ratio against the number
// of cycles to initial liquefaction, from undrained cyclic tests at several amplitudes on several specimens each.
//
//     CSR |  o o                CSR = tau_amp / sigma'_v0 in simple shear, q_amp / (2 p0') in triaxial tests
//         |    o o o            every o is a run of element_test in a process of its own; specimens (seeds 1..n) are
//         |        o  oo        shared between ratios; finished runs are kept, the same command goes on
//         |            o  o->   fit CSR = a N^-b; runs that do not liquefy are arrows and not in the fit
//         +--------------- log N
//
//   liquefaction_resistance apps/scenes/quick_cyclic_simple_shear.toml --ratios 0.10,0.13,0.16,0.20,0.25
//   liquefaction_resistance apps/scenes/quick_cyclic_dr64_periodic.toml --ratios 0.1,0.15,0.2 --realisations 5 --jobs 2
#include "apps/common/command_line.hpp"
#include "apps/common/element_test_runs.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/liquefaction_resistance/campaign.hpp"
#include "base/error.hpp"
#include "base/record/progress.hpp"
#include "base/tell.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

struct Options
{
  std::string scene, ratios, output, command_line;
  std::vector<std::string> set;
  CampaignPlan plan;
  CampaignShare share;
  bool overwrite = false, quiet = false, no_figures = false;
};

ChildRun child_of(const Campaign &campaign, const Campaign::Run &run)
{
  return element_test_run(campaign.scene_file(run), campaign.run_folder(run),
                          campaign.folder() / "logs" / (run.name + ".log"));
}

/// What came of a child that ended by itself.
void take_result(const Campaign &campaign, Campaign::Run &run, int code, const fs::path &log)
{
  try
    {
      if (code == 0 && !run.scene.stages.empty())
        run.result = read_run(campaign.run_folder(run), run.scene, campaign.stage(), run.result);
    }
  catch (const std::exception &error) // its files are damaged
    {
      run.fail(error.what());
    }
  if (code != 0 && code != 130)
    run.fail(fmt::format("exit code {}: {}", code, last_line(log)));
}

std::string outcome(const RunResult &r)
{
  if (r.status == RunStatus::liquefied)
    return fmt::format("liquefied after {:g} cycles", *r.to_liquefaction);
  if (r.status == RunStatus::censored)
    return fmt::format("not liquefied in {:g} cycles", r.cycles);
  if (r.status == RunStatus::strain)
    return fmt::format("not liquefied, strain limit after {:g} cycles", r.cycles);
  return r.status == RunStatus::failed ? "FAILED, " + r.note : "interrupted";
}

/// Mean wall time of the finished runs, of one ratio if there are any; nothing before the first has ended.
std::optional<double> mean_seconds(const std::vector<RunResult> &results, std::optional<double> ratio)
{
  double sum = 0, n = 0;
  for (const RunResult &r : results)
    if (r.wall_seconds && (!ratio || r.ratio == *ratio))
      {
        sum += *r.wall_seconds;
        n += 1;
      }
  return n > 0 ? std::optional(sum / n) : ratio ? mean_seconds(results, std::nullopt) : std::nullopt;
}

/// "27 %  4 of 15 runs, ETA 6 min"
std::string state(const std::vector<RunResult> &results, int jobs)
{
  std::optional<double> left = 0;
  std::size_t n_left = 0;
  for (const RunResult &r : results)
    if (r.status == RunStatus::missing)
      {
        ++n_left;
        const std::optional<double> seconds = mean_seconds(results, r.ratio);
        left = seconds ? std::optional(*left + *seconds) : std::nullopt;
      }
  const std::size_t all = results.size(), n = all - n_left;
  return fmt::format("{:3.0f} %  {} of {} runs", 100.0 * static_cast<double>(n) / static_cast<double>(all), n, all) +
         (left && n_left > 0 ? ", ETA " + duration_text(*left / jobs) : "");
}

/// Runs what is not finished; a line on stderr for each run that ends, and every half minute what is at work. What
/// fails is noted and does not stop the rest.   @return false if stopped
bool run_all(const Campaign &campaign, const RunPool &pool, const std::vector<Campaign::Run *> &todo,
             const Options &options)
{
  std::vector<ChildRun> children;
  children.reserve(todo.size());
  for (const Campaign::Run *run : todo)
    children.push_back(child_of(campaign, *run));
  Stopwatch since_line;
  const auto say = [&](const std::string &line) {
    if (!options.quiet)
      tell(fmt::format("{}{}\n", state(campaign.results(), options.share.jobs), line));
    since_line.restart();
  };
  const ChildEvents events = {
      [&](std::size_t k, int code, double seconds) {
        Campaign::Run &run = *todo[k];
        take_result(campaign, run, code, children[k].log);
        const bool prepared = run.scene.stages.empty() && code == 0;
        say(fmt::format("  {}: {}, {:.0f} s", run.name, prepared ? "ready" : outcome(run.result), seconds));
      },
      [&](const std::vector<std::size_t> &running) {
        if (since_line.seconds() < 30)
          return;
        std::string lines;
        for (std::size_t k : running)
          lines += "\n       " + todo[k]->name + ": " + last_line(children[k].log);
        say(lines);
      }};
  return run_children(pool, children, events);
}

/// Specimens first, so that runs side by side do not prepare the same one.
bool run_campaign(Campaign &campaign, const RunPool &pool, const Options &options)
{
  std::vector<Campaign::Run> specimens = campaign.preparations();
  std::vector<Campaign::Run *> first, then;
  for (Campaign::Run &specimen : specimens)
    first.push_back(&specimen);
  if (!run_all(campaign, pool, first, options))
    return false;
  for (Campaign::Run &run : campaign.runs)
    {
      const auto failed = std::find_if(specimens.begin(), specimens.end(), [&](const Campaign::Run &specimen) {
        return specimen.result.seed == run.result.seed && specimen.result.status == RunStatus::failed;
      });
      if (failed != specimens.end())
        run.fail(failed->result.note);
      else if (run.result.status == RunStatus::missing)
        then.push_back(&run);
    }
  return run_all(campaign, pool, then, options);
}

void find_resistance(Options options)
{
  options.plan.ratios = parse_ratios(options.ratios);
  const Scene scene = read_scene(options.scene, options.set, LeftOutLoads::given_later);
  const fs::path folder = output_folder(options.output, scene.output.folder + "_resistance");
  if (options.share.help(folder))
    return;
  Campaign campaign(scene, options.plan, folder);
  element_test_program();
  campaign.open(options.overwrite, options.command_line);
  TaskQueue queue(folder / "queue");
  queue.lead();
  catch_signals();
  const bool complete = run_campaign(campaign, {queue, options.share.jobs}, options);
  const std::string text = write_report(campaign);
  fmt::print("{}", text);
  const std::vector<RunResult> results = campaign.results();
  const bool any = std::any_of(results.begin(), results.end(), [](const RunResult &result) {
    return result.status != RunStatus::missing && result.status != RunStatus::failed;
  });
  if (any && !options.no_figures)
    fmt::print("  {}\n", draw_figures(campaign.folder(), "liquefaction_resistance"));
  if (!complete)
    throw Interrupted("interrupted; finished runs are kept, the same command goes on");
  for (const RunResult &result : results)
    if (result.status == RunStatus::failed)
      throw RunFailure("some runs failed (see above); the others are kept, the same command tries again");
}
} // namespace

int main(int argc, char **argv)
{
  CLI::App line("Liquefaction resistance: cyclic stress ratio against cycles to initial liquefaction");
  Options options;
  line.add_option("scene", options.scene, "scene file (TOML) with one cyclic stage, the last and only one that shears")
      ->transform(shipped_scene)
      ->required();
  line.add_option("--ratios", options.ratios,
                  "cyclic stress ratios, e.g. 0.10,0.15,0.20: tau_amp / sigma'_v0 in simple shear, q_amp / (2 p0') in "
                  "triaxial tests")
      ->required();
  line.add_option("-n,--realisations", options.plan.realisations, "specimens per ratio: seeds 1 to this (default 3)")
      ->check(CLI::Range(1, 1000));
  line.add_option("--cycles", options.plan.cycles, "a run ends after so many (default 100)")
      ->check(CLI::Range(1, 100000));
  line.add_option("--reversals-after", options.plan.reversals_after,
                  "a run ends after so many reversals since liquefaction (default 1; 0: at once)")
      ->check(CLI::Range(0, 1000));
  options.share.add_options(line);
  line.add_option("-o,--output", options.output, "results folder (default: results/<scene name>_resistance)");
  line.add_option("--set", options.set, "override a key, e.g. --set specimen.pressure=\"100 kPa\" (repeatable)");
  line.add_flag("--overwrite", options.overwrite, "start anew: remove finished runs of this folder");
  line.add_flag("-q,--quiet", options.quiet, "no progress on stderr");
  line.add_flag("--no-figures", options.no_figures, "leave no figure and no report");
  options.command_line = command_text(argc, argv);
  return run_command(line, argc, argv, [&] { find_resistance(options); });
}

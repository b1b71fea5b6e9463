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
#include "apps/common/interrupt.hpp"
#include "apps/common/result_folder.hpp"
#include "apps/liquefaction_resistance/child_runs.hpp"
#include "apps/liquefaction_resistance/folder_lock.hpp"
#include "apps/liquefaction_resistance/progress.hpp"
#include "apps/liquefaction_resistance/report.hpp"
#include "base/error.hpp"
#include "base/files/replace_file.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <unistd.h>

namespace
{
using namespace isostat;
namespace fs = std::filesystem;

struct Options
{
  std::string scene, ratios, output, command_line;
  std::vector<std::string> set;
  CampaignPlan plan;
  int jobs = 1;
  bool overwrite = false, quiet = false, no_figures = false;
};

fs::path output_folder(const Options &options, const Scene &scene)
{
  fs::path folder = options.output.empty() ? scene.output.folder + "_resistance" : options.output;
  return folder.has_filename() ? folder : folder.parent_path();
}

fs::path element_test()
{
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "element_test";
  if (access(program.c_str(), X_OK) != 0)
    throw InputError(fmt::format("{}: is not there; liquefaction_resistance runs it. Build it: cmake --build --preset "
                                 "release --target element_test.",
                                 program.string()));
  return program;
}

ChildRun child_of(const Campaign &campaign, const Campaign::Run &run, const fs::path &program)
{
  const fs::path folder = campaign.run_folder(run.name);
  std::vector<std::string> command = {program.string(), (campaign.folder() / "scenes" / (run.name + ".toml")).string(),
                                      "--output",       folder.string(),
                                      "--threads",      "1",
                                      "--no-figures"};
  if (fs::exists(folder / "checkpoint" / "last.h5"))
    command.push_back("--resume");
  else
    fs::remove_all(folder); // of a run that ended before its first checkpoint
  return {command, campaign.folder() / "logs" / (run.name + ".log")};
}

RunResult failure(const std::string &why)
{
  RunResult result;
  result.status = RunStatus::failed;
  result.note = why;
  return result;
}

/// What came of a child that ended by itself.
RunResult result_of(const Campaign &campaign, const Campaign::Run &run, int code, const fs::path &log)
{
  RunResult result;
  try
    {
      if (code == 0 && !run.scene.stages.empty())
        result = read_run(campaign.run_folder(run.name), run.scene, campaign.stage());
    }
  catch (const std::exception &error) // its files are damaged
    {
      result = failure(error.what());
    }
  if (code != 0 && code != 130)
    result = failure(fmt::format("exit code {}: {}", code, last_line(log)));
  result.ratio = run.ratio;
  result.seed = run.seed;
  return result;
}

/// Runs what is not finished. What fails is noted and does not stop the rest.   @return false if stopped
bool run_all(const Campaign &campaign, const std::vector<Campaign::Run *> &todo, int jobs, CampaignProgress &progress)
{
  const fs::path program = element_test();
  std::vector<ChildRun> children;
  for (const Campaign::Run *run : todo)
    children.push_back(child_of(campaign, *run, program));
  const ChildEvents events = {[&](std::size_t k, int code, double seconds) {
                                todo[k]->result = result_of(campaign, *todo[k], code, children[k].log);
                                progress.finished(*todo[k], code, seconds);
                              },
                              [&](const std::vector<std::size_t> &running) {
                                std::vector<std::string> lines;
                                if (progress.is_due())
                                  for (std::size_t k : running)
                                    lines.push_back(todo[k]->name + ": " + last_line(children[k].log));
                                progress.tick(lines);
                              }};
  return run_children(children, jobs, events);
}

/// Specimens first, so that runs side by side do not prepare the same one.
bool run_campaign(Campaign &campaign, int jobs, bool quiet)
{
  CampaignProgress progress(campaign, jobs, quiet);
  std::vector<Campaign::Run> specimens = campaign.preparations();
  std::vector<Campaign::Run *> first, then;
  for (Campaign::Run &specimen : specimens)
    first.push_back(&specimen);
  if (!run_all(campaign, first, jobs, progress))
    return false;
  for (Campaign::Run &run : campaign.runs)
    {
      const auto failed = std::find_if(specimens.begin(), specimens.end(), [&](const Campaign::Run &specimen) {
        return specimen.seed == run.seed && specimen.result.status == RunStatus::failed;
      });
      if (failed != specimens.end())
        {
          run.result = failure(failed->result.note);
          run.result.ratio = run.ratio;
          run.result.seed = run.seed;
        }
      else if (run.result.status == RunStatus::missing)
        then.push_back(&run);
    }
  return run_all(campaign, then, jobs, progress);
}

void open_folder(const Campaign &campaign, const Options &options, FolderLock &lock)
{
  if (!options.overwrite)
    campaign.check_folder();
  else
    check_result_folder(campaign.folder(), FolderUse::overwrite);
  make_writable_folder(campaign.folder());
  lock.take(campaign.folder());
  if (options.overwrite)
    for (const auto &entry : fs::directory_iterator(campaign.folder()))
      if (entry.path().filename() != "lock")
        fs::remove_all(entry.path());
}

void find_resistance(Options options)
{
  options.plan.ratios = parse_ratios(options.ratios);
  const Scene scene = read_scene(options.scene, options.set);
  Campaign campaign(scene, options.plan, output_folder(options, scene));
  element_test();
  FolderLock lock;
  open_folder(campaign, options, lock);
  write_provenance(campaign.folder(), campaign.shared(), options.command_line);
  campaign.open();
  catch_signals();
  const bool complete = run_campaign(campaign, options.jobs, options.quiet);
  const std::string text = write_report(campaign, options.plan);
  fmt::print("{}", text);
  if (!options.no_figures && fit_power_law(campaign.results()))
    fmt::print("  {}\n", draw_figures(campaign.folder(), "liquefaction_resistance"));
  if (!complete)
    throw Interrupted("interrupted; finished runs are kept, the same command goes on");
  for (const RunResult &result : campaign.results())
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
  line.add_option("-j,--jobs", options.jobs, "runs side by side, each on one thread (default 1)")
      ->check(CLI::Range(1, 1024));
  line.add_option("-o,--output", options.output, "results folder (default: results/<scene name>_resistance)");
  line.add_option("--set", options.set, "override a key, e.g. --set specimen.pressure=\"100 kPa\" (repeatable)");
  line.add_flag("--overwrite", options.overwrite, "start anew: remove finished runs of this folder");
  line.add_flag("-q,--quiet", options.quiet, "no progress on stderr");
  line.add_flag("--no-figures", options.no_figures, "do not draw the figure");
  options.command_line = command_text(argc, argv);
  return run_command(line, argc, argv, [&] { find_resistance(options); });
}

// SPDX-License-Identifier: BSD-3-Clause
#include "apps/soil_column/ensemble.hpp"

#include "apps/common/campaign_folder.hpp"
#include "apps/common/interrupt.hpp"
#include "apps/soil_column/ensemble_results.hpp"
#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"
#include "base/record/progress.hpp"
#include "base/tell.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <map>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
class Ensemble
{
public:
  Ensemble(const SceneOptions &options, const EnsemblePlan &plan)
      : options_(options), plan_(plan), shared_(read_column_scene(options.scene, options.set)),
        folder_(output_folder(options.output, shared_.output.folder + "_ensemble")),
        members_(ensemble_members(shared_, plan))
  {
    shared_.output.folder = "members";
  }

  const fs::path &folder() const { return folder_; }

  void open() const
  {
    const fs::path scene = folder_ / "scene.toml";
    open_campaign_folder(
        folder_, [&] { check_kept_text(scene, read_text(scene), to_toml(shared_), "scene"); }, options_.overwrite);
    write_provenance(folder_, to_toml(shared_), options_.command_line, {});
    for (const char *part : {"scenes", "members", "logs"})
      make_folder(folder_ / part);
    for (const EnsembleMember &member : members_)
      write_replacing(scene_file(member), to_toml(member.scene));
  }

  /// @return false if stopped
  bool run(const RunPool &pool)
  {
    std::vector<const EnsembleMember *> todo;
    std::vector<ChildRun> children;
    for (const EnsembleMember &member : members_)
      if (!is_finished(member))
        {
          todo.push_back(&member);
          children.push_back(child_of(member));
        }
    Stopwatch since_line;
    const ChildEvents events = {
        [&](std::size_t k, int code, double seconds) {
          if (code != 0 && code != 130)
            failures_[todo[k]->name] = fmt::format("exit code {}: {}", code, last_line(children[k].log));
          say(fmt::format("  {}: {}, {:.0f} s", todo[k]->name, code == 0 ? "done" : "not finished", seconds));
          since_line.restart();
        },
        [&](const std::vector<std::size_t> &running) {
          if (since_line.seconds() < 30)
            return;
          for (std::size_t k : running)
            say("       " + todo[k]->name + ": " + last_line(children[k].log));
          since_line.restart();
        }};
    return run_children(pool, children, events);
  }

  /// What the members that have finished give.   @return how many these are
  std::size_t report() const
  {
    std::vector<MemberResults> results;
    for (const EnsembleMember &member : members_)
      if (is_finished(member))
        results.push_back(read_member(member, folder_ / "members" / member.name));
    if (results.empty())
      return 0;
    find_same_packings(results);
    const std::string text = write_ensemble(folder_, shared_, results, members_.size(), failures_);
    leave_summary(folder_, text, "", "column_ensemble", !options_.no_figures);
    return results.size();
  }

  void check_failures() const
  {
    if (!failures_.empty())
      throw RunFailure(fmt::format("{} of {} members failed, the first of them, {}, with {}. The others are kept, the "
                                   "same command tries again",
                                   failures_.size(), members_.size(), failures_.begin()->first,
                                   failures_.begin()->second));
  }

private:
  fs::path scene_file(const EnsembleMember &member) const { return folder_ / "scenes" / (member.name + ".toml"); }

  bool is_finished(const EnsembleMember &member) const
  {
    const fs::path results = folder_ / "members" / member.name;
    return fs::exists(results / "summary.json") && fs::exists(results / "scene.toml") &&
           read_text(results / "scene.toml") == to_toml(member.scene);
  }

  ChildRun child_of(const EnsembleMember &member) const
  {
    const fs::path results = fs::absolute(folder_ / "members" / member.name);
    return {{fs::read_symlink("/proc/self/exe").string(), fs::absolute(scene_file(member)).string(), "--output",
             results.string(), "--threads", std::to_string(options_.threads), "--no-figures"},
            fs::absolute(folder_ / "logs" / (member.name + ".log")),
            results};
  }

  void say(const std::string &line) const
  {
    if (options_.quiet)
      return;
    const auto n = std::ranges::count_if(members_, [&](const EnsembleMember &member) { return is_finished(member); });
    tell(fmt::format("{} of {} members{}\n", n, members_.size(), line));
  }

  const SceneOptions &options_;
  const EnsemblePlan &plan_;
  ColumnScene shared_;
  fs::path folder_;
  std::vector<EnsembleMember> members_;
  std::map<std::string, std::string> failures_; ///< by name of the member
};
} // namespace

void run_ensemble(const SceneOptions &options, const EnsemblePlan &plan)
{
  Ensemble ensemble(options, plan);
  if (plan.share.help(ensemble.folder()))
    return;
  ensemble.open();
  TaskQueue queue(ensemble.folder() / "queue");
  queue.lead();
  catch_signals();
  const bool complete = ensemble.run({queue, plan.share.jobs});
  ensemble.report();
  if (!complete)
    throw Interrupted("interrupted; finished members are kept, the same command goes on");
  ensemble.check_failures();
}
} // namespace isostat

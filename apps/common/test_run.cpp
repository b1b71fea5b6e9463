// SPDX-License-Identifier: BSD-3-Clause
#include "apps/common/test_run.hpp"

#include "apps/common/resumed_scene.hpp"
#include "apps/common/run_output.hpp"
#include "apps/common/stage_report.hpp"
#include "base/error.hpp"
#include "base/tell.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
/// The output of a run and who else looks on. The watcher is asked first: what it stops, the output checkpoints.
class Watched : public RunObserver
{
public:
  Watched(RunOutput &output, RunObserver *watcher) : output_(output), watcher_(watcher) {}

  void record(const Assembly &assembly, const DriveState &state, const Observation &seen, bool snapshot) override
  {
    output_.record(assembly, state, seen, snapshot);
    if (watcher_)
      watcher_->record(assembly, state, seen, snapshot);
  }
  void event(const std::string &line) override
  {
    output_.event(line);
    if (watcher_)
      watcher_->event(line);
  }
  bool after_step(const Assembly &assembly, const DriveState &state, const Observation &seen) override
  {
    if (watcher_ && !watcher_->after_step(assembly, state, seen))
      {
        output_.save_checkpoint(assembly, state);
        return false;
      }
    return output_.after_step(assembly, state, seen);
  }

private:
  RunOutput &output_;
  RunObserver *watcher_;
};
} // namespace

TestRun start_test(const Scene &scene, const Specimen &specimen, const StepSettings &how)
{
  Snapshot initial = specimen.state;
  initial.law = scene.contact;
  TestRun run;
  run.assembly = std::make_shared<Assembly>(initial, how);
  run.specimen = specimen.numbers;
  return run;
}

namespace
{
/// What describes the end of a run that now comes later. Figures and report stay where the end is the same.
void remove_end(const fs::path &folder, bool same_scene)
{
  std::vector<fs::path> files = {folder / "summary.json", folder / "summary.txt"};
  std::error_code none;
  if (!same_scene || !fs::exists(files[0]))
    {
      files.push_back(folder / "report.html");
      for (const fs::directory_entry &figure : fs::directory_iterator(folder / "figures", none))
        if (figure.path().filename().string().starts_with("fig_"))
          files.push_back(figure.path());
    }
  for (const fs::path &file : files)
    if (!fs::is_directory(file)) // a folder of the user's
      fs::remove(file);
}

/// @throws InputError  it speaks of stages that the scene does not have
void check_stages(const DriveState &state, std::size_t n_stages, const fs::path &folder)
{
  const auto has = [&](const auto &told) { return told.stage < n_stages; };
  if (state.place.stage > n_stages || !std::ranges::all_of(state.ends, has) ||
      !std::ranges::all_of(state.control.losses, has))
    throw InputError(fmt::format("{}: the checkpoint names stages beyond the {} of the scene; it is damaged. Start "
                                 "again with --overwrite.",
                                 folder.string(), n_stages));
}
} // namespace

TestRun resume_test(const Scene &scene, const fs::path &folder, const StepSettings &how)
{
  TestRun run;
  run.resumed = std::make_unique<Checkpoint>(read_checkpoint(folder / "checkpoint"));
  check_resumed_scene(folder, *run.resumed, scene);
  if (run.resumed->written.snapshots > run.resumed->written.rows)
    throw InputError(
        fmt::format("{}: the checkpoint counts {} snapshots and {} rows, but each snapshot has a row; it is "
                    "damaged. Start again with --overwrite.",
                    folder.string(), run.resumed->written.snapshots, run.resumed->written.rows));
  check_stages(run.resumed->drive, scene.stages.size(), folder);
  note_instruction_set(run.resumed->instruction_set);
  run.assembly = std::make_shared<Assembly>(run.resumed->state, how);
  restore(*run.resumed, *run.assembly);
  run.state = run.resumed->drive;
  run.specimen = run.resumed->specimen;
  return run;
}

Summary run_test(const RunRequest<Scene> &request, TestRun &run, RunObserver *watcher)
{
  const auto &[scene, folder, command_line, use, quiet, threads] = request;
  if (!run.folder)
    run.folder = open_result_folder(folder, use); // only now that everything else went well may older results go
  if (!run.resumed)
    write_provenance(folder, scene, command_line, run.specimen);
  RunOutput output(folder, scene, run.specimen, quiet, run.resumed.get());
  if (run.resumed) // only now: the files may be refused
    {
      remove_end(folder, run.resumed->scene == to_toml(scene));
      write_provenance(folder, scene, command_line, run.specimen);
    }
  Watched observer(output, watcher);
  const std::uint64_t first_step = run.assembly->step();
  const Stopwatch watch;
  RunOutcome outcome = RunOutcome::finished;
  try
    {
      outcome = run_programme(scene.programme(), *run.assembly, run.state, observer);
      if (outcome == RunOutcome::finished)
        output.finish();
    }
  catch (const RunFailure &failure)
    {
      throw failure_of_run(failure, folder, [&] { output.flush(); });
    }
  const double seconds = watch.seconds();
  if (outcome == RunOutcome::interrupted)
    throw Interrupted(fmt::format("interrupted at step {}; continue with --resume", run.assembly->step()));

  const std::uint64_t steps = run.assembly->step();
  const Summary summary =
      summarise(RunHistory::read(folder, scene), scene, run.specimen, run.state, {steps, steps - first_step, seconds});
  write_json(folder / "summary.json", summary.json());
  for (const std::string &line : stage_warnings(run.state, scene))
    warn(line);
  return summary;
}
} // namespace isostat

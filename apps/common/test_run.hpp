// SPDX-License-Identifier: BSD-3-Clause
// An element test: a scene run on its specimen, from the first step or from a checkpoint. What element_test and the
// Python package do.   tested: tests/apps/kill_resume_test.py, tests/python/run_test.py
#pragma once
#include "apps/common/scene_program.hpp"
#include "apps/common/test_summary.hpp"
#include "base/files/file_lock.hpp"
#include "dem/io/checkpoint.hpp"
#include "dem/io/specimen_file.hpp"

#include <memory>
#include <optional>

namespace isostat
{
/// The state of a run: fresh from the specimen, or from a checkpoint.
struct TestRun
{
  std::shared_ptr<Assembly> assembly;
  DriveState state;
  std::map<std::string, double> specimen; ///< figures for the summary
  std::unique_ptr<Checkpoint> resumed;
  std::optional<FileLock> folder; ///< of the results, once they are begun
};

/// On a specimen, with the law of the scene.
TestRun start_test(const Scene &scene, const Specimen &specimen, const StepSettings &how);
/// From the newest checkpoint of a results folder. The scene may put the end off (apps/common/resumed_scene.hpp).
/// @throws InputError  it is of another scene, damaged, or not there
TestRun resume_test(const Scene &scene, const std::filesystem::path &folder, const StepSettings &how);

/// Runs the stages and leaves history, snapshots, checkpoints and summary.json in the folder of the request.
/// @param watcher  sees rows and the steps between them, and may stop the run; null: none
/// @pre check_result_folder()
/// @throws RunFailure  with a line about the last checkpoint
/// @throws Interrupted  stopped by a signal or the watcher; a checkpoint is there
Summary run_test(const RunRequest<Scene> &request, TestRun &run, RunObserver *watcher = nullptr);
} // namespace isostat

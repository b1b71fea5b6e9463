// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/resistance_test.py, tests/apps/calibrate_test.py, tests/apps/campaign_ranks_test.py
#pragma once
#include "apps/common/task_queue.hpp"

#include <CLI/CLI.hpp>
#include <functional>

namespace isostat
{
/// What the caller hears of the runs.
struct ChildEvents
{
  /// A run has ended.   @param code  its exit code, or 128 + the signal that ended it
  std::function<void(std::size_t index, int code, double seconds)> finished;
  /// Several times a second.   @param running  those at work now, here or in another process
  std::function<void(const std::vector<std::size_t> &running)> tick;
};

/// Where runs are shared out, and how many of them go side by side in this process.
struct RunPool
{
  TaskQueue &queue;
  int jobs;
};

/// Does the runs, at most pool.jobs at a time in this process, the others in whichever process helps (help_with_runs).
/// A run whose process is killed is done again. When a stop is requested (apps/common/interrupt.hpp) the children of
/// this process are told to end by SIGTERM and waited for, and no other run is started.
/// @return false if it was stopped
bool run_children(const RunPool &pool, const std::vector<ChildRun> &runs, const ChildEvents &events);

/// Does runs of the queue that another process leads, until that one closes it, ends or dies.
/// @return how many
/// @throws InputError   nobody leads within half a minute      @throws Interrupted  after a signal
std::size_t help_with_runs(const std::filesystem::path &queue_folder, int jobs);

/// This process among those that `mpirun` or `srun` has started with one command: ranks above 0 help the first. Read
/// from what the launcher leaves in the environment; no MPI is initialised.
struct Launch
{
  int rank = 0, size = 1;
};
Launch launch();

/// What `--jobs 0` stands for: as many runs as the machine has cores; of several ranks, which share them, one each.
int jobs_of_all_cores();

/// How much of a campaign a process does, as its command line says.
struct CampaignShare
{
  int jobs = 1;
  bool helper = false;

  void add_options(CLI::App &line);
  /// Helps whoever leads the campaign in the folder, if this process is to.   @return false if it is to lead
  /// @throws as help_with_runs()
  bool help(const std::filesystem::path &folder) const;
};
} // namespace isostat

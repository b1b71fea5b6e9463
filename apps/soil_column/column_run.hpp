// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/soil_column/column_summary.hpp"

#include <filesystem>

namespace isostat
{
/// What main has found out.
struct RunRequest
{
  ColumnScene scene;
  std::filesystem::path folder;
  std::string command_line;
  bool resume = false, overwrite = false, quiet = false;
};

struct RunResult
{
  ColumnSummary summary;
  RunTimes times;
};

/// Runs a scene to its end and leaves all files but the summary.   Collective over MPI_COMM_WORLD.
/// @throws InputError  before anything that is there is changed   @throws RunFailure  with step, time and checkpoint
/// @throws Interrupted  after a signal, with a checkpoint
/// tested: tests/apps/soil_column_test.py
template <int dim>
RunResult run_dynamic(const RunRequest &request);
template <int dim>
RunResult run_consolidation(const RunRequest &request);

/// What both kinds of run share.
template <int dim>
Discretisation<dim> column_mesh(const ColumnScene &scene, const Supports &supports);
/// The newest checkpoint; null if the run starts anew.
/// @throws InputError  none there, or it belongs to another scene
std::unique_ptr<ColumnCheckpoint> checkpoint_of(const RunRequest &request);
/// Old results go now, if they may, and provenance is written; on the first rank.
void open_folder(const RunRequest &request);
} // namespace isostat

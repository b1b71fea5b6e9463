// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/common/scene_program.hpp"
#include "apps/soil_column/files.hpp"
#include "apps/soil_column/summary.hpp"
#include "base/error.hpp"
#include "base/record/progress.hpp"

#include <filesystem>
#include <functional>

namespace isostat
{
using ColumnRequest = RunRequest<ColumnScene>;

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
RunResult run_dynamic(const ColumnRequest &request);
template <int dim>
RunResult run_consolidation(const ColumnRequest &request);

/// What both kinds of run share.
template <int dim>
Discretisation<dim> column_mesh(const ColumnScene &scene, const Supports &supports);
DynamicsSettings dynamics_settings(const ColumnScene &scene, const std::array<Motion, 3> &motions);
/// The newest checkpoint; null if the run starts anew.
/// @throws InputError  none there, or it belongs to another scene
std::unique_ptr<ColumnCheckpoint> checkpoint_of(const ColumnRequest &request);
/// Old results go now, if they may, and provenance is written; on the first rank.
void open_folder(const ColumnRequest &request);
/// Sizes of the mesh, largest values and the last row, over all ranks.   Collective.
template <int dim>
ColumnSummary summary_so_far(const Discretisation<dim> &space, ColumnFiles<dim> &files, PeakFollower<dim> &follower);
/// After a signal: brings the files up to date, calls `save` unless the run is distributed, and throws Interrupted.
/// Collective if the run is distributed.
template <int dim>
void stop_if_requested(const ColumnRequest &request, std::uint64_t step, ColumnFiles<dim> &files,
                       const std::function<void()> &save);
/// A failed step: brings the files up to date and throws RunFailure with step, time and checkpoint; if the other ranks
/// would wait for this one it ends them all.
template <int dim>
[[noreturn]] void fail(const RunFailure &failure, std::uint64_t step, double time, const Discretisation<dim> &space,
                       ColumnFiles<dim> &files);
/// The column in a few numbers, for the progress line.
std::string in_words(const ColumnState &state);
} // namespace isostat

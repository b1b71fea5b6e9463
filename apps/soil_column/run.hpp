// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/common/scene_program.hpp"
#include "apps/soil_column/summary.hpp"

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
} // namespace isostat

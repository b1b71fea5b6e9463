// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/common/scene_program.hpp"
#include "apps/deposit/soil_material.hpp"
#include "apps/soil_column/summary.hpp"

namespace isostat
{
struct ColumnRequest : RunRequest<ColumnScene>
{
  using RunRequest::RunRequest;
  UserMaterials materials; ///< of layers whose material is user
};

struct RunResult
{
  ColumnSummary summary;
  RunTimes times;
};

/// Runs a scene to its end and leaves all files but summary.txt and figures.   Collective over MPI_COMM_WORLD.
/// @throws InputError  before anything existing is changed   @throws RunFailure  with step, time and checkpoint
/// @throws Interrupted  after a signal, with a checkpoint
/// tested: tests/apps/soil_column_test.py
RunResult run_column(const ColumnRequest &request);
/// The parts of it: one kind of analysis in this many dimensions, with neither times.json nor summary.json.
template <int dim>
RunResult run_dynamic(const ColumnRequest &request);
template <int dim>
RunResult run_consolidation(const ColumnRequest &request);
RunResult run_plate(const ColumnRequest &request); ///< in two dimensions
} // namespace isostat

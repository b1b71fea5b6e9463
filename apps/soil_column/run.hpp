// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/common/scene_program.hpp"
#include "apps/common/summary.hpp"
#include "apps/deposit/soil_material.hpp"

namespace isostat
{
struct ColumnRequest : RunRequest<ColumnScene>
{
  using RunRequest::RunRequest;
  UserMaterials materials; ///< of layers whose material is user
  bool warns = true;       ///< on stderr; the summary has warnings anyway
};

/// What the run took on this machine.
struct RunTimes
{
  double wall = 0, solver = 0, material = 0; ///< s: from start to end, in steps without the material, in the material
  double steps = 0;                          ///< that were made, after a resume fewer than the run has
  double packing_trials = 0, packing_steps = 0; ///< calls of packings, their own time steps
  double in_packings = 0, all_packings = 0;     ///< s: wall clock in packings, on all cores together
  double waves = 0;                             ///< s: for their wave velocities
};

/// For the terminal.
std::string to_text(const RunTimes &times);

struct RunResult
{
  Summary summary;
  RunTimes times;
  std::string failure; ///< of a block, why it has stopped before its end; empty: it has not
};

/// Runs a scene to its end and leaves all files but summary.txt and figures.   Collective over MPI_COMM_WORLD.
/// @throws InputError  before anything existing is changed   @throws RunFailure  with step, time and checkpoint
/// @throws Interrupted  after a signal, with a checkpoint
/// tested: tests/apps/soil_column_test.py
RunResult run_column(const ColumnRequest &request);
/// The parts of it: one kind of analysis, with neither times.json nor summary.json.
RunResult run_dynamic(const ColumnRequest &request);
RunResult run_consolidation(const ColumnRequest &request);
RunResult run_plate(const ColumnRequest &request);
RunResult run_biaxial(const ColumnRequest &request);
} // namespace isostat

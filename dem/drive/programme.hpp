// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/drive/stages/stages.hpp"

#include <string>

namespace isostat
{
/// How often a row of the history, and a stored snapshot, is due.
struct RecordSpec
{
  double record_stress = 1e3;          ///< a history row whenever p' or the driven load has moved by this much, Pa
  double record_strain = 1e-4;         ///< ... or the driven strain by this much
  std::uint64_t record_steps = 5000;   ///< ... or after this many steps
  std::string snapshots = "reversals"; ///< "none", "reversals" (and stage ends), "strain"
  double snapshot_strain = 0.01;       ///< spacing for "strain"

  bool operator==(const RecordSpec &) const = default;
};

/// What the laboratory does: the stages in their order, and how all of them are run.
struct Programme
{
  MotionSpec motion = {};
  StaticDrive drive = {};
  ServoSpec servo = {};
  RecordSpec record = {};
  ControlSpec control = {};
  std::vector<Stage> stages = {};
};

/// The observer of a run. Observers never change it: trajectories are the same with output on or off.
class RunObserver
{
public:
  virtual ~RunObserver() = default;
  /// A row of the history is due.   @param snapshot  a stored snapshot is due as well
  virtual void record(const Assembly &, const DriveState &, const Observation &, bool snapshot) = 0;
  virtual void event(const std::string &) {}
  /// After every completed step but the last of a stage: the state is what a checkpoint keeps.
  /// @return false to stop here (interrupt)
  virtual bool after_step(const Assembly &, const DriveState &, const Observation &) { return true; }
};

enum class RunOutcome
{
  finished,
  interrupted
};

/// Runs the stages from where `state` is (a fresh state: from the first), one time step after the other:
///
///     time step -> contact forces -> stress -> stage (verdict, strain, servo, reversal) -> record -> motion, walls
///
/// The specimen is bounded by walls or by a periodic cell, whose strain takes the place of wall motion.
/// A stage ends with walls at rest for one step. The time step follows the critical step of the closed contacts
/// (docs/theory.md) every 200 steps of a servo stage and every 2,000 of a shear stage; a fixed one is checked there.
/// What a stage that shears must keep is checked every 50 steps (dem/drive/control.hpp).
/// @throws RunFailure  a stage that cannot reach its target; lost control if the scene asks for it; an unstable
///         fixed time step; an exploding packing
/// tested: tests/verification/programme_test.cpp, tests/hard/, tests/regression/
RunOutcome run_programme(const Programme &programme, Assembly &assembly, DriveState &state, RunObserver &observer);

/// Logarithmic strain along x, y, z since the start of shearing, tension positive [-]; of a cell sheared by gamma the
/// sum of the normal components of L dt.
Vec3 strain_since_start(const Assembly &assembly, const PathState &path);
} // namespace isostat

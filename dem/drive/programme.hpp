// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/drive/undrained.hpp"
#include "dem/scene/scene.hpp"

#include <string>

namespace isostat
{
/// Who watches a run. Observers never change it: trajectories are the same with output on or off.
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

/// Runs the stages of a scene from where `state` stands (a fresh state: from the first), one time step after the other:
///
///     time step -> contact forces -> stress -> driver (strain, servo, reversal) -> record -> motion, walls
///
/// The specimen is bounded by walls or by a periodic cell, whose strain takes the place of wall motion.
/// A stage ends with walls at rest for one step. The time step follows the critical step of the closed contacts
/// (DESIGN 4) every 200 steps of a servo stage and every 2,000 of a shear stage; a fixed one is checked there.
/// @throws RunFailure  a stage that cannot reach its target; an unstable fixed time step; an exploding packing
/// tested: tests/verification/programme_test.cpp, tests/hard/, tests/regression/
RunOutcome run_programme(const MotionSpec &motion, const SpecimenSpec &specimen, const OutputSpec &output,
                         const std::vector<Stage> &stages, Assembly &assembly, DriveState &state,
                         RunObserver &observer);

/// Axial logarithmic strain since the start of shearing, compression positive [-].
double axial_strain(const Assembly &assembly, const DriveState &state);

/// Logarithmic strain along x, y, z since the start of shearing, tension positive [-]; of a cell sheared by gamma the
/// sum of the normal components of L dt.
Vec3 strain_since_origin(const Assembly &assembly, const DriveState &state);

std::string to_string(StageKind kind);
} // namespace isostat

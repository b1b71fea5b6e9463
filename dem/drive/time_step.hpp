// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/assembly/assembly.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/drive/motion_spec.hpp"

namespace isostat
{
/// Sets assembly.settings.time_step and pace.time_step when a review is due (every 200 steps of a servo stage, 2,000 of
/// a shear stage): safety times the bound of the critical step, or the scene's fixed step.
/// @param step_number  of the stage
/// @throws RunFailure when a fixed step exceeds the true critical step (power iteration; only checked where the step
///         is above the bound): the run would be unstable, not merely inaccurate
/// tested: tests/verification/critical_step_test.cpp
void update_time_step(const MotionSpec &motion, bool shearing, std::uint64_t step_number, Assembly &assembly,
                      Pace &pace);
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// Why stages ended, and which of them did not come to their end by themselves: max_steps ended them before any of their
// conditions was met, or one was met when they began.
// tested: tests/dem/drive/stages/stage_end_test.cpp, tests/apps/summary_test.py
#pragma once
#include "dem/drive/stages/stages.hpp"

#include <string>

namespace isostat
{
/// Notes it in DriveState::ends, of a stage that is repeated once for each condition with the number of times.
/// @return it was noted as a new entry
bool note_end(const StageBehaviour &stage, const StageContext &c, const Observation &seen, EndCondition by);

/// It has conditions of its own, and none of them ended it, or one was met when it began.
/// @param stages  of the programme
bool is_early(const StageEnd &end, const std::vector<Stage> &stages);

/// "stage 0 (undrained-cyclic): ended by until.strain = 15 % (15.2 %), before until.cycles = 60 (3 reached), ..." or
/// "stage 1 (path), cycle 2 of 5 of stages 0 to 1: ended by max_steps = 2000 before any of its conditions was met: ..."
std::string to_text(const StageEnd &end, const std::vector<Stage> &stages);

/// "strain", "cycles", "max_steps", "balance", "course" ...
const char *name_of(EndCondition condition);
} // namespace isostat

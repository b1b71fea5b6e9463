// SPDX-License-Identifier: BSD-3-Clause
// Stages that did not come to their end by themselves: max_steps ended them before any of their conditions was met, or
// one was met when they began.   tested: tests/dem/drive/stages/early_end_test.cpp, tests/apps/early_end_test.py
#pragma once
#include "dem/drive/stages/stages.hpp"

#include <string>

namespace isostat
{
/// Notes it in DriveState::early_ends, of a stage that is repeated once with the number of times; not of a stage
/// without conditions of its own, whose end max_steps is.
/// @return it was noted as a new entry
bool note_early_end(const StageBehaviour &stage, const StageContext &c, const Observation &seen, bool at_once);

/// "stage 1 (path), cycle 2 of 5 of stages 0 to 1: ended by max_steps = 2000 before any of its conditions: ..."
/// @param stages  of the programme
std::string to_text(const EarlyEnd &end, const std::vector<Stage> &stages);
} // namespace isostat

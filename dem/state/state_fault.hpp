// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/state/snapshot.hpp"

namespace isostat
{
/// What makes a state that was read unfit to continue from, a value that is not finite or no size or mass, with the
/// grain or contact that has it; empty if nothing does.
/// tested: tests/dem/io/specimen_file_test.cpp, tests/apps/damaged_checkpoints_test.py,
/// fuzz_packed_element
std::string state_fault(const Snapshot &state);
} // namespace isostat

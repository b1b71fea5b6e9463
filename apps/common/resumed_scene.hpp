// SPDX-License-Identifier: BSD-3-Clause
// What the scene of a test may say that it did not say when the test began.
// tested: tests/apps/extend_test.py
#pragma once
#include "dem/io/checkpoint.hpp"
#include "dem/scene/scene.hpp"

#include <filesystem>

namespace isostat
{
/// A test is resumed with the scene of its checkpoint. Only keys that say when a stage ends may be larger than they were:
/// strain, max_steps (0: no limit), times, and below `until` cycles, reversals_after_liquefaction, strain and
/// volumetric_strain, of stages that are not over. The results are then those of a run that had them from the start.
/// @throws InputError  another key differs, one is smaller, a stage is over: names it with both values
void check_resumed_scene(const std::filesystem::path &folder, const Checkpoint &checkpoint, const Scene &scene);
} // namespace isostat

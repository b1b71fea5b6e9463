// SPDX-License-Identifier: BSD-3-Clause
// What programs share that run element_test many times below one folder.
// tested: tests/apps/resistance_test.py, tests/apps/calibrate_test.py
#pragma once
#include "apps/common/child_runs.hpp"
#include "dem/scene/scene.hpp"

namespace isostat
{
/// The element_test beside the running program.   @throws InputError  it is not there
std::filesystem::path element_test_program();

/// A run on one thread, or the rest of it where there is a checkpoint.
/// @param folder  of the results   @param log  what it prints
ChildRun element_test_run(const std::filesystem::path &scene_file, const std::filesystem::path &folder,
                          const std::filesystem::path &log);

/// True if the folder holds the results of this scene, to its end.
bool is_finished_run(const std::filesystem::path &folder, const Scene &scene);
} // namespace isostat

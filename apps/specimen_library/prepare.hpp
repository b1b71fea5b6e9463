// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/io/specimen_file.hpp"
#include "dem/scene/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isostat
{
/// One specimen to be prepared, and what came of it.
struct Task
{
  Scene scene;
  std::string name; ///< for people: "seed 3, 100 kPa, D_r 0.5"
  std::optional<Specimen> specimen;
  std::string failure;    ///< why there is none
  bool bad_input = false; ///< the failure is one of the scene
};

/// How much of the preparations a process does.
struct PreparationShare
{
  int jobs = 1;        ///< side by side, each on a thread of its own
  bool helper = false; ///< leave alone what other processes prepare
  bool quiet = false;
};

/// Prepares all tasks, or takes them from the cache. Processes with the same cache share them: a task is locked by who
/// prepares it, and waited for by the others, unless they are helpers; if that process dies, the next one prepares it.
/// One that fails does not keep the others from being prepared. Says on stderr what begins, what is done, and when the
/// rest will be.
/// @throws Interrupted  after a signal; what was finished is in the cache
/// @post every task has a specimen or a failure, unless this is a helper
void prepare_side_by_side(std::vector<Task> &tasks, const std::filesystem::path &cache, const PreparationShare &share);
} // namespace isostat

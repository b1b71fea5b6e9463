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

/// Prepares all tasks, or takes them from the cache, `jobs` side by side, each on a thread of its own. One that fails
/// does not keep the others from being prepared. Says on stderr what begins, what is done, and when the rest will be.
/// @throws Interrupted  after a signal; what was finished is in the cache
/// @post every task has a specimen or a failure
void prepare_side_by_side(std::vector<Task> &tasks, const std::filesystem::path &cache, int jobs, bool quiet);
} // namespace isostat

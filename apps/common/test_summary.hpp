// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/summary_test.py, tests/apps/resistance_test.py
#pragma once
#include "apps/common/run_history.hpp"
#include "apps/common/summary.hpp"
#include "dem/drive/drive_state.hpp"
#include "dem/scene/scene.hpp"

#include <map>

namespace isostat
{
struct TestEffort
{
  std::uint64_t steps = 0;
  std::uint64_t last_steps = 0; ///< since the run was begun or resumed for the last time
  double seconds = 0;           ///< likewise
};

/// What is reported of a finished test, from its history and the driver's state. What a test does not have is
/// left out.
/// @param specimen  its figures (Specimen::numbers)
Summary summarise(const RunHistory &run, const Scene &scene, const std::map<std::string, double> &specimen,
                  const DriveState &state, const TestEffort &effort);
} // namespace isostat

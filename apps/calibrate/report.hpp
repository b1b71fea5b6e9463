// SPDX-License-Identifier: BSD-3-Clause
// What a calibration leaves.   tested: tests/apps/calibrate_test.py
#pragma once
#include "apps/calibrate/trials.hpp"

namespace isostat
{
/// What is there when the search has ended.
struct CalibrationResult
{
  const CalibrationPlan &plan;
  const SceneMaker &scenes;
  const Trials &trials;
  std::size_t start = 0, best = 0; ///< numbers of trials, from 0
  std::string ending;              ///< why the search ended
};

/// Writes curves.csv, calibrate.json (read by apps/figures/calibrate.py), best_scene.toml, best/CURVE.toml and
/// summary.txt.   @return the summary
std::string write_report(const CalibrationResult &result, const std::filesystem::path &folder);
} // namespace isostat

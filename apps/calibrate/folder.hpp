// SPDX-License-Identifier: BSD-3-Clause
// The folder of a calibration:
//
//     plan.toml  scene.toml  laboratory/NAME.csv   what makes its results: tells this calibration from another one
//     runs/TRIAL/CURVE_seedN/                      results of a run; beside it .toml (scene), .log, .failed (why)
//     specimens/                                   prepared for them
//     trials.csv  curves.csv  calibrate.json  summary.txt  best_scene.toml  best/CURVE.toml  figures/
//
// tested: tests/apps/calibrate_test.py
#pragma once
#include "apps/calibrate/plan.hpp"

#include <filesystem>
#include <string>

namespace isostat
{
/// That what a folder keeps is of this plan; only the budget may differ.
/// @throws InputError  with the first line that differs
void check_calibration_folder(const std::filesystem::path &folder, const CalibrationPlan &plan,
                              const std::string &scene);

/// Locks the folder for this plan and makes it if it is missing.
/// @param scene  text of the plan's scene, every key resolved
/// @param command_line  for provenance.txt   @param overwrite  what another calibration left is removed first
/// @throws InputError  another program works in it; it holds something else, or, without `overwrite`, a calibration
///         with another plan, scene or laboratory file
void open_calibration_folder(const std::filesystem::path &folder, const CalibrationPlan &plan, const std::string &scene,
                             const std::string &command_line, bool overwrite);
} // namespace isostat

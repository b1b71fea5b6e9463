// SPDX-License-Identifier: BSD-3-Clause
// Strength and dilatancy of the drained triaxial stages of a test, for its summary.
// tested: tests/apps/drained_report_test.py
#pragma once
#include "apps/common/run_history.hpp"
#include "base/files/json.hpp"
#include "dem/measure/strength.hpp"
#include "dem/scene/scene.hpp"

#include <string>

namespace isostat
{
struct DrainedStage
{
  std::size_t stage = 0; ///< of the scene
  std::string cycle;     ///< which time it is, where stages are repeated (dem/drive/stages/cycles.hpp)
  DrainedStrength strength;
};

/// Of each stage that drives the axial strain while a servo keeps stresses, from the history; of one that is repeated
/// the last time. Stages that unload have no strength.
std::vector<DrainedStage> drained_stages(const RunHistory &run, const Scene &scene);

/// Lines for the terminal, each after a line break.
std::string to_text(const std::vector<DrainedStage> &stages);
/// The member "drained" of summary.json.
Json to_json(const std::vector<DrainedStage> &stages);
} // namespace isostat

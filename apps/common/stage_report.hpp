// SPDX-License-Identifier: BSD-3-Clause
// What the summary of a test says of its stages: the response to cycles, lost control, ends, repeats.
// tested: tests/apps/early_end_test.py, tests/apps/control_test.py, tests/apps/resistance_test.py
#pragma once
#include "base/files/json.hpp"
#include "dem/scene/scene.hpp"

#include <string>
#include <vector>

namespace isostat
{
/// How a stage ended, and what is said of it (dem/drive/stages/stage_end.hpp).
struct ToldEnd
{
  StageEnd end;
  bool early = false;
  std::string text;
};
std::vector<ToldEnd> told_ends(const DriveState &state, const Scene &scene);

/// Lines for the terminal, each after a line break: "limited flow (with stress reversal, loads from ...)".
/// @param name  of the response (dem/drive/stages/cyclic_response.hpp)
std::string response_text(const std::string &name, const CyclicResponse &cycles);
/// Ends, lost control, and what is repeated.
std::string stages_text(const DriveState &state, const Scene &scene);
/// What of it is warned of: "control lost: ...", "stage 1 (path): ended by max_steps ...".
std::vector<std::string> stage_warnings(const DriveState &state, const Scene &scene);

/// Members of summary.json: "cyclic_response", "control_lost", "ended", "ended_early".
Json response_json(const std::string &name, const CyclicResponse &cycles);
Json control_json(const std::vector<ControlLoss> &losses);
Json ends_json(const std::vector<ToldEnd> &ends);
Json early_ends_json(const std::vector<ToldEnd> &ends);
} // namespace isostat

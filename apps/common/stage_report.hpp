// SPDX-License-Identifier: BSD-3-Clause
// What the summary of a test says of its stages: the response to cycles, lost control, ends, repeats.
// tested: tests/apps/summary_test.py, tests/apps/resistance_test.py
#pragma once
#include "apps/common/summary.hpp"
#include "dem/scene/scene.hpp"

namespace isostat
{
/// "limited flow (with stress reversal, loads from ...)", of the last cyclic stage if it has a response.
void add_response(const DriveState &state, const Scene &scene, Summary &summary);
/// Ends, lost control, and what is repeated.
void add_stages(const DriveState &state, const Scene &scene, Summary &summary);
/// Its warnings: "control lost: ...", "stage 1 (path): ended by max_steps ...".
std::vector<std::string> stage_warnings(const DriveState &state, const Scene &scene);
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/summary_test.py
#pragma once
#include "apps/common/run_history.hpp"
#include "apps/common/summary.hpp"
#include "dem/scene/scene.hpp"

namespace isostat
{
/// Strength and dilatancy of each stage that drives the axial strain while a servo keeps stresses, from the history.
void add_drained(const RunHistory &run, const Scene &scene, Summary &summary);
} // namespace isostat

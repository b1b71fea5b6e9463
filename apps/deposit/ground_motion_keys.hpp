// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"
#include "base/scene/fragment.hpp"

namespace isostat
{
/// The keys of [[motion]].   tested: tests/apps/deposit/scene_test.cpp
SceneFragment<ColumnMotion> ground_motion_keys();
} // namespace isostat

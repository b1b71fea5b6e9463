// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/fragment.hpp"
#include "dem/drive/stages/behaviour.hpp"

namespace isostat
{
/// The keys of a stage of kind "path" alone.   tested: tests/dem/scene/scene_test.cpp
SceneFragment<StageBehaviour> path_keys();
} // namespace isostat

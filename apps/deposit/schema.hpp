// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/scene.hpp"
#include "base/scene/document.hpp"

namespace isostat
{
/// The keys of a soil column: fields are those of a ColumnScene, of a ColumnLayer below [[layer]] and of a ColumnMotion
/// below [[motion]].   tested: tests/apps/deposit/scene_test.cpp
const SceneSchema &column_schema();

/// Rules that bind several keys.   @throws InputError   tested: tests/apps/deposit/scene_error_test.cpp
void check_column(const SceneDocument &document, ColumnScene &scene);
} // namespace isostat

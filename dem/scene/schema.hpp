// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/document.hpp"
#include "dem/scene/scene.hpp"

namespace isostat
{
/// The keys of an element test: fields are those of a Scene, and of a Stage below [[stage]].
/// tested: tests/dem/scene/scene_test.cpp (defaults equal those of the structs, every key has a sentence)
const SceneSchema &scene_schema();

/// Whether specimen.pressure has an effect: it prepares the packing, or a stage takes it.
bool takes_pressure(const Scene &scene);

/// Rules that bind several keys: those that exclude each other, limits in order, what needs the periodic cell.
/// @throws InputError      tested: tests/dem/scene/scene_test.cpp, tests/dem/scene/scene_error_test.cpp
void check_scene(const SceneDocument &document, Scene &scene);
} // namespace isostat

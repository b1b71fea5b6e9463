// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/schema.hpp"

namespace isostat
{
/// A scene as a complete file: every key with its value and unit, with the digits that bring it back to the bit. What
/// has no effect is left out: keys foreign to the kind of their table, inside a table that is switched off, or
/// displaced by another key of their group; and 0 or no text where a key without default is not set.
/// @param scene  of the type that the schema was made for
/// tested: tests/dem/scene/scene_test.cpp, tests/apps/deposit/scene_test.cpp
std::string write_scene(const SceneSchema &schema, StructRef scene);

/// A commented scene file with all defaults, units, ranges and one sentence per key (--print-defaults).
std::string write_defaults(const SceneSchema &schema);

/// The table of all keys as Markdown.
std::string write_manual(const SceneSchema &schema);
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// A fuzz target of text as a scene: what is taken is written and read back to the same scene, bit for bit. Its inputs
// are changed by the schema (scene_mutator.hpp).
#pragma once
#include "tests/fuzz/input.hpp"
#include "tests/fuzz/scene_mutator.hpp"

namespace isostat::fuzz
{
struct SceneTarget
{
  void (*try_text)(const std::string &text);
  const SceneSchema &(*schema)();
};

/// What each such target defines.
extern const SceneTarget scene_target;

/// @tparam parse  (text, name) -> scene
template <auto parse>
void try_scene(const std::string &text)
{
  round_trip(text, [](const std::string &given, const char *name) {
    if constexpr (requires { parse(given, name, {}); })
      return parse(given, name, {});
    else
      return parse(given, name);
  });
}
} // namespace isostat::fuzz

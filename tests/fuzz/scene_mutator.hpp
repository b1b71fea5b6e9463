// SPDX-License-Identifier: BSD-3-Clause
// Changes of a scene that know its schema: most of the results are TOML, and much of it is a scene.
#pragma once
#include "base/scene/schema.hpp"

#include <random>
#include <string>

namespace isostat::fuzz
{
class SceneMutator
{
public:
  SceneMutator(const SceneSchema &schema, unsigned seed) : schema_(schema), draw_(seed) {}

  /// The scene with a key set, often to a bound of its range or to what programs get wrong, or with a line removed,
  /// doubled or moved.
  std::string changed(const std::string &scene);

private:
  std::size_t below(std::size_t n) { return draw_() % n; }
  std::string number();
  std::string bound(const Key &key);
  std::string quantity(const Key &key);
  std::string value(const Key &key);
  void set_key(std::vector<std::string> &lines);
  void move_line(std::vector<std::string> &lines);

  const SceneSchema &schema_;
  std::minstd_rand draw_;
};

/// LLVMFuzzerCustomMutator of a target that reads a scene: every other time the bytes as such are changed.
std::size_t mutate_scene(const SceneSchema &schema, std::uint8_t *data, std::size_t size, std::size_t most,
                         unsigned seed);
} // namespace isostat::fuzz

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/stages.hpp"

namespace isostat
{
namespace
{
template <class>
struct Kinds;
template <class... Kind>
struct Kinds<std::variant<Kind...>>
{
  static std::vector<const char *> names() { return {Kind{}.kind()...}; }
  static std::vector<std::vector<Key>> keys() { return {Kind::keys()...}; }
};
} // namespace

StageBehaviour &behaviour(Stage &stage)
{
  return std::visit([](StageBehaviour &kind) -> StageBehaviour & { return kind; }, stage);
}

const StageBehaviour &behaviour(const Stage &stage)
{
  return std::visit([](const StageBehaviour &kind) -> const StageBehaviour & { return kind; }, stage);
}

std::span<const char *const> stage_kind_names()
{
  static const std::vector<const char *> names = Kinds<Stage>::names();
  return names;
}

SceneFragment<StageBehaviour> stage_keys()
{
  static const std::vector<Key> keys = interleave(Kinds<Stage>::keys());
  return {keys};
}
} // namespace isostat

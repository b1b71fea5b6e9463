// SPDX-License-Identifier: BSD-3-Clause
// Keys of settings of stages: which kinds take them follows from the classes.   tested: tests/dem/scene/scene_test.cpp
#pragma once
#include "dem/drive/stages/stages.hpp"

namespace isostat
{
/// The bits of the kinds that are of a family, for Key::kinds.
template <class Family, class... Kinds>
constexpr unsigned kinds_of(const std::variant<Kinds...> *)
{
  unsigned kinds = 0, bit = 1;
  ((kinds |= std::is_base_of_v<Family, Kinds> ? bit : 0, bit <<= 1), ...);
  return kinds;
}
template <class... Family>
constexpr unsigned kinds_in = (kinds_of<Family>(static_cast<const Stage *>(nullptr)) | ...);

template <auto setting>
struct InStage;
template <class Part, class T, T Part::*setting>
struct InStage<setting>
{
  static constexpr unsigned kinds = kinds_in<Part>;
  Field operator()(StageBehaviour &stage) const { return &(dynamic_cast<Part &>(stage).*setting); }
};

/// The key of a setting. It belongs to the kinds given, or else to all that inherit the setting.
template <auto setting, class... Kinds>
constexpr Key of(Key key)
{
  if constexpr (sizeof...(Kinds) > 0)
    key.kinds = kinds_in<Kinds...>;
  else
    key.kinds = InStage<setting>::kinds;
  key.field = InStage<setting>{};
  return key;
}
} // namespace isostat

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

/// The key of a setting. It belongs to the kinds given, or else to all that inherit the setting.
template <auto setting, class... Kinds>
constexpr Key of(Key key)
{
  if constexpr (sizeof...(Kinds) > 0)
    key.kinds = kinds_in<Kinds...>;
  else
    key.kinds = kinds_in<typename detail::Member<setting>::Struct>;
  key.field = member<setting>;
  return key;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <type_traits>

namespace isostat
{
/// A struct that lists its fields once: static for_each(self, f) calls f(name, field) for each of them, self const or
/// not. Files, bytes and cache keys go by that list.
/// tested: tests/dem/io/checkpoint_test.cpp
template <class T>
concept Listed = requires(T &value)
{
  std::remove_const_t<T>::for_each(value, [](const char *, auto &) {});
};

/// f(field) for all fields of a struct and of the structs in it, in their order.
template <Listed T, class F>
void for_each_leaf(T &value, F &&f)
{
  std::remove_const_t<T>::for_each(value, [&]<class Field>(const char *, Field &field) {
    if constexpr (Listed<Field>)
      for_each_leaf(field, f);
    else
      f(field);
  });
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>

namespace isostat
{
namespace detail
{
/// f(name, field) for each field, the names from a list "a, b, c".
template <class F, class... Field>
void for_each_named(std::string_view names, F &&f, Field &...fields)
{
  const auto next_name = [&names] {
    const std::size_t end = std::min(names.find(','), names.size());
    std::string name(names.substr(0, end));
    names.remove_prefix(std::min(names.find_first_not_of(", ", end), names.size()));
    return name;
  };
  (f(next_name().c_str(), fields), ...);
}
} // namespace detail

/// A struct that lists its fields once: static for_each(self, f) calls f(name, field) for each of them, self const or
/// not. Files, bytes and cache keys go by that list. ISOSTAT_FIELDS(a, b) within the struct is that list, of all its
/// fields in their order, under their own names.
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

/// A structured binding takes the struct apart: a field that is not listed does not compile.
#define ISOSTAT_FIELDS(...) \
  template <class Self, class F> \
  static void for_each(Self &self_, F &&f_) \
  { \
    auto &[__VA_ARGS__] = self_; \
    isostat::detail::for_each_named(#__VA_ARGS__, f_, __VA_ARGS__); \
  }

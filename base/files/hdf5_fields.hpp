// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/error.hpp"
#include "base/fields.hpp"
#include "base/files/hdf5.hpp"
#include "base/types.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>
#include <optional>
#include <type_traits>
#include <vector>

namespace isostat::hdf5
{
namespace detail
{
inline constexpr const char *axis_names[] = {"_x", "_y", "_z"};

inline double number(const Group &group, const std::string &name)
{
  const auto value = group.attribute<double>(name);
  if (!std::isfinite(value))
    throw InputError(group.where() + "/@" + name + ": is not a finite number; the file is damaged");
  return value;
}

/// Of an enumeration that is stored its last_of(); 1 of a truth value.
template <class T>
constexpr std::uint64_t largest()
{
  if constexpr (std::is_same_v<T, bool>)
    return 1;
  else if constexpr (std::is_enum_v<T>)
    return static_cast<std::uint64_t>(last_of(T{}));
  else
    return std::numeric_limits<T>::max();
}

inline std::uint64_t whole_number(const Group &group, const std::string &name, std::uint64_t largest)
{
  const auto value = group.attribute<std::uint64_t>(name);
  if (value > largest)
    throw InputError(
        fmt::format("{}/@{} = {}, expected at most {}; the file is damaged", group.where(), name, value, largest));
  return value;
}
} // namespace detail

/// Stores a field in a group under its name: numbers as attributes of their own type (truth values and enumerations as
/// whole numbers), vectors as three, a struct that lists its fields (for_each) as a group, a list of them as a group of
/// such. An optional one is left out when it is empty.
/// tested: tests/dem/io/checkpoint_test.cpp
template <class T>
void write_field(Group &group, const std::string &name, const T &value)
{
  if constexpr (Listed<const T>)
    {
      Group below = group.create_group(name);
      T::for_each(value, [&](const char *field, const auto &x) { write_field(below, field, x); });
    }
  else if constexpr (std::is_same_v<T, double>)
    group.set_attribute(name, value);
  else if constexpr (std::is_same_v<T, Vec3>)
    for (int axis = 0; axis < 3; ++axis)
      group.set_attribute(name + detail::axis_names[axis], value[axis]);
  else
    group.set_attribute(name, static_cast<std::uint64_t>(value));
}
template <class T>
void write_field(Group &group, const std::string &name, const std::optional<T> &value)
{
  if (value)
    write_field(group, name, *value);
}
/// A list of structs as a group of groups "0", "1" ...; an empty one is an empty group.
template <class T>
void write_field(Group &group, const std::string &name, const std::vector<T> &values)
{
  Group below = group.create_group(name);
  for (std::size_t i = 0; i < values.size(); ++i)
    write_field(below, std::to_string(i), values[i]);
}
/// A map as a group of attributes.
template <class T>
void write_field(Group &group, const std::string &name, const std::map<std::string, T> &values)
{
  Group below = group.create_group(name);
  for (const auto &[key, value] : values)
    below.set_attribute(key, value);
}

/// The way back.  @throws InputError naming the field that is missing, of another type, or not a finite number
template <class T>
void read_field(const Group &group, const std::string &name, T &value)
{
  if constexpr (Listed<T>)
    {
      const Group below = group.group(name);
      T::for_each(value, [&](const char *field, auto &x) { read_field(below, field, x); });
    }
  else if constexpr (std::is_same_v<T, double>)
    value = detail::number(group, name);
  else if constexpr (std::is_same_v<T, Vec3>)
    for (int axis = 0; axis < 3; ++axis)
      value[axis] = detail::number(group, name + detail::axis_names[axis]);
  else
    value = static_cast<T>(detail::whole_number(group, name, detail::largest<T>()));
}
template <class T>
void read_field(const Group &group, const std::string &name, std::optional<T> &value)
{
  value.reset();
  if (group.has(name) || group.has_attribute(name))
    read_field(group, name, value.emplace());
}
template <class T>
void read_field(const Group &group, const std::string &name, std::vector<T> &values)
{
  const Group below = group.group(name);
  values.clear();
  while (below.has(std::to_string(values.size())))
    {
      T value;
      read_field(below, std::to_string(values.size()), value);
      values.push_back(std::move(value));
    }
}
template <class T>
void read_field(const Group &group, const std::string &name, std::map<std::string, T> &values)
{
  const Group below = group.group(name);
  for (const std::string &key : below.attribute_names())
    if constexpr (std::is_same_v<T, double>)
      values[key] = detail::number(below, key);
    else
      values[key] = below.attribute<T>(key);
}
} // namespace isostat::hdf5

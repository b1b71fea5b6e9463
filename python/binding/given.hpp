// SPDX-License-Identifier: BSD-3-Clause
// Arguments that are refused by their names, where pybind11 would list its signatures.   tested: tests/python/arguments_test.py
#pragma once
#include "base/error.hpp"
#include "python/binding/arrays.hpp"

#include <algorithm>
#include <concepts>
#include <filesystem>
#include <fmt/format.h>
#include <pybind11/stl/filesystem.h>

namespace isostat::python
{
/// The name of an argument as part of a type.
template <std::size_t n>
struct Name
{
  char text[n];
  constexpr Name(const char (&name)[n]) { std::ranges::copy(name, text); }
};

/// An argument of a function; one of another type or shape is an InputError with its name.
template <typename T, Name name>
struct Given
{
  T value{};
  operator const T &() const { return value; }
  decltype(auto) operator*() const requires std::is_pointer_v<T> { return *value; }
};

using Threads = Given<std::uint64_t, "threads">;
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// What an argument must be, in words.
template <typename T>
std::string expected()
{
  if constexpr (std::same_as<T, Mat3>)
    return "an array of shape (3, 3)";
  else if constexpr (std::same_as<T, Eigen::Matrix<bool, 3, 3>>)
    return "an array of True and False of shape (3, 3)";
  else if constexpr (std::same_as<T, Doubles>)
    return "an array of numbers";
  else if constexpr (std::same_as<T, std::vector<double>>)
    return "an array of numbers of shape (n)";
  else if constexpr (std::same_as<T, std::string>)
    return "text";
  else if constexpr (std::same_as<T, std::filesystem::path>)
    return "a path";
  else if constexpr (std::same_as<T, bool>)
    return "True or False";
  else if constexpr (std::same_as<T, std::uint64_t>)
    return "a whole number, 0 or more";
  else if constexpr (std::integral<T>)
    return "a whole number";
  else if constexpr (std::floating_point<T>)
    return "a number";
  else if constexpr (requires { typename T::iterator; })
    return "a list, each item " + expected<typename T::value_type>();
  else if constexpr (requires { typename T::value_type; })
    return expected<typename T::value_type>() + ", or None";
  else // a class of this module
    return "an isostat." +
           py::type::of<std::remove_cv_t<std::remove_pointer_t<T>>>().attr("__name__").template cast<std::string>();
}

/// What was given instead: its shape, its value if that is short, or its type.
std::string described(py::handle value);
} // namespace isostat::python

namespace pybind11::detail
{
template <typename T, isostat::python::Name label>
struct type_caster<isostat::python::Given<T, label>>
{
  using Argument = isostat::python::Given<T, label>;
  PYBIND11_TYPE_CASTER(Argument, make_caster<T>::name);

  bool load(handle given, bool)
  {
    make_caster<T> caster;
    if (given.is_none() && std::is_pointer_v<T>)
      refuse(given);
    if (!caster.load(given, true))
      refuse(given);
    value.value = cast_op<T>(caster);
    return true;
  }

private:
  [[noreturn]] static void refuse(handle given)
  {
    PyErr_Clear();
    throw isostat::InputError(fmt::format("{}: must be {}, but is {}.", label.text, isostat::python::expected<T>(),
                                          isostat::python::described(given)));
  }
};
} // namespace pybind11::detail

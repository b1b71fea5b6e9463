// SPDX-License-Identifier: BSD-3-Clause
// NumPy arrays over memory of C++.   tested: tests/python/snapshot_test.py
#pragma once
#include "base/types.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace isostat::python
{
namespace py = pybind11;

/// A read-only array (n, columns), or (n) where columns is 0, over memory that `owner` keeps alive; nothing is copied.
/// @param stride  bytes from one row to the next
template <typename T>
py::array_t<T> view(const T *first, std::size_t n, std::size_t columns, std::size_t stride, py::handle owner)
{
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(n)}, strides{static_cast<py::ssize_t>(stride)};
  if (columns > 0)
    {
      shape.push_back(static_cast<py::ssize_t>(columns));
      strides.push_back(sizeof(T));
    }
  py::array_t<T> array(shape, strides, first, owner);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

/// (n, 3): the first three of the four numbers of each record of a packing.
template <typename Values>
py::array records(const Values &values, std::size_t n, py::handle owner)
{
  return view(values.data(), n, 3, 4 * sizeof(values[0]), owner);
}

/// One array (n) of a value computed for each of n things.
template <typename T, typename Function>
py::array_t<T> computed(std::size_t n, const Function &function)
{
  py::array_t<T> array(static_cast<py::ssize_t>(n));
  T *values = array.mutable_data();
  for (std::size_t i = 0; i < n; ++i)
    values[i] = static_cast<T>(function(i));
  return array;
}

/// Rows of (n, 3), given as any array.   @throws InputError  another shape, a number that is none
std::vector<Vec3> points(const py::array_t<double, py::array::c_style | py::array::forcecast> &array, const char *name);
} // namespace isostat::python

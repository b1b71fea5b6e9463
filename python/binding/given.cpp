// SPDX-License-Identifier: BSD-3-Clause
#include "python/binding/given.hpp"

namespace isostat::python
{
std::string described(py::handle value)
{
  if (py::hasattr(value, "shape"))
    return "an array of shape " + std::string(py::str(value.attr("shape")));
  const bool plain = value.is_none() || py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value) ||
                     py::isinstance<py::str>(value);
  const std::string text = plain ? std::string(py::repr(value)) : "";
  return plain && text.size() < 60 ? text : "of type " + std::string(py::str(py::type::of(value).attr("__name__")));
}
} // namespace isostat::python

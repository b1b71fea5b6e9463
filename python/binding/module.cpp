// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/installation.hpp"
#include "base/record/instruction_set.hpp"
#include "python/binding/binding.hpp"
#include "python/binding/given.hpp"

namespace isostat::python
{
std::vector<Vec3> points(const py::array_t<double, py::array::c_style | py::array::forcecast> &array, const char *name)
{
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw InputError(fmt::format("{}: must be an array of shape (n, 3), but is {}.", name, described(array)));
  std::vector<Vec3> found;
  for (py::ssize_t i = 0; i < array.shape(0); ++i)
    found.emplace_back(array.at(i, 0), array.at(i, 1), array.at(i, 2));
  return found;
}

bool SignalWatch::go_on()
{
  if (interrupted_ || ++calls_ % 256 != 0)
    return !interrupted_;
  const py::gil_scoped_acquire gil;
  interrupted_ = PyErr_CheckSignals() != 0;
  return !interrupted_;
}
} // namespace isostat::python

PYBIND11_MODULE(_core, module)
{
  namespace py = pybind11;
  using namespace isostat;
  module.doc() = "The compiled part of isostat; use what the package itself offers.";
  module.attr("__version__") = version();
  python::bind_errors(module);
  use_instruction_set_of_environment();
  python::bind_scene(module);
  python::bind_snapshot(module);
  python::bind_measures(module);
  python::bind_packings(module);
  python::bind_files(module);
  python::bind_run(module);
  python::bind_rve(module);
}

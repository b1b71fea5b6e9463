// SPDX-License-Identifier: BSD-3-Clause
// Errors as exceptions, with the same text except for the names of what the user gave.   tested: tests/python/run_test.py
#include "base/error.hpp"
#include "python/binding/binding.hpp"

namespace isostat::python
{
namespace
{
py::handle input_error, run_failure, warning; // live as long as the interpreter

void translate(std::exception_ptr thrown)
{
  try
    {
      if (thrown)
        std::rethrow_exception(thrown);
    }
  catch (const Interrupted &stop)
    {
      if (!PyErr_Occurred())
        PyErr_SetString(PyExc_KeyboardInterrupt, in_python(stop.what()).c_str());
    }
  catch (const InputError &error)
    {
      PyErr_SetString(input_error.ptr(), in_python(error.what()).c_str());
    }
  catch (const RunFailure &error)
    {
      PyErr_SetString(run_failure.ptr(), in_python(error.what()).c_str());
    }
}
} // namespace

void warn_of(const std::vector<std::string> &notes)
{
  for (const std::string &note : notes)
    if (PyErr_WarnEx(warning.ptr(), in_python(note).c_str(), 1) != 0)
      throw py::error_already_set();
}

void bind_errors(py::module_ &module)
{
  const auto add = [&](const char *name, PyObject *base, const char *text) {
    const py::object type = py::exception<std::exception>(module, name, base);
    type.doc() = text;
    return type.inc_ref();
  };
  input_error = add("InputError", PyExc_ValueError,
                    "A mistake in the input: says where, the value, the allowed range and the remedy.");
  run_failure = add("RunFailure", PyExc_RuntimeError,
                    "A run that cannot continue: says the step, the grain and the last good checkpoint.");
  warning = add("IsostatWarning", PyExc_UserWarning,
                "A warning of a run, a preparation or a file; that of a run follows its folder or title.");
  py::register_exception_translator(&translate);
}
} // namespace isostat::python

// SPDX-License-Identifier: BSD-3-Clause
// The parts of the module; each adds its classes and functions.
#pragma once
#include "python/binding/warnings.hpp"

#include <functional>

namespace isostat::python
{
void bind_errors(py::module_ &module);
void bind_scene(py::module_ &module);
void bind_snapshot(py::module_ &module);
void bind_measures(py::module_ &module);
void bind_packings(py::module_ &module);
void bind_files(py::module_ &module);
void bind_run(py::module_ &module);
void bind_rve(py::module_ &module);

/// Warns in Python, of a call that is no run.   @throws py::error_already_set  where warnings are errors
void warn_of(const std::vector<std::string> &notes);

/// Looks for Ctrl-C, and for other signals that the package handles, now and then during long calls in which the GIL is released.
class SignalWatch
{
public:
  /// @return false once the user has asked to stop; the KeyboardInterrupt is then pending. Cheap enough for every step.
  bool go_on();
  bool interrupted() const { return interrupted_; }
  void interrupt() { interrupted_ = true; }

private:
  unsigned calls_ = 0;
  bool interrupted_ = false;
};
} // namespace isostat::python

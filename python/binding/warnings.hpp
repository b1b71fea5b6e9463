// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/python/warnings_test.py
#pragma once
#include "base/tell.hpp"
#include "python/binding/arrays.hpp"

#include <string>

namespace isostat::python
{
/// Options of the command line in a message become keywords.
std::string in_python(std::string text);
/// From now on messages name options of a command line, and files the program `isostat`.
void speak_as_command();

/// Warnings of a call, which join a list of Python when it is over, whether it fails or not. Made and gone with the GIL.
class WarningsListed
{
public:
  explicit WarningsListed(py::list list) : list_(std::move(list)) {}
  ~WarningsListed();
  WarningsListed(const WarningsListed &) = delete;
  WarningsListed &operator=(const WarningsListed &) = delete;

private:
  WarningsTaken taken_;
  py::list list_;
};
} // namespace isostat::python

// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/dem/scene/scene_error_test.cpp (messages), tests/apps/command_line_test.py (exit codes)
#pragma once
#include <stdexcept>
#include <string>

namespace isostat
{
/// A mistake in what the user gave (scene, file, command line). The message says where (file:line if there is one),
/// the value, the allowed range with its reason, and the remedy. Applications print it and return exit code 2.
class InputError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// A run that cannot continue (not-a-number, exploding grain, energy from nothing, failed root search). The message
/// names the step, the grain and the last good checkpoint. Applications print it and return exit code 1.
class RunFailure : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/// The user or the system asked to stop. Applications return exit code 130.
class Interrupted : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};
} // namespace isostat

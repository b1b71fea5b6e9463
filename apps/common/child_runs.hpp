// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/liquefaction_resistance_test.py, tests/apps/calibrate_test.py
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace isostat
{
/// A program to run in a process of its own: it may crash without taking anything else along.
struct ChildRun
{
  std::vector<std::string> command; ///< program and arguments
  std::filesystem::path log;        ///< what it prints; replaced
};

/// What the caller hears of the children.
struct ChildEvents
{
  /// A child has ended.   @param code  its exit code, or 128 + the signal that ended it
  std::function<void(std::size_t index, int code, double seconds)> finished;
  /// Several times a second.   @param running  those at work now
  std::function<void(const std::vector<std::size_t> &running)> tick;
};

/// Runs the commands in their order, at most `jobs` at a time. When a stop is requested (apps/common/interrupt.hpp) the
/// children at work are told to end by SIGTERM and waited for, and no other is started. They are in process groups of
/// their own, so that Ctrl-C reaches them once and by this way only; if this process dies, they are told as well.
/// @return false if it was stopped
bool run_children(const std::vector<ChildRun> &runs, int jobs, const ChildEvents &events);

/// Last line of a log that says anything; empty if there is none.
std::string last_line(const std::filesystem::path &log);
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/resistance_test.py, tests/apps/calibrate_test.py
#pragma once
#include "base/stopwatch.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace isostat
{
/// A program to run in a process of its own: it may crash without taking anything else along.
struct ChildRun
{
  std::vector<std::string> command; ///< program and arguments
  std::filesystem::path log;        ///< what it prints; replaced
  /// Its results. Where they hold a checkpoint the command gets `--resume`; what a run has left that ended before its
  /// first checkpoint is removed.
  std::filesystem::path results;
};

/// A run at work. Children are in process groups of their own, so that Ctrl-C does not reach them; if the process that
/// started them dies, they are told to end by SIGTERM.
class ChildProcess
{
public:
  /// @param kept_open  a file that stays open in the child, too: a lock on it ends with the later of both processes
  /// @throws RunFailure  no process can be made
  ChildProcess(const ChildRun &run, int kept_open);

  /// Its exit code, or 128 + the signal that ended it; nothing as long as it runs.
  std::optional<int> ended() const;
  /// Asks it to end, with a checkpoint.
  void stop() const;
  double seconds() const { return watch_.seconds(); }

private:
  pid_t id_;
  Stopwatch watch_;
};

/// As execv() takes them.   @pre the words stay where they are
std::vector<char *> pointers_to(std::vector<std::string> &words);

/// Runs a program to its end, without a shell. Ctrl-C ends that program, not this one.
/// @param log  what it prints; replaced
/// @return its exit code, or 128 + the signal that ended it or, from the keyboard, after which it failed: Python ends
/// with 1 when it is interrupted as it starts
/// @throws RunFailure  it cannot be started, or the log not be written
/// tested: tests/apps/report_test.py, tests/apps/figures_interrupt_test.py
int run_program(std::vector<std::string> command, const std::filesystem::path &log);

/// Last line of a log that says anything; empty if there is none.
std::string last_line(const std::filesystem::path &log);
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace isostat
{
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

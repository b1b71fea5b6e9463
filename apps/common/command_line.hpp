// SPDX-License-Identifier: BSD-3-Clause
// What programs add to CLI11.   tested: tests/apps/command_line_test.py
#pragma once
#include <CLI/CLI.hpp>

namespace isostat
{
/// Parses, then runs the program as guarded() does; a wrong command line is bad input, too.
/// @return exit code; 0 without running the program after --help
int run_command(CLI::App &line, int argc, char **argv, const std::function<void()> &program);

/// Runs a program and turns what it throws into one message on stderr and an exit code: 0 done, 1 failed, 2 bad input,
/// 130 interrupted.
int guarded(const std::function<void()> &program);

/// The command, for the provenance: what a shell takes as it was typed; words with anything but letters, digits and
/// %+,-./:=@_ in quotes.
std::string command_text(int argc, char **argv);

/// The file itself, or the one of this name in a folder of the installation (base/record/installation.hpp).
std::string shipped_file(const std::filesystem::path &folder, const std::string &file);
/// Of scenes: for transform().
std::string shipped_scene(const std::string &file);
} // namespace isostat

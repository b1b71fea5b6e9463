// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>

namespace isostat
{
/// Version and revision of the build, "0.1.0 (1a2b3c4)"; "-dirty" after it if files were changed. Found at build time.
std::string version();

/// The folder with figures and scenes that belongs to the running program: ../share/isostat next to the folder the
/// program is in; of a module of Python share/isostat in the nearest folder above it that has one. A build tree
/// has links there, so that no path of the source is compiled in.
/// Tested: tests/apps/micromechanics_test.py, which lets a program draw.
std::filesystem::path shared_folder();

/// What is wrong and what to do if `name` is not in shared_folder(), as of a program that was copied to another place;
/// empty if it is there. Tested: tests/apps/command_line_test.py
std::string missing_from_shared_folder(const std::string &name);
} // namespace isostat

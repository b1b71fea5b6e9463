// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>

namespace isostat
{
/// Version and revision of the build, "0.1.0 (1a2b3c4)"; "-dirty" after it if files were changed. Found at build time.
std::string version();

/// The folder with figures and scenes that belongs to the running program: ../share/isostat beside the folder the
/// program is in. A build tree has links there, so that no path of the source is compiled in.
/// Tested: tests/apps/micromechanics_test.py, which lets a program draw.
std::filesystem::path shared_folder();
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <string>

namespace isostat
{
/// Version and revision of the build, "0.1.0 (1a2b3c4)"; "-dirty" after it if files were changed. Found at build time.
std::string version();

/// The folder with figures and scenes that belongs to the running program: ../share/isostat beside the folder the
/// program is in. An installation has it, and a build tree has links there, so that no path is compiled in.
/// Tested: tests/examples/installed_test.py.
std::filesystem::path shared_folder();

/// A scene as the user names it: the path itself or, if there is none, the scene of that name that came with the
/// program ("quick_cyclic_liquefies.toml", "column/uniform_layer.toml"). A path that is neither is returned as it is.
std::string find_scene(const std::string &path);
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/base/files/replace_file_test.cpp
#pragma once
#include "base/error.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace isostat
{
/// The system refuses something to a file or folder.
/// @param what    "written", "renamed": what cannot be done to it   @param reason  in the words of the system
/// @throws RunFailure  always
[[noreturn]] inline void fail(const std::filesystem::path &path, const char *what, const std::string &reason)
{
  throw RunFailure(
      fmt::format("{}: cannot be {}: {}; check free space and permissions of the folder", path.string(), what, reason));
}
} // namespace isostat

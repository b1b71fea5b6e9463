// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/apps/kill_resume_test.py
#pragma once
#include <filesystem>
#include <string>

namespace isostat
{
/// Brings `aside` to the disk (fsync) and gives it the name `path` in one step: whoever reads `path` sees the old
/// content or the new, never a part. `aside` must lie in the same folder. Throws RunFailure.
void replace_file(const std::filesystem::path &aside, const std::filesystem::path &path);

/// Writes `text` to `path`.tmp, then replaces `path`. Throws RunFailure and leaves `path` as it was if that fails.
void write_replacing(const std::filesystem::path &path, const std::string &text);
} // namespace isostat

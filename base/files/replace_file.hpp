// SPDX-License-Identifier: BSD-3-Clause
// Files and folders, made or refused with the reason.
// tested: tests/base/files/replace_file_test.cpp, tests/apps/kill_resume_test.py, tests/apps/failures_test.py
#pragma once
#include <chrono>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace isostat
{
/// Writes `text` to a new file next to `path`, brings it to the disk (fsync) and gives it the name `path` in one step:
/// a reader of `path` sees the old content or the new, never a part; the name is on the disk, too, when it returns.
/// Any number of threads and processes may write the same `path` at once: the last one stays. Throws RunFailure if it
/// fails: `path` is whole then, the old content or the new, and the file next to it gone.
void write_replacing(const std::filesystem::path &path, std::string_view text);

/// The same for what is too long to hold in memory.
/// @param write  writes it, piece by piece; what it throws is passed on, and the old content stays
void write_replacing(const std::filesystem::path &path, const std::function<void(std::ostream &)> &write);

/// Removes from a folder what writers that were killed have left next to their files.
/// @param age  younger ones are left alone, which another writer may just have made; 0 s where there can be no other
void remove_leftovers(const std::filesystem::path &folder, std::chrono::seconds age = std::chrono::minutes(1));

/// Gives a file another name of the same folder, in one step.   @throws RunFailure  it cannot be done
void rename_file(const std::filesystem::path &from, const std::filesystem::path &to);

/// Brings what was added to a file to the disk.   @throws RunFailure  it cannot be done
void sync_to_disk(const std::filesystem::path &path);

/// Makes a folder with those above it.   @throws RunFailure  it cannot be made
void make_folder(const std::filesystem::path &folder);
} // namespace isostat

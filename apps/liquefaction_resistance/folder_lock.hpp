// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>

namespace isostat
{
/// Keeps a second program out of a folder while this one works in it. Goes with the process, however it ends.
class FolderLock
{
public:
  FolderLock() = default;
  FolderLock(const FolderLock &) = delete;
  FolderLock &operator=(const FolderLock &) = delete;
  ~FolderLock();

  /// @throws InputError  another program has it
  void take(const std::filesystem::path &folder);

private:
  int file_ = -1;
};
} // namespace isostat

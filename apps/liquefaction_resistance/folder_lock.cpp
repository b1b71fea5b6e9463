// SPDX-License-Identifier: BSD-3-Clause
#include "apps/liquefaction_resistance/folder_lock.hpp"

#include "base/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

namespace isostat
{
FolderLock::~FolderLock()
{
  if (file_ >= 0)
    close(file_);
}

void FolderLock::take(const std::filesystem::path &folder)
{
  file_ = open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (file_ < 0 || flock(file_, LOCK_EX | LOCK_NB) != 0)
    throw InputError(fmt::format("{}: another liquefaction_resistance is at work in it. Wait for it, or give another "
                                 "--output.",
                                 folder.string()));
}
} // namespace isostat

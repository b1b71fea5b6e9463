// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/file_lock.hpp"

#include "base/files/file_failure.hpp"

#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <thread>
#include <unistd.h>

namespace isostat
{
FileLock::~FileLock()
{
  if (file_ >= 0)
    close(file_);
}

FileLock FileLock::attempt(const std::filesystem::path &file)
{
  FileLock lock(open(file.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW | O_CREAT, 0644));
  if (!lock)
    fail(file, "opened for writing", std::strerror(errno));
  if (flock(lock.file_, LOCK_EX | LOCK_NB) == 0)
    return lock;
  if (errno != EWOULDBLOCK)
    throw NoLocks(fmt::format("{}: cannot be locked: {}. Work on a file system that has locks (flock).", file.string(),
                              std::strerror(errno)));
  return {};
}

bool within_patience(const std::function<bool()> &condition)
{
  constexpr int patience = 50; // times a tenth of a second
  bool met = condition();
  for (int k = 0; k < patience && !met; ++k, met = condition())
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  return met;
}
} // namespace isostat

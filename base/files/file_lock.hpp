// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/base/files/file_lock_test.cpp
#pragma once
#include "base/error.hpp"

#include <filesystem>
#include <functional>
#include <utility>

namespace isostat
{
/// The file system of a file knows no locks.
class NoLocks : public RunFailure
{
public:
  using RunFailure::RunFailure;
};

/// A lock on a file (flock): one holder among the processes and threads of all machines that see the file. It ends with
/// this object, or with the last process that has the file open, however that ends.
class FileLock
{
public:
  FileLock() = default;
  FileLock(FileLock &&other) noexcept : file_(std::exchange(other.file_, -1)) {}
  FileLock &operator=(FileLock &&other) noexcept
  {
    std::swap(file_, other.file_);
    return *this;
  }
  ~FileLock();

  /// The lock, or none if another holder has it; a file that does not exist is made. Children that become another
  /// program do not inherit it.   @throws RunFailure  the file cannot be opened for writing, or made
  /// @throws NoLocks  the file system has no locks
  static FileLock attempt(const std::filesystem::path &file);

  explicit operator bool() const { return file_ >= 0; }

private:
  explicit FileLock(int file) : file_(file) {}
  int file_ = -1;
};

/// Whether the condition is met within five seconds: what dying processes still hold becomes free.
bool within_patience(const std::function<bool()> &condition);
} // namespace isostat

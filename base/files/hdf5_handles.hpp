// SPDX-License-Identifier: BSD-3-Clause
// What the sources of base/files/hdf5.hpp share; no other file includes it.
#pragma once
#include "base/files/hdf5.hpp"

#include <hdf5.h>
#include <mutex>
#include <utility>

namespace isostat::hdf5
{
/// Held by every function that calls HDF5: Debian's build of it serves one thread at a time. What a thread may do in
/// between is as if others had their turn; files that both use are no matter of it.
/// tested: tests/base/files/hdf5_threads_test.cpp, tests/python/threads_test.py
class Turn
{
public:
  Turn() : lock_(mutex()) {}

private:
  /// One for the process, not for each module that holds this library, as those of Python do: the compiler makes such a
  /// variable of an inline function unique (STB_GNU_UNIQUE). Never destroyed: threads may outlive the end of main().
  static std::recursive_mutex &mutex()
  {
    static auto *const one = new std::recursive_mutex;
    return *one;
  }
  std::lock_guard<std::recursive_mutex> lock_;
};

/// An open file. HDF5 1.10 cannot close a file whose last bytes it could not write, and crashes on it later. So it
/// writes to memory alone, and File::commit() brings the bytes to the disk: a disk that fails is no matter of HDF5's.
/// tested: tests/base/files/hdf5_test.cpp, tests/apps/failures_test.py
struct FileState
{
  std::filesystem::path path;
  bool writing = false, grows = false; ///< the latter: rows are added, in any portions
  hid_t id = -1;

  FileState(std::filesystem::path path, bool writing) : path(std::move(path)), writing(writing) {}
  FileState(const FileState &) = delete;
  FileState &operator=(const FileState &) = delete;
  ~FileState() { close(); }
  void close()
  {
    const Turn turn;
    if (id >= 0)
      H5Fclose(id);
    id = -1;
  }
};

/// What went wrong, with the reason of the library.
/// @throws RunFailure  the file is being written    @throws InputError  it is being read
[[noreturn]] void fail(const FileState &file, const std::string &item, const std::string &what);

/// Owner of one HDF5 identifier.
class Handle
{
public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle &&other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle &operator=(Handle &&) = delete;
  ~Handle()
  {
    if (id_ >= 0)
      close_(id_);
  }
  operator hid_t() const { return id_; }

private:
  hid_t id_;
  Close close_;
};

/// @throws as fail() if `id` is negative
inline Handle checked(hid_t id, Handle::Close close, const FileState &file, const std::string &item, const char *what)
{
  if (id < 0)
    fail(file, item, what);
  return {id, close};
}

/// Yes or no of a function that has a negative number for "I cannot say", as when memory runs out.
/// @throws as fail() then
inline bool answer(const FileState &file, const std::string &item, herr_t said)
{
  if (said < 0)
    fail(file, item, "it cannot be inspected");
  return said > 0;
}
} // namespace isostat::hdf5

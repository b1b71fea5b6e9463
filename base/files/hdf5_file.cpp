// SPDX-License-Identifier: BSD-3-Clause
// Files as a whole: opened, written aside, committed or abandoned.
#include "base/files/hdf5_handles.hpp"

#include "base/error.hpp"
#include "base/files/replace_file.hpp"

#include <cassert>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace isostat::hdf5
{
namespace fs = std::filesystem;

namespace
{
/// HDF5 prints its error stack by default; here it becomes part of the exception. Its clean-up at exit is not needed:
/// files are closed here.
void silence()
{
  [[maybe_unused]] static const bool once = [] {
    H5dont_atexit();
    return H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  }();
}

/// The innermost entry of HDF5's error stack: the reason, not its echoes.
std::string library_reason()
{
  std::string reason;
  const auto first = [](unsigned n, const H5E_error2_t *error, void *out) -> herr_t {
    if (n == 0 && error->desc)
      *static_cast<std::string *>(out) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first, &reason);
  H5Eclear2(H5E_DEFAULT);
  return reason.empty() ? reason : fmt::format(" (HDF5: {})", reason);
}

/// Opens the bytes at `where` in the name of `state.path`.
void open_existing(FileState &state, const fs::path &where, unsigned mode)
{
  state.id = H5Fopen(where.c_str(), mode, H5P_DEFAULT);
  if (state.id < 0)
    throw InputError(fmt::format("{}: damaged or truncated HDF5 file{}; write or copy it again, or delete it if it is "
                                 "a cache",
                                 state.path.string(), library_reason()));
}

void require_hdf5(const fs::path &path)
{
  silence();
  std::error_code error;
  const std::string name = path.string();
  if (!fs::exists(path, error))
    throw InputError(fmt::format("{}: there is no such file; check the path (relative to {})", name,
                                 fs::current_path(error).string()));
  if (!fs::is_regular_file(path, error))
    throw InputError(fmt::format("{}: not a file; give the name of an HDF5 file (.h5)", name));
  if (::access(path.c_str(), R_OK) != 0)
    throw InputError(fmt::format("{}: {}; change its permissions", name, std::strerror(errno)));
  if (H5Fis_hdf5(path.c_str()) <= 0)
    throw InputError(
        fmt::format("{}: not an HDF5 file (its signature is missing); give a file that Isostat wrote (.h5)", name));
}
} // namespace

void fail(const FileState &file, const std::string &item, const std::string &what)
{
  if (file.writing())
    throw RunFailure(fmt::format("{}: cannot write {}: {}{}; check free space and permissions of the folder",
                                 file.path.string(), item, what, library_reason()));
  throw InputError(
      fmt::format("{}: cannot read {}: {}{}; is this the right kind of file, and complete? Write it again.",
                  file.path.string(), item, what, library_reason()));
}

void FileState::close()
{
  if (id >= 0)
    H5Fclose(id);
  id = -1;
}

int FileState::descriptor() const
{
  void *found = nullptr;
  return H5Fget_vfd_handle(id, H5P_DEFAULT, &found) < 0 ? -1 : *static_cast<int *>(found);
}

int FileState::reserve() const
{
  hsize_t bytes = 0;
  return H5Fget_filesize(id, &bytes) < 0 ? 0 : ::posix_fallocate(descriptor(), 0, static_cast<off_t>(bytes));
}

void FileState::abandon()
{
  if (writing() && id >= 0) // what HDF5 still writes goes to memory
    {
      const int memory = ::memfd_create("abandoned", 0);
      ::dup2(memory, descriptor());
      ::close(memory);
    }
  close();
  std::error_code ignored;
  if (writing())
    fs::remove(aside, ignored);
  aside.clear();
}

File File::open(const fs::path &path)
{
  require_hdf5(path);
  auto state = std::make_shared<FileState>();
  state->path = path;
  open_existing(*state, path, H5F_ACC_RDONLY);
  return File(state);
}

File File::create(const fs::path &path)
{
  silence();
  auto state = std::make_shared<FileState>();
  state->path = path;
  const fs::path aside = path.string() + ".tmp";
  state->aside = aside;
  state->id = H5Fcreate(aside.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (state->id < 0)
    throw RunFailure(fmt::format("{}: cannot create the file{}; the folder must exist, be writable and have free space",
                                 path.string(), library_reason()));
  return File(state);
}

File File::update(const fs::path &path)
{
  require_hdf5(path);
  auto state = std::make_shared<FileState>();
  state->path = path;
  state->aside = path.string() + ".tmp";
  std::error_code error;
  fs::copy_file(path, state->aside, fs::copy_options::overwrite_existing, error);
  if (error)
    fail(*state, "a copy of it", error.message());
  open_existing(*state, state->aside, H5F_ACC_RDWR);
  return File(state);
}

File &File::operator=(File &&other) noexcept
{
  if (this != &other && state_)
    state_->abandon();
  state_ = std::move(other.state_);
  return *this;
}

File::~File()
{
  if (state_)
    state_->abandon();
}

void File::commit()
{
  FileState &file = *state_;
  assert(file.writing() && file.id >= 0);
  if (const int code = file.reserve())
    fail(file, "the file", std::strerror(code));
  if (H5Fflush(file.id, H5F_SCOPE_GLOBAL) < 0)
    fail(file, "the file", "flushing failed");
  if (H5Fclose(file.id) < 0)
    fail(file, "the file", "closing failed");
  file.id = -1;
  replace_file(file.aside, file.path);
  file.aside.clear();
}
} // namespace isostat::hdf5

// SPDX-License-Identifier: BSD-3-Clause
// Files as a whole: opened, written in memory, committed.
#include "base/files/hdf5_handles.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/files/replace_file.hpp"
#include "base/files/seal.hpp"

#include <cassert>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>

namespace isostat::hdf5
{
namespace fs = std::filesystem;

namespace
{
/// HDF5 prints its error stack by default; here it becomes part of the exception. Its clean-up at exit is not needed:
/// files are closed here. Nor are its locks: files are replaced whole, and it takes a file system without locks for a
/// damaged file.
void silence()
{
  [[maybe_unused]] static const bool once = [] {
    setenv("HDF5_USE_FILE_LOCKING", "FALSE", true);
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

/// Opens the bytes in the name of `state.path`.
void open_existing(FileState &state, const std::string &name, unsigned mode, hid_t access)
{
  state.id = H5Fopen(name.c_str(), mode, access);
  if (state.id < 0)
    throw InputError(fmt::format("{}: damaged or truncated HDF5 file{}; write or copy it again, or delete it if it is "
                                 "a cache",
                                 state.path.string(), library_reason()));
}

/// A name that no other file in memory has, of this or of another module that holds this library, by which HDF5
/// distinguishes them.
std::string name_in_memory()
{
  static unsigned long n = 0;
  return fmt::format("memory-{}-{}", fmt::ptr(&n), n++);
}

/// To write to memory, in pieces of a megabyte; nothing is set aside for later, which would stay in the file.
Handle memory_access(const FileState &file)
{
  Handle access = checked(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, file, "the file", "no memory");
  if (H5Pset_fapl_core(access, 1 << 20, false) < 0 || H5Pset_meta_block_size(access, 0) < 0 ||
      H5Pset_small_data_block_size(access, 0) < 0)
    fail(file, "the file", "no access to memory");
  return access;
}

/// All bytes of a file that is open in memory.
std::string bytes_of(const FileState &file)
{
  if (H5Fflush(file.id, H5F_SCOPE_GLOBAL) < 0)
    fail(file, "the file", "flushing failed");
  const ssize_t size = H5Fget_file_image(file.id, nullptr, 0);
  std::string bytes(size < 0 ? 0 : static_cast<std::size_t>(size), 0);
  if (size < 0 || H5Fget_file_image(file.id, bytes.data(), bytes.size()) != size)
    fail(file, "the file", "its bytes cannot be had");
  return bytes;
}

/// An empty file in memory.
void create_in_memory(FileState &state)
{
  state.id = H5Fcreate(name_in_memory().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, memory_access(state));
  if (state.id < 0)
    fail(state, "the file", "it cannot be made in memory");
}

/// Callback of H5Aiterate2: adds the attribute to the object that `to` points to.
herr_t copy_attribute(hid_t owner, const char *name, const H5A_info_t *, void *to)
{
  const Handle from(H5Aopen(owner, name, H5P_DEFAULT), H5Aclose), type(H5Aget_type(from), H5Tclose),
      space(H5Aget_space(from), H5Sclose);
  const Handle copy(H5Acreate2(*static_cast<hid_t *>(to), name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  std::vector<std::byte> value(H5Aget_storage_size(from) + H5Tget_size(type));
  const bool done = H5Aread(from, type, value.data()) >= 0 && H5Awrite(copy, type, value.data()) >= 0;
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, value.data());
  return done ? 0 : -1;
}

/// Callback of H5Literate: copies the object to the file that `to` points to. Links that lead elsewhere are of others.
herr_t copy_object(hid_t from, const char *name, const H5L_info_t *link, void *to)
{
  if (link->type != H5L_TYPE_HARD)
    return 0;
  return H5Ocopy(from, name, *static_cast<hid_t *>(to), name, H5P_DEFAULT, H5P_DEFAULT);
}

/// What is in a file, in the order of names and rows: the bytes do not show in which portions rows were added, and have
/// no gaps where some were cut off.
void bring_in_order(FileState &file)
{
  FileState ordered(file.path, true);
  create_in_memory(ordered);
  hsize_t first = 0;
  if (H5Literate(file.id, H5_INDEX_NAME, H5_ITER_INC, nullptr, copy_object, &ordered.id) < 0 ||
      H5Aiterate2(file.id, H5_INDEX_NAME, H5_ITER_INC, &first, copy_attribute, &ordered.id) < 0)
    fail(file, "the file", "its content cannot be copied");
  std::swap(file.id, ordered.id);
}

void require_hdf5(const fs::path &path)
{
  const Turn turn;
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
  if (file.writing)
    throw RunFailure(fmt::format("{}: cannot write {}: {}{}; check free space and permissions of the folder",
                                 file.path.string(), item, what, library_reason()));
  throw InputError(
      fmt::format("{}: cannot read {}: {}{}; is this the right kind of file, and complete? Write it again.",
                  file.path.string(), item, what, library_reason()));
}

File File::open(const fs::path &path)
{
  require_hdf5(path);
  check_seal(path);
  const Turn turn;
  auto state = std::make_shared<FileState>(path, false);
  open_existing(*state, path, H5F_ACC_RDONLY, H5P_DEFAULT);
  return File(state);
}

File File::create(const fs::path &path)
{
  const Turn turn;
  silence();
  const fs::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw RunFailure(fmt::format("{}: cannot create the file: {}; the folder must exist, be writable and have free "
                                 "space",
                                 path.string(), std::strerror(errno)));
  auto state = std::make_shared<FileState>(path, true);
  create_in_memory(*state);
  return File(state);
}

File File::update(const fs::path &path)
{
  require_hdf5(path);
  auto state = std::make_shared<FileState>(path, true);
  std::string bytes(unsealed(read_text(path), path));
  const Turn turn;
  const Handle access = memory_access(*state);
  if (H5Pset_file_image(access, bytes.data(), bytes.size()) < 0)
    fail(*state, "a copy of it", "no memory");
  open_existing(*state, name_in_memory(), H5F_ACC_RDWR, access);
  return File(state);
}

void File::commit()
{
  FileState &file = *state_;
  assert(file.writing && file.id >= 0);
  std::string bytes;
  {
    const Turn turn;
    if (file.grows)
      bring_in_order(file);
    bytes = bytes_of(file);
    file.close();
  }
  write_replacing(file.path, sealed(bytes));
}
} // namespace isostat::hdf5

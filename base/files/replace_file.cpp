// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/replace_file.hpp"

#include "base/files/file_failure.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <unistd.h>

namespace isostat
{
namespace fs = std::filesystem;

namespace
{
/// @return errno; 0 if a file, or the names in a folder, are on the disk
int synced(const fs::path &path)
{
  const int descriptor = ::open(path.c_str(), O_RDONLY);
  if (descriptor < 0)
    return errno;
  int code = 0;
  while ((code = ::fsync(descriptor) == 0 ? 0 : errno) == EINTR)
    ;
  ::close(descriptor);
  return code;
}

/// That a file has its new name outlives a loss of power. Some file systems cannot say so of a folder, and one that may
/// be written need not be readable.
int name_synced(const fs::path &path)
{
  const int code = synced(path.has_parent_path() ? path.parent_path() : ".");
  return code == EINVAL || code == ENOTSUP || code == EACCES ? 0 : code;
}

/// A file, or a link to one: a folder or a device is not replaced.
void expect_replaceable(const fs::path &path)
{
  std::error_code ignored;
  const fs::file_type type = fs::symlink_status(path, ignored).type();
  if (type != fs::file_type::regular && type != fs::file_type::symlink && type != fs::file_type::not_found &&
      type != fs::file_type::none)
    throw InputError(fmt::format("{}: is a folder, a pipe or a device, which is not replaced. Give another path, or "
                                 "move it away.",
                                 path.string()));
}

/// @return errno; 0 if all of it is on the disk
int bring_to_disk(const fs::path &path, const std::function<void(std::ostream &)> &write)
{
  errno = 0;
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  write(out);
  out.close();
  if (!out)
    return errno ? errno : EIO;
  return synced(path);
}
} // namespace

void write_replacing(const fs::path &path, const std::function<void(std::ostream &)> &write)
{
  const fs::path aside = path.string() + ".tmp";
  std::error_code ignored;
  int code = 0;
  expect_replaceable(path);
  fs::remove(aside, ignored); // a link there would lead to a file of somebody, a pipe would wait for a reader
  try
    {
      code = bring_to_disk(aside, write);
    }
  catch (...)
    {
      fs::remove(aside, ignored);
      throw;
    }
  if (code == 0 && ::rename(aside.c_str(), path.c_str()) != 0)
    code = errno;
  if (code == 0)
    code = name_synced(path);
  if (code == 0)
    return;
  fs::remove(aside, ignored);
  fail(path, "written", std::strerror(code));
}

void write_replacing(const fs::path &path, std::string_view text)
{
  write_replacing(path, [&](std::ostream &out) { out.write(text.data(), static_cast<std::streamsize>(text.size())); });
}

void rename_file(const fs::path &from, const fs::path &to)
{
  std::error_code error;
  fs::rename(from, to, error);
  if (error)
    fail(from, "renamed", error.message());
  if (const int code = name_synced(to); code != 0)
    fail(to, "brought to the disk", std::strerror(code));
}

void sync_to_disk(const fs::path &path)
{
  if (const int code = synced(path); code != 0)
    fail(path, "brought to the disk", std::strerror(code));
}

void make_folder(const fs::path &folder)
{
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    fail(folder, "made", error.message());
}
} // namespace isostat

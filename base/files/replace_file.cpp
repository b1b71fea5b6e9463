// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/replace_file.hpp"

#include "base/files/file_failure.hpp"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <regex>
#include <sys/file.h>
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

/// A new file next to `path`, `path`.PROCESS-NUMBER.tmp, which no other writer has, in this process, in another, or on
/// another machine that sees the folder. It is locked as long as it is written, and gone after that unless it has
/// become `path`.
class FileAside
{
public:
  explicit FileAside(const fs::path &path)
  {
    static std::atomic<unsigned> number{0};
    do
      {
        path_ = fmt::format("{}.{}-{}.tmp", path.string(), ::getpid(), number++);
        file_ = ::open(path_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
      }
    while (file_ < 0 && errno == EEXIST);
    if (file_ < 0)
      code_ = errno;
    else
      ::flock(file_, LOCK_EX | LOCK_NB); // remove_leftovers() lets it be; without locks it goes by age
  }
  ~FileAside()
  {
    std::error_code ignored;
    if (file_ < 0)
      return;
    if (!renamed_)
      fs::remove(path_, ignored);
    ::close(file_);
  }
  FileAside(const FileAside &) = delete;
  FileAside &operator=(const FileAside &) = delete;

  /// Writes it, brings it to the disk and gives it the name `path`.   @return errno; 0 if all of that is done
  int become(const fs::path &path, const std::function<void(std::ostream &)> &write)
  {
    if (code_ != 0)
      return code_;
    errno = 0;
    std::ofstream out(path_, std::ios::binary);
    write(out);
    out.close();
    if (!out)
      return errno ? errno : EIO;
    if (const int code = synced(path_); code != 0)
      return code;
    if (::rename(path_.c_str(), path.c_str()) != 0)
      return errno;
    renamed_ = true;
    return name_synced(path);
  }

private:
  fs::path path_;
  int file_ = -1, code_ = 0;
  bool renamed_ = false;
};

/// Whether a name is one of FileAside.
bool is_aside(const std::string &name)
{
  static const std::regex form(R"(.+\.[0-9]+-[0-9]+\.tmp)");
  return std::regex_match(name, form);
}
} // namespace

void remove_leftovers(const fs::path &folder, std::chrono::seconds least_age)
{
  std::error_code ignored;
  for (const fs::directory_entry &entry : fs::directory_iterator(folder, ignored))
    {
      if (!is_aside(entry.path().filename().string()) || !fs::is_regular_file(entry.symlink_status(ignored)))
        continue;
      const int file = ::open(entry.path().c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
      const bool is_written = file >= 0 && ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
      const auto age = fs::file_time_type::clock::now() - entry.last_write_time(ignored);
      if (file >= 0 && !is_written && age >= least_age)
        fs::remove(entry.path(), ignored);
      if (file >= 0)
        ::close(file);
    }
}

void write_replacing(const fs::path &path, const std::function<void(std::ostream &)> &write)
{
  expect_replaceable(path);
  if (const int code = FileAside(path).become(path, write); code != 0)
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

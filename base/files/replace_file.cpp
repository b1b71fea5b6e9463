// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/replace_file.hpp"

#include "base/error.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

namespace isostat
{
namespace
{
[[noreturn]] void fail(const std::filesystem::path &path, const std::string &reason)
{
  throw RunFailure(
      fmt::format("{}: cannot be written: {}; check free space and permissions of the folder", path.string(), reason));
}
} // namespace

void replace_file(const std::filesystem::path &aside, const std::filesystem::path &path)
{
  const int descriptor = ::open(aside.c_str(), O_RDONLY);
  const bool on_disk = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int code = errno;
  if (descriptor >= 0)
    ::close(descriptor);
  if (!on_disk)
    fail(path, std::strerror(code));
  std::error_code error;
  std::filesystem::rename(aside, path, error);
  if (error)
    fail(path, error.message());
}

void write_replacing(const std::filesystem::path &path, const std::string &text)
{
  const std::filesystem::path aside = path.string() + ".tmp";
  errno = 0;
  std::ofstream out(aside, std::ios::binary | std::ios::trunc);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  out.close();
  if (!out)
    {
      const std::string reason = std::strerror(errno);
      std::error_code ignored;
      std::filesystem::remove(aside, ignored);
      fail(path, reason);
    }
  replace_file(aside, path);
}
} // namespace isostat

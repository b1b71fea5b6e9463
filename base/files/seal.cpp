// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/seal.hpp"

#include "base/error.hpp"
#include "base/files/hash.hpp"

#include <array>
#include <chrono>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <mutex>
#include <sys/stat.h>
#include <vector>

namespace isostat
{
namespace
{
constexpr std::string_view mark = "isostat-sealed 1";

struct Seal
{
  std::array<char, mark.size()> known_by;
  std::uint64_t n_bytes, check_sum;

  bool is_one() const { return std::string_view(known_by.data(), mark.size()) == mark; }
};

std::uint64_t check_sum(std::string_view bytes) { return Hash().words(std::as_bytes(std::span(bytes))).value(); }

void compare(const Seal &found, std::uint64_t n_bytes, std::uint64_t sum, const std::filesystem::path &path)
{
  if (found.n_bytes != n_bytes || found.check_sum != sum)
    throw InputError(fmt::format("{}: damaged: its {} bytes are not the {} that were written (check sum {:016x}, "
                                 "expected {:016x}); write or copy it again, or delete it if it is a cache",
                                 path.string(), n_bytes, found.n_bytes, sum, found.check_sum));
}

// Reads a file in blocks, so that one of gigabytes takes no memory.
void check_blocks(const std::filesystem::path &path, std::uint64_t size)
{
  Seal found{};
  if (size < sizeof found)
    return;
  std::ifstream in(path, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(size - sizeof found));
  in.read(reinterpret_cast<char *>(&found), sizeof found);
  if (in && !found.is_one())
    return;
  in.seekg(0);
  Hash hash;
  std::vector<std::byte> block(1 << 20); // whole words: the sum of blocks is that of all
  const std::uint64_t n_bytes = size - sizeof found;
  for (std::uint64_t at = 0, n = 0; at < n_bytes && in; at += n)
    {
      n = std::min<std::uint64_t>(block.size(), n_bytes - at);
      in.read(reinterpret_cast<char *>(block.data()), static_cast<std::streamsize>(n));
      hash.words(std::span<const std::byte>(block.data(), n));
    }
  if (!in)
    throw InputError(fmt::format("{}: cannot be read to its end; copy it again", path.string()));
  compare(found, n_bytes, hash.value(), path);
}
} // namespace

std::string sealed(std::string bytes)
{
  Seal seal{{}, bytes.size(), check_sum(bytes)};
  mark.copy(seal.known_by.data(), mark.size());
  return bytes.append(reinterpret_cast<const char *>(&seal), sizeof seal);
}

std::string_view unsealed(std::string_view bytes, const std::filesystem::path &path)
{
  Seal found{};
  if (bytes.size() < sizeof found)
    return bytes;
  std::memcpy(&found, bytes.data() + bytes.size() - sizeof found, sizeof found);
  if (!found.is_one())
    return bytes;
  bytes.remove_suffix(sizeof found);
  compare(found, bytes.size(), check_sum(bytes), path);
  return bytes;
}

void check_seal(const std::filesystem::path &path)
{
  using Identity = std::pair<dev_t, ino_t>;
  using Version = std::array<std::int64_t, 3>;
  static std::map<Identity, Version> whole;
  static std::mutex mutex;
  struct stat state
  {};
  if (::stat(path.c_str(), &state) != 0)
    throw InputError(fmt::format("{}: cannot be read; check path and permissions", path.string()));
  const Identity identity(state.st_dev, state.st_ino);
  const Version version{state.st_size, state.st_ctim.tv_sec, state.st_ctim.tv_nsec};
  const std::lock_guard lock(mutex);
  if (const auto known = whole.find(identity); known != whole.end() && known->second == version)
    return;
  check_blocks(path, static_cast<std::uint64_t>(state.st_size));
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  if (now - std::chrono::seconds(state.st_ctim.tv_sec) > std::chrono::seconds(2))
    whole[identity] = version; // of a younger file, another change could bear the same time
}
} // namespace isostat

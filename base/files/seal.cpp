// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/seal.hpp"

#include "base/error.hpp"
#include "base/files/hash.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <sys/stat.h>
#include <vector>

namespace isostat
{
namespace
{
constexpr std::string_view mark = "isostat-sealed 1";
constexpr std::size_t n_head = 52; ///< bytes in which an HDF5 file has named its end

struct Seal
{
  std::array<char, mark.size()> known_by;
  std::uint64_t n_bytes, check_sum;

  bool is_one() const { return std::string_view(known_by.data(), mark.size()) == mark; }
};

std::uint64_t check_sum(std::string_view bytes) { return Hash().words(std::as_bytes(std::span(bytes))).value(); }

/// The end that the head of an HDF5 file names (HDF5 File Format Specification, II.A), as far as the file begins with
/// it and lengths have 8 bytes; otherwise 0.
std::uint64_t end_of_hdf5(std::string_view head)
{
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  if (!head.starts_with(signature) || head.size() < n_head)
    return 0;
  const auto version = static_cast<unsigned char>(head[8]);
  const std::size_t of_sizes = version < 2 ? 13 : 9, at = version == 0 ? 40 : version == 1 ? 44 : 28;
  if (version > 3 || head[of_sizes] != 8)
    return 0;
  std::uint64_t end = 0;
  std::memcpy(&end, head.data() + at, sizeof end);
  return end;
}

/// Some bytes of a file, or as many as there are.
using Read = std::function<std::string(std::uint64_t from, std::size_t n)>;

/// @throws InputError  an HDF5 file has lost its seal: the file is shorter than its content, or what follows is not
/// longer than a seal, or begins with one. Older files end with zeros, more of them.
std::optional<Seal> seal_of(std::uint64_t n_bytes, const Read &read, const std::filesystem::path &path)
{
  Seal seal{};
  if (n_bytes >= sizeof seal)
    std::memcpy(&seal, read(n_bytes - sizeof seal, sizeof seal).data(), sizeof seal);
  if (seal.is_one())
    return seal;
  const std::uint64_t end = end_of_hdf5(read(0, n_head));
  const bool lost = n_bytes < end || n_bytes - end <= sizeof seal || read(end, mark.size()) == mark;
  if (end != 0 && end != n_bytes && lost)
    throw InputError(fmt::format("{}: {}: it has {} bytes, but its content ends after {} and its check sum is lost; "
                                 "write or copy it again, or delete it if it is a cache",
                                 path.string(), n_bytes < end ? "truncated" : "damaged", n_bytes, end));
  return {};
}

/// @param n_bytes, sum  of the content
void compare(const Seal &seal, std::uint64_t n_bytes, std::uint64_t sum, const std::filesystem::path &path)
{
  if (seal.n_bytes != n_bytes || seal.check_sum != sum)
    throw InputError(fmt::format("{}: damaged: its content has {} bytes with the check sum {:016x}, but {} bytes with "
                                 "{:016x} were written; write or copy it again, or delete it if it is a cache",
                                 path.string(), n_bytes, sum, seal.n_bytes, seal.check_sum));
}

// Reads a file in blocks, so that one of gigabytes takes no memory.
void check_blocks(const std::filesystem::path &path, std::uint64_t size)
{
  std::ifstream in(path, std::ios::binary);
  const std::optional<Seal> seal = seal_of(
      size,
      [&](std::uint64_t from, std::size_t n) {
        std::string bytes(from < size ? std::min<std::uint64_t>(n, size - from) : 0, 0);
        in.seekg(static_cast<std::streamoff>(from));
        in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return bytes;
      },
      path);
  if (in && !seal)
    return;
  in.seekg(0);
  Hash hash;
  std::vector<std::byte> block(1 << 20); // whole words: the sum of blocks is that of all
  const std::uint64_t n_bytes = size - sizeof(Seal);
  for (std::uint64_t at = 0, n = 0; at < n_bytes && in; at += n)
    {
      n = std::min<std::uint64_t>(block.size(), n_bytes - at);
      in.read(reinterpret_cast<char *>(block.data()), static_cast<std::streamsize>(n));
      hash.words(std::span<const std::byte>(block.data(), n));
    }
  if (!in)
    throw InputError(fmt::format("{}: cannot be read to its end; copy it again", path.string()));
  compare(seal.value(), n_bytes, hash.value(), path);
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
  const std::optional<Seal> seal = seal_of(
      bytes.size(),
      [&](std::uint64_t from, std::size_t n) { return std::string(from < bytes.size() ? bytes.substr(from, n) : ""); },
      path);
  if (!seal)
    return bytes;
  bytes.remove_suffix(sizeof(Seal));
  compare(*seal, bytes.size(), check_sum(bytes), path);
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
    throw InputError(
        fmt::format("{}: cannot be read: {}; check path and permissions", path.string(), std::strerror(errno)));
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

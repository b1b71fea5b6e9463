// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "base/files/hdf5.hpp"

#include <cstring>
#include <fmt/format.h>

namespace isostat::hdf5
{
void write_bytes(Group group, const std::string &name, std::span<const std::byte> bytes)
{
  std::vector<std::uint64_t> words((bytes.size() + 7) / 8, 0);
  if (!bytes.empty())
    std::memcpy(words.data(), bytes.data(), bytes.size());
  group.write(name, words, "-");
  group.set_attribute("bytes", static_cast<std::uint64_t>(bytes.size()), name);
}

std::vector<std::byte> read_bytes(const Group &group, const std::string &name)
{
  const auto words = group.read<std::uint64_t>(name);
  const auto n = group.attribute<std::uint64_t>("bytes", name);
  if (n > words.size() * 8)
    throw InputError(
        fmt::format("{}: {} holds {} bytes of {}: it is cut off", group.where(), name, words.size() * 8, n));
  std::vector<std::byte> bytes(n);
  if (n > 0)
    std::memcpy(bytes.data(), words.data(), n);
  return bytes;
}
} // namespace isostat::hdf5

// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/seal.hpp"

#include "base/error.hpp"
#include "base/files/hash.hpp"

#include <array>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr std::string_view mark = "isostat-sealed 1";

struct Seal
{
  std::array<char, mark.size()> known_by;
  std::uint64_t n_bytes, check_sum;
};

Seal seal_of(std::string_view bytes)
{
  Seal seal{{}, bytes.size(), Hash().words(std::as_bytes(std::span(bytes))).value()};
  mark.copy(seal.known_by.data(), mark.size());
  return seal;
}
} // namespace

std::string sealed(std::string bytes)
{
  const Seal seal = seal_of(bytes);
  return bytes.append(reinterpret_cast<const char *>(&seal), sizeof seal);
}

std::string_view unsealed(std::string_view bytes, const std::filesystem::path &path)
{
  Seal found;
  if (bytes.size() < sizeof found)
    return bytes;
  std::memcpy(&found, bytes.data() + bytes.size() - sizeof found, sizeof found);
  if (std::string_view(found.known_by.data(), mark.size()) != mark)
    return bytes;
  bytes.remove_suffix(sizeof found);
  const Seal expected = seal_of(bytes);
  if (found.n_bytes != expected.n_bytes || found.check_sum != expected.check_sum)
    throw InputError(fmt::format("{}: damaged: its {} bytes are not the {} that were written (check sum {:016x}, "
                                 "expected {:016x}); write or copy it again, or delete it if it is a cache",
                                 path.string(), bytes.size(), found.n_bytes, expected.check_sum, found.check_sum));
  return bytes;
}
} // namespace isostat

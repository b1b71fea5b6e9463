// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace isostat
{
/// FNV-1a with 64 bits (Fowler, Noll and Vo): value = (value xor unit) * prime for each unit. Stable names for cache
/// entries and check sums of files; not for secrets. What is stored depends on these values: they must not change.
/// Tested: tests/base/files/hash_test.cpp.
class Hash
{
public:
  /// Byte by byte, as the algorithm is published.
  Hash &text(std::string_view text)
  {
    for (const unsigned char byte : text)
      mix(byte);
    return *this;
  }
  /// Eight bytes at a time, for large data; a shift after each lets high bits reach the low ones.
  Hash &words(std::span<const std::byte> bytes)
  {
    for (std::size_t at = 0; at < bytes.size(); at += 8)
      {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data() + at, std::min<std::size_t>(8, bytes.size() - at));
        mix(word);
        value_ ^= value_ >> 29;
      }
    return *this;
  }
  /// The bits of numbers as words: 0 and -0 differ.
  Hash &words(std::span<const double> numbers) { return words(std::as_bytes(numbers)); }
  std::uint64_t value() const { return value_; }

private:
  void mix(std::uint64_t unit) { value_ = (value_ ^ unit) * 1099511628211ull; }
  std::uint64_t value_ = 14695981039346656037ull;
};
} // namespace isostat

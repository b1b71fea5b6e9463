// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace isostat
{
/// Appends texts, counts and numbers to a row of bytes. What pack() of a material is written with.
class ByteWriter
{
public:
  void count(std::uint64_t n) { raw(&n, sizeof n); }
  void text(const std::string &s)
  {
    count(s.size());
    raw(s.data(), s.size());
  }
  void numbers(std::span<const double> x)
  {
    count(x.size());
    raw(x.data(), x.size_bytes());
  }
  void block(std::span<const std::byte> b)
  {
    count(b.size());
    raw(b.data(), b.size());
  }
  std::vector<std::byte> take() { return std::move(bytes_); }

private:
  void raw(const void *from, std::size_t n)
  {
    const auto *b = static_cast<const std::byte *>(from);
    bytes_.insert(bytes_.end(), b, b + n);
  }
  std::vector<std::byte> bytes_;
};

/// Takes them out again in the same order; whatever does not fit is an InputError that begins with `reader`.
class ByteReader
{
public:
  ByteReader(std::span<const std::byte> bytes, std::string reader) : bytes_(bytes), reader_(std::move(reader)) {}

  std::uint64_t count()
  {
    std::uint64_t n = 0;
    raw(&n, sizeof n);
    return n;
  }
  std::string text()
  {
    std::string s(length(1), '\0');
    raw(s.data(), s.size());
    return s;
  }
  /// As many numbers as were written, which must be those of `to`.
  void numbers(std::span<double> to, const char *what)
  {
    expect(length(sizeof(double)), to.size(), what);
    raw(to.data(), to.size_bytes());
  }
  std::span<const std::byte> block()
  {
    const std::size_t n = length(1);
    const auto b = bytes_.first(n);
    bytes_ = bytes_.subspan(n);
    return b;
  }
  void expect(std::uint64_t found, std::uint64_t expected, const char *what) const
  {
    if (found != expected)
      fail(std::string("the bytes have ") + std::to_string(found) + " " + what + ", expected " +
           std::to_string(expected));
  }
  void expect(const std::string &found, const std::string &expected) const
  {
    if (found != expected)
      fail("the bytes are those of '" + found + "'");
  }
  void expect_end() const
  {
    if (!bytes_.empty())
      fail(std::to_string(bytes_.size()) + " bytes are left over");
  }
  [[noreturn]] void fail(const std::string &why) const
  {
    throw InputError(reader_ + ": cannot unpack the state: " + why +
                     "; continue with the soil that the state was stored with");
  }

private:
  std::size_t length(std::size_t size)
  {
    const std::uint64_t n = count();
    if (n > bytes_.size() / size)
      fail("the bytes are cut off or not a state at all");
    return n;
  }
  void raw(void *to, std::size_t n)
  {
    if (n > bytes_.size())
      fail("the bytes are cut off");
    if (n > 0)
      std::memcpy(to, bytes_.data(), n);
    bytes_ = bytes_.subspan(n);
  }
  std::span<const std::byte> bytes_;
  std::string reader_;
};
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/error.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace isostat
{
/// Appends values, texts and rows of numbers to a row of bytes, in the machine's own representation: what travels
/// between ranks and into checkpoints, the state of materials and packings. A row or text comes after its length.
/// Tested: tests/base/files/bytes_test.cpp.
class ByteWriter
{
public:
  template <typename T>
  void value(const T &x)
  {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    raw(&x, sizeof x);
  }
  void count(std::uint64_t n) { value(n); }
  template <typename T, typename A>
  void row(const std::vector<T, A> &values)
  {
    // A pair of numbers is copied by its bytes as well, although its assignment is not trivial.
    static_assert(std::is_trivially_copy_constructible_v<T> && std::is_trivially_destructible_v<T>);
    count(values.size());
    raw(values.data(), sizeof(T) * values.size());
  }
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
    append(b);
  }
  /// Without its length: what the reader takes as the rest.
  void append(std::span<const std::byte> b) { raw(b.data(), b.size()); }
  std::vector<std::byte> take() { return std::move(bytes_); }

private:
  void raw(const void *from, std::size_t n)
  {
    const auto *b = static_cast<const std::byte *>(from);
    bytes_.insert(bytes_.end(), b, b + n);
  }
  std::vector<std::byte> bytes_;
};

/// Takes them out again in the same order; whatever does not fit is an InputError that begins with `reader` and ends
/// with what the user can do.
class ByteReader
{
public:
  ByteReader(std::span<const std::byte> bytes, std::string reader,
             std::string remedy = "continue with the soil that the state was stored with")
      : bytes_(bytes), reader_(std::move(reader)), remedy_(std::move(remedy))
  {}

  template <typename T>
  void value(T &x)
  {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>);
    if constexpr (std::is_same_v<T, bool>)
      {
        unsigned char byte = 0;
        raw(&byte, sizeof byte);
        if (byte > 1)
          fail("a byte that says yes or no is " + std::to_string(byte));
        x = byte != 0;
      }
    else
      raw(&x, sizeof x);
  }
  std::uint64_t count()
  {
    std::uint64_t n = 0;
    value(n);
    return n;
  }
  /// As many values as were written.
  template <typename T, typename A>
  void row(std::vector<T, A> &values)
  {
    values.resize(length(sizeof(T)));
    raw(values.data(), sizeof(T) * values.size());
  }
  std::string text()
  {
    std::string s(length(1), '\0');
    raw(s.data(), s.size());
    return s;
  }
  /// As many numbers as were written, which must be those of `to`, and finite.
  void numbers(std::span<double> to, const char *what)
  {
    expect(length(sizeof(double)), to.size(), what);
    raw(to.data(), to.size_bytes());
    for (const double x : to)
      if (!std::isfinite(x))
        fail(std::string("one of its ") + what + " is not finite");
  }
  std::span<const std::byte> block()
  {
    const std::size_t n = length(1);
    const auto b = bytes_.first(n);
    bytes_ = bytes_.subspan(n);
    return b;
  }
  std::span<const std::byte> rest() const { return bytes_; }
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
    throw InputError(reader_ + ": cannot unpack the state: " + why + "; " + remedy_);
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
  std::string reader_, remedy_;
};
} // namespace isostat

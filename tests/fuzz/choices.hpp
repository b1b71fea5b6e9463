// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a fuzzer as choices, for targets that damage something whole instead of reading the bytes themselves.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

namespace isostat::fuzz
{
/// Takes bytes one after the other; zeros where they are used up.
class Choices
{
public:
  Choices(const std::uint8_t *data, std::size_t size) : left_(data, size) {}

  bool used_up() const { return left_.empty(); }

  template <typename T>
  T value()
  {
    T x{};
    const std::size_t n = std::min(sizeof x, left_.size());
    if (n > 0)
      std::memcpy(&x, left_.data(), n);
    left_ = left_.subspan(n);
    return x;
  }
  /// One of 0 .. n - 1.   @pre n > 0
  std::size_t below(std::size_t n) { return n > 256 ? value<std::uint32_t>() % n : value<std::uint8_t>() % n; }
  template <typename T, std::size_t n>
  T one_of(const std::array<T, n> &all)
  {
    return all[below(n)];
  }

  /// A number that programs get wrong, or any.
  double number()
  {
    using Limits = std::numeric_limits<double>;
    constexpr std::array<double, 16> hard = {0,
                                             -0.,
                                             1,
                                             -1,
                                             0.5,
                                             1e-300,
                                             1e300,
                                             2,
                                             1e-310,
                                             4294967296.0,
                                             1e19,
                                             -1e5,
                                             Limits::max(),
                                             Limits::infinity(),
                                             -Limits::infinity(),
                                             Limits::quiet_NaN()};
    const std::size_t which = below(hard.size() + 4);
    return which < hard.size() ? hard[which] : value<double>();
  }
  std::uint64_t count()
  {
    constexpr std::array<std::uint64_t, 10> hard = {0, 1, 2, 3, 63, 64, 65, 1u << 31, 0xffffffff, ~std::uint64_t{0}};
    const std::size_t which = below(hard.size() + 4);
    return which < hard.size() ? hard[which] : value<std::uint64_t>();
  }

private:
  std::span<const std::uint8_t> left_;
};
} // namespace isostat::fuzz

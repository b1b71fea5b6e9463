// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/hash.hpp"

#include <array>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
// Published values of FNV-1a with 64 bits: draft-eastlake-fnv, appendix.
TEST(Hash, OfTextsIsFnv1a)
{
  EXPECT_EQ(Hash().value(), 0xcbf29ce484222325u);
  EXPECT_EQ(Hash().text("a").value(), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(Hash().text("foobar").value(), 0x85944171f73967e8u);
  EXPECT_EQ(Hash().text("foo").text("bar").value(), Hash().text("foobar").value());
}

TEST(Hash, OfWordsSeesEveryBit)
{
  const auto of = [](std::array<double, 2> numbers) { return Hash().words(numbers).value(); };
  EXPECT_NE(of({1, 0.0}), of({1, -0.0}));
  EXPECT_NE(of({1, 2}), of({2, 1}));
  const std::array<std::byte, 9> nine{};
  EXPECT_NE(Hash().words(nine).value(), Hash().words(std::span(nine).first(8)).value());
}
} // namespace
} // namespace isostat

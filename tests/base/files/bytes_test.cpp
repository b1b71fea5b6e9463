// SPDX-License-Identifier: BSD-3-Clause
#include "base/files/bytes.hpp"

#include <array>
#include <cmath>
#include <gmock/gmock.h>

namespace isostat
{
namespace
{
std::vector<std::byte> example()
{
  ByteWriter out;
  out.value(0.1);
  out.text("sand");
  out.numbers(std::array{1.0, -0.0});
  out.row(std::vector<int>{3, 4, 5});
  out.block(std::array{std::byte{7}});
  return out.take();
}

TEST(Bytes, ComeBackInOrder)
{
  const std::vector<std::byte> bytes = example();
  ByteReader in(bytes, "test");
  double x = 0;
  std::array<double, 2> numbers{};
  std::vector<int> row;
  in.value(x);
  EXPECT_EQ(x, 0.1);
  EXPECT_EQ(in.text(), "sand");
  in.numbers(numbers, "numbers");
  EXPECT_EQ(numbers[0], 1);
  EXPECT_TRUE(std::signbit(numbers[1]));
  in.row(row);
  EXPECT_THAT(row, testing::ElementsAre(3, 4, 5));
  EXPECT_THAT(in.block(), testing::ElementsAre(std::byte{7}));
  in.expect_end();
}

TEST(Bytes, CutAtAnyPlaceAreRefused)
{
  const std::vector<std::byte> bytes = example();
  for (std::size_t n = 0; n < bytes.size(); ++n)
    {
      ByteReader in(std::span<const std::byte>(bytes).first(n), "test");
      const auto read = [&] {
        double x = 0;
        std::array<double, 2> numbers{};
        std::vector<int> row;
        in.value(x), in.text(), in.numbers(numbers, "numbers"), in.row(row), in.block(), in.expect_end();
      };
      EXPECT_THROW(read(), InputError) << n;
    }
}

TEST(Bytes, YesAndNoAreOneAndZero)
{
  bool x = false;
  for (const unsigned char byte : {1, 0, 2, 255})
    {
      ByteReader in(std::as_bytes(std::span(&byte, 1)), "test");
      if (byte > 1)
        EXPECT_THROW(in.value(x), InputError);
      else
        {
          in.value(x);
          EXPECT_EQ(x, byte == 1);
        }
    }
}

TEST(Bytes, SayWhoReadsAndWhatHelps)
{
  ByteReader in({}, "a packed element", "pack it again");
  EXPECT_THAT([&] { in.count(); }, testing::ThrowsMessage<InputError>(testing::AllOf(
                                       testing::StartsWith("a packed element: "), testing::EndsWith("pack it again"))));
}
} // namespace
} // namespace isostat

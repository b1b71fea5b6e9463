// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "dem/drive/stages/stages.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
Repeat repeat(std::uint64_t stages, std::uint64_t times)
{
  Repeat stage;
  stage.stages = stages;
  stage.times = times;
  return stage;
}

using Order = std::vector<std::size_t>;

TEST(Repeat, WithoutItStagesFollowEachOther)
{
  EXPECT_EQ(order_of({}), Order{});
  EXPECT_EQ(order_of({Hold(), Compress()}), (Order{0, 1}));
}

TEST(Repeat, CountsTheFirstTime)
{
  EXPECT_EQ(order_of({Hold(), Compress(), Hold(), repeat(2, 3), Hold()}), (Order{0, 1, 2, 1, 2, 1, 2, 4}));
  EXPECT_EQ(order_of({Hold(), repeat(1, 1)}), Order{0});
}

TEST(Repeat, MayBeRepeated)
{
  EXPECT_EQ(order_of({Hold(), repeat(1, 2), Compress(), repeat(3, 2)}), (Order{0, 0, 2, 0, 0, 2}));
}

TEST(Repeat, OfMoreThanThereIsIsRefused) { EXPECT_THROW(order_of({Hold(), repeat(2, 2)}), InputError); }
} // namespace
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "dem/drive/stages/cycles.hpp"

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

using Cycles = std::vector<StageCycle>;

TEST(Repeat, SaysWhichTimeItIs)
{
  EXPECT_EQ(cycles_at({Hold(), Compress()}, 1), Cycles{});
  const std::vector<Stage> one = {Hold(), Compress(), Hold(), repeat(2, 3), Hold()}; // 0 1 2 1 2 1 2 4
  for (const auto &[done, cycle] : std::vector<std::pair<std::uint64_t, std::uint64_t>>{{1, 1}, {2, 1}, {3, 2}, {6, 3}})
    EXPECT_EQ(cycles_at(one, done), (Cycles{{cycle, 3, 1, 2}})) << done;
  EXPECT_EQ(cycles_at(one, 0), Cycles{});
  EXPECT_EQ(cycles_at(one, 7), Cycles{});
  EXPECT_EQ(cycle_text(one, 4), ", cycle 2 of 3 of stages 1 to 2");
  EXPECT_EQ(cycle_text({Hold(), repeat(1, 1)}, 0), "") << "once is no repeat";
  EXPECT_EQ(repeats_text(one), std::vector<std::string>{"stages 1 to 2, 3 times"});
}

TEST(Repeat, OfARepeatHasTheCyclesOfBoth)
{
  const std::vector<Stage> nested = {Hold(), repeat(1, 2), Compress(), repeat(3, 2)}; // 0 0 2 0 0 2
  const Cycles outer[] = {{{1, 2, 0, 2}, {1, 2, 0, 0}}, {{1, 2, 0, 2}, {2, 2, 0, 0}}, {{1, 2, 0, 2}},
                          {{2, 2, 0, 2}, {1, 2, 0, 0}}, {{2, 2, 0, 2}, {2, 2, 0, 0}}, {{2, 2, 0, 2}}};
  ASSERT_EQ(order_of(nested).size(), std::size(outer));
  for (std::size_t done = 0; done < std::size(outer); ++done)
    EXPECT_EQ(cycles_at(nested, done), outer[done]) << done;
}

TEST(Repeat, OfMoreThanThereIsIsRefused) { EXPECT_THROW(order_of({Hold(), repeat(2, 2)}), InputError); }
} // namespace
} // namespace isostat

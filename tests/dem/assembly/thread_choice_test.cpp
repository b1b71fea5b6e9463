// SPDX-License-Identifier: BSD-3-Clause
#include "dem/assembly/thread_choice.hpp"

#include "tests/support/near.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
/// A minute of steps that take so long on one thread and on several, s.   @return per cent of the time on several
double percent_on_several(ThreadChoice &choice, double on_one, double on_several)
{
  double all = 0, several = 0;
  while (all < 60)
    {
      const double seconds = choice.several() ? on_several : on_one;
      all += seconds;
      several += choice.several() ? seconds : 0;
      choice.add(seconds);
    }
  return 100 * several / all;
}
} // namespace

TEST(ThreadChoice, TakesTheFasterWayExceptForTrials)
{
  for (double on_one : {1e-5, 3e-4, 1e-3})
    {
      ThreadChoice choice;
      EXPECT_GT(percent_on_several(choice, on_one, 0.6 * on_one), 93) << on_one; // trials: 2 %, and four steps at least
      ThreadChoice other;
      EXPECT_LT(percent_on_several(other, on_one, 1.5 * on_one), 10) << on_one; // only the trials
    }
}

TEST(ThreadChoice, FollowsTheMachine)
{
  ThreadChoice choice;
  percent_on_several(choice, 3e-4, 2e-4);
  EXPECT_BELOW_BECAUSE(percent_on_several(choice, 3e-4, 3e-3), 10, "trials, and up to a second until it is noticed");
  EXPECT_GT(percent_on_several(choice, 3e-4, 2e-4), 90);
}

TEST(ThreadChoice, CostsAtMostAFewPercent)
{
  ThreadChoice choice;
  double all = 0;
  long steps = 0;
  for (; all < 60; ++steps)
    {
      const double seconds = choice.several() ? 2e-3 : 3e-4; // several are seven times slower
      all += seconds;
      choice.add(seconds);
    }
  const double on_one = 3e-4 * static_cast<double>(steps);
  EXPECT_LT(all, 1.05 * on_one); // trials, 2 % of the time, and their few steps
}
} // namespace isostat

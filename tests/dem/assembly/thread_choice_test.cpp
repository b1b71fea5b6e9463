// SPDX-License-Identifier: BSD-3-Clause
#include "dem/assembly/thread_choice.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
/// A minute of steps that take so long on one thread and on several, s.   @return share of the time on several
double share_on_several(ThreadChoice &choice, double on_one, double on_several)
{
  double all = 0, several = 0;
  while (all < 60)
    {
      const double seconds = choice.several() ? on_several : on_one;
      all += seconds;
      several += choice.several() ? seconds : 0;
      choice.add(seconds);
    }
  return several / all;
}
} // namespace

TEST(ThreadChoice, TakesTheFasterWayButForTrials)
{
  for (double on_one : {1e-5, 3e-4, 1e-3})
    {
      ThreadChoice choice;
      EXPECT_GT(share_on_several(choice, on_one, 0.6 * on_one), 0.93) << on_one;
      ThreadChoice other;
      EXPECT_LT(share_on_several(other, on_one, 1.5 * on_one), 0.1) << on_one;
    }
}

TEST(ThreadChoice, FollowsTheMachine)
{
  ThreadChoice choice;
  share_on_several(choice, 3e-4, 2e-4);
  EXPECT_LT(share_on_several(choice, 3e-4, 3e-3), 0.1); // others have come
  EXPECT_GT(share_on_several(choice, 3e-4, 2e-4), 0.9); // and gone
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
  EXPECT_LT(all, 1.05 * 3e-4 * steps);
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/progress.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;
using testing::Not;

TEST(Progress, DurationsReadAsPeopleSayThem)
{
  EXPECT_EQ(duration_text(42), "42 s");
  EXPECT_EQ(duration_text(17 * 60), "17 min");
  EXPECT_EQ(duration_text(3.1 * 3600), "3.1 h");
}

TEST(Progress, ALineHasShareRateTimeLeftAndState)
{
  Progress progress(false, 0);
  EXPECT_TRUE(progress.due(1000, 0.5)); // a resumed run
  EXPECT_THAT(progress.line("p' 1 kPa"), testing::MatchesRegex(" 50.0 %  step      1000 +0 1/s  p' 1 kPa"));
  for (int k = 0; k < 16; ++k)
    progress.due(1100, 0.75);
  EXPECT_THAT(progress.line("state"),
              testing::MatchesRegex(" 75.0 %  step      1100 +[1-9][0-9]* 1/s  ETA 0 s  state"));
}

TEST(Progress, StartsAgainWithANewStage)
{
  Progress progress(false, 0);
  progress.due(0, 0.1);
  for (int k = 0; k < 16; ++k)
    progress.due(10, 0.9);
  EXPECT_THAT(progress.line(""), HasSubstr("ETA"));
  for (int k = 0; k < 16; ++k)
    progress.due(20, 0.0);
  EXPECT_THAT(progress.line(""), Not(HasSubstr("ETA")));
}

TEST(Progress, AnUnknownShareIsNotPrinted)
{
  Progress progress(false, 0);
  progress.due(7, -1);
  EXPECT_THAT(progress.line("state"), testing::StartsWith("step"));
}

TEST(Progress, IsQuietOrNotDue)
{
  Progress quiet(true, 0), patient(false, 1e6);
  EXPECT_FALSE(quiet.due(1, 0.5));
  EXPECT_FALSE(patient.due(1, 0.5));
}

TEST(Stopwatch, AddsTheSecondsOfAScope)
{
  double sum = 1;
  {
    const TimedScope timed(sum);
    Stopwatch watch;
    while (watch.seconds() <= 1e-4)
      ;
  }
  EXPECT_GT(sum, 1 + 1e-4);
}
} // namespace
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// How the end of stages is reported. Runs of packings: tests/verification/path_ends_test.cpp.
#include "dem/drive/stages/stage_end.hpp"

#include "dem/drive/programme.hpp"
#include "tests/support/specimens.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
TEST(StageEnd, NamesTheConditionsWithWhatWasReached)
{
  StageFigures f;
  f.driven = 0.0123, f.strain = 0.02, f.volumetric = 0.001, f.p = 150e3, f.q = 63e3;
  f.reversals = 9, f.own_reversals = 7, f.unbalanced = 2e-3, f.stress_error = 0.05, f.place = 0.25;
  Path path;
  path.end = {.strain = 0.05, .volumetric_strain = 0.02, .q = 100e3, .p = 50e3, .stress_ratio = 1.2, .cycles = 10};
  EXPECT_EQ(to_text(path.conditions(f)),
            "until.strain = 5 % (1.23 % reached), until.volumetric_strain = 2 % (0.1 % reached), until.q = 100 kPa (63 "
            "kPa reached), until.p = 50 kPa (150 kPa reached), until.stress_ratio = 1.2 (0.42 reached), until.cycles = "
            "10 (3.5 reached)");
  path.end = {};
  EXPECT_TRUE(path.conditions(f).empty()) << "max_steps alone is its end";
  path.drive = DrivenComponent::none;
  EXPECT_EQ(to_text(path.conditions(f)),
            "the end of its course (25 % of it gone), stresses within 0.5 % of p' of their targets "
            "(5 % reached), balance = 0.001 (0.002 reached)");
  EXPECT_EQ(to_text(test::sheared_to<Drained>(0.1).conditions(f)), "strain = 10 % (1.23 % reached)");
  EXPECT_EQ(to_text(UndrainedCyclic().conditions(f)),
            "until.cycles = 200 (4.5 reached), until.reversals_after_liquefaction = 10 "
            "(not liquefied), until.strain = 15 % (2 %)");
  f.since_liquefied = 3;
  EXPECT_NE(to_text(UndrainedCyclic().conditions(f)).find("10 (3)"), std::string::npos);
  EXPECT_EQ(to_text(Hold().conditions(f)), "balance = 0.0001 (0.002 reached)");
  EXPECT_EQ(to_text(Compress().conditions(f)),
            "balance = 0.0001 (0.002 reached), stresses within 1 % of their target (5 % reached)");
}

TEST(StageEnd, SaysWhichConditionCameFirst)
{
  UndrainedCyclic cyclic;
  cyclic.max_cycles = 60;
  StageEnd end;
  end.by = EndCondition::strain;
  end.figures.strain = 0.1502, end.figures.reversals = 6;
  EXPECT_EQ(to_text(end, {cyclic}),
            "stage 0 (undrained-cyclic): ended by until.strain = 15 % (15.02 %), before until.cycles = 60 (3 reached), "
            "until.reversals_after_liquefaction = 10 (not liquefied)");
  EXPECT_FALSE(is_early(end, {cyclic}));
  end.by = EndCondition::max_steps;
  EXPECT_TRUE(is_early(end, {cyclic}));
  EXPECT_FALSE(is_early(end, {Path()})) << "max_steps alone is its end";
  EXPECT_EQ(to_text(end, {Path()}), "stage 0 (path): ended by max_steps = 0");
}

/// Of three times a stage is noted once, each with what ended it; only one of these ends is early.
TEST(StageEnd, OfARepeatedStageIsNotedOnce)
{
  Path limited;
  limited.max_steps = 5;
  limited.end.strain = 0.5;
  Path by_steps;
  by_steps.max_steps = 5;
  Path reaches;
  reaches.end.strain = 1e-6;
  reaches.max_steps = 10'000;
  Repeat repeat;
  repeat.stages = 2;
  repeat.times = 3;
  Assembly assembly(test::specimen(300, 10));
  DriveState state;
  test::Unobserved nobody;
  const std::vector<Stage> stages = {by_steps, limited, repeat, reaches};
  run_programme({.record = {}, .stages = stages}, assembly, state, nobody);
  ASSERT_EQ(state.ends.size(), 3u);
  const auto early = [&](const StageEnd &e) { return is_early(e, stages); };
  ASSERT_EQ(std::ranges::count_if(state.ends, early), 1);
  EXPECT_EQ(state.ends[2].by, EndCondition::strain);
  const StageEnd &end = state.ends[1];
  EXPECT_TRUE(early(end));
  EXPECT_EQ(end.stage, 1u);
  EXPECT_EQ(end.done, 1u);
  EXPECT_EQ(end.times, 3u);
  EXPECT_FALSE(end.at_once);
  const std::string text = to_text(end, stages);
  EXPECT_EQ(
      text.find("stage 1 (path), cycle 1 of 3 of stages 0 to 1: ended by max_steps = 5 before any of its conditions "
                "was met: until.strain = 50 % ("),
      0u)
      << text;
  EXPECT_NE(text.find("3 times in all"), std::string::npos) << text;
}
} // namespace
} // namespace isostat

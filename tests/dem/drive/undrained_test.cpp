// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/undrained.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
Stage cyclic()
{
  Stage stage;
  stage.kind = StageKind::undrained_cyclic;
  stage.deviator_amplitude = 60e3;
  stage.reversals_after_liquefaction = 2;
  stage.max_cycles = 50;
  return stage;
}

DriveState loaded()
{
  DriveState state;
  state.p0 = 200e3;
  state.signed_rate = state.rate = 1;
  return state;
}

TEST(Undrained, TurnsAtTheAmplitudeAndNotesTheOvershoot)
{
  DriveState state = loaded();
  EXPECT_FALSE(observe_undrained(cyclic(), {180e3, 59.9e3, 1e-5, 10}, state).notable);
  const Verdict verdict = observe_undrained(cyclic(), {180e3, 60.1e3, 2e-5, 11}, state);
  EXPECT_TRUE(verdict.notable);
  EXPECT_FALSE(verdict.finished);
  EXPECT_NE(verdict.event.find("reversal 1 at step 11"), std::string::npos) << verdict.event;
  EXPECT_EQ(state.direction, -1);
  EXPECT_EQ(state.signed_rate, 0);
  EXPECT_NEAR(state.worst_overshoot, 100, 1e-9);
  // on the way back the positive limit does not count
  EXPECT_FALSE(observe_undrained(cyclic(), {180e3, 60.2e3, 2e-5, 12}, state).notable);
  EXPECT_TRUE(observe_undrained(cyclic(), {180e3, -60e3, -2e-5, 20}, state).notable);
  EXPECT_EQ(state.direction, 1);
  EXPECT_EQ(state.reversals, 2);
}

TEST(Undrained, LiquefactionIsNotedOnceWithTheStrainBeforeIt)
{
  DriveState state = loaded();
  observe_undrained(cyclic(), {150e3, 10e3, -7e-4, 5}, state);
  const Verdict onset = observe_undrained(cyclic(), {1.9e3, 1e3, 3e-4, 6}, state);
  EXPECT_TRUE(onset.notable);
  EXPECT_NE(onset.event.find("initial liquefaction"), std::string::npos);
  EXPECT_EQ(state.liquefaction_step, 6);
  EXPECT_DOUBLE_EQ(state.max_strain_before, 7e-4);
  observe_undrained(cyclic(), {50e3, 1e3, 5e-2, 7}, state);
  EXPECT_FALSE(observe_undrained(cyclic(), {1.0e3, 1e3, 3e-4, 8}, state).notable);
  EXPECT_DOUBLE_EQ(state.max_strain_before, 7e-4);
}

TEST(Undrained, EndsAfterTheReversalsAskedFor)
{
  DriveState state = loaded();
  observe_undrained(cyclic(), {1e3, 1e3, 3e-4, 6}, state);
  EXPECT_FALSE(observe_undrained(cyclic(), {60e3, 60e3, 1e-2, 7}, state).finished);
  EXPECT_TRUE(observe_undrained(cyclic(), {60e3, -60e3, -1e-2, 8}, state).finished);
}

TEST(Undrained, EndsAtTheLargestStrainAndAfterTheLargestNumberOfCycles)
{
  DriveState state = loaded();
  EXPECT_TRUE(observe_undrained(cyclic(), {1e3, 0, -0.16, 6}, state).finished);
  state = loaded();
  state.reversals = 99;
  EXPECT_TRUE(observe_undrained(cyclic(), {180e3, 60e3, 1e-5, 6}, state).finished);
}

TEST(Undrained, MonotonicEndsAtItsStrain)
{
  Stage stage;
  stage.kind = StageKind::undrained_monotonic;
  stage.strain = 0.05;
  DriveState state = loaded();
  state.axial = -0.0499;
  EXPECT_FALSE(observe_undrained(stage, {180e3, 90e3, -0.0499, 6}, state).finished);
  state.axial = -0.05;
  EXPECT_TRUE(observe_undrained(stage, {180e3, 90e3, -0.05, 7}, state).finished);
}
} // namespace
} // namespace isostat

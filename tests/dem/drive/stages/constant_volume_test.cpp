// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/stages.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
UndrainedCyclic cyclic()
{
  UndrainedCyclic stage;
  stage.deviator_amplitude = 60e3;
  stage.reversals_after_liquefaction = 2;
  stage.max_cycles = 50;
  return stage;
}

DriveState loaded()
{
  DriveState state;
  state.path.start = ShearStart{Vec3::Ones(), 200e3};
  state.loading.signed_rate = state.pace.rate = 1;
  return state;
}

/// What a stage says to an observation: it looks at nothing else.
Verdict judge(const StageBehaviour &stage, const Observation &seen, DriveState &state)
{
  Snapshot two_grains;
  two_grains.grains = make_packing({Vec3(1e-3, 2e-3, 3e-3), Vec3(4e-3, 5e-3, 6e-3)}, {1e-4, 2e-4}, 2650);
  two_grains.box = {Vec3::Zero(), Vec3::Constant(1e-2)};
  Assembly assembly(two_grains);
  return stage.judge({{}, {}, assembly, state}, seen);
}

TEST(ConstantVolume, TurnsAtTheAmplitudeAndNotesTheOvershoot)
{
  DriveState state = loaded();
  EXPECT_FALSE(judge(cyclic(), {180e3, 59.9e3, 1e-5, 10}, state).notable);
  const Verdict verdict = judge(cyclic(), {180e3, 60.1e3, 2e-5, 11}, state);
  EXPECT_TRUE(verdict.notable);
  EXPECT_FALSE(verdict.end);
  EXPECT_NE(verdict.event.find("reversal 1 at step 11"), std::string::npos) << verdict.event;
  EXPECT_EQ(state.loading.direction, LoadDirection::extension);
  EXPECT_EQ(state.loading.signed_rate, 0);
  EXPECT_NEAR_BECAUSE(state.undrained.worst_overshoot, 100, 1e-9, "round-off of a difference of 60 kPa");
  // on the way back the positive limit does not count
  EXPECT_FALSE(judge(cyclic(), {180e3, 60.2e3, 2e-5, 12}, state).notable);
  EXPECT_TRUE(judge(cyclic(), {180e3, -60e3, -2e-5, 20}, state).notable);
  EXPECT_EQ(state.loading.direction, LoadDirection::compression);
  EXPECT_EQ(state.undrained.reversals, 2u);
}

TEST(ConstantVolume, LiquefactionIsNotedOnceWithTheStrainBeforeIt)
{
  DriveState state = loaded();
  judge(cyclic(), {150e3, 10e3, -7e-4, 5}, state);
  const Verdict onset = judge(cyclic(), {1.9e3, 1e3, 3e-4, 6}, state);
  EXPECT_TRUE(onset.notable);
  EXPECT_NE(onset.event.find("initial liquefaction"), std::string::npos);
  EXPECT_EQ(state.undrained.liquefaction->step, 6u);
  EXPECT_DOUBLE_EQ(state.undrained.max_strain_before, 7e-4);
  judge(cyclic(), {50e3, 1e3, 5e-2, 7}, state);
  EXPECT_FALSE(judge(cyclic(), {1.0e3, 1e3, 3e-4, 8}, state).notable);
  EXPECT_DOUBLE_EQ(state.undrained.max_strain_before, 7e-4);
}

TEST(ConstantVolume, EndsAfterTheReversalsAskedFor)
{
  DriveState state = loaded();
  judge(cyclic(), {1e3, 1e3, 3e-4, 6}, state);
  EXPECT_FALSE(judge(cyclic(), {60e3, 60e3, 1e-2, 7}, state).end);
  EXPECT_TRUE(judge(cyclic(), {60e3, -60e3, -1e-2, 8}, state).end);
}

TEST(ConstantVolume, EndsAtTheLargestStrainAndAfterTheLargestNumberOfCycles)
{
  DriveState state = loaded();
  EXPECT_TRUE(judge(cyclic(), {1e3, 0, -0.16, 6}, state).end);
  state = loaded();
  state.undrained.reversals = 99;
  EXPECT_TRUE(judge(cyclic(), {180e3, 60e3, 1e-5, 6}, state).end);
}

TEST(ConstantVolume, MonotonicEndsAtItsStrain)
{
  UndrainedMonotonic stage;
  stage.strain_end = 0.05;
  DriveState state = loaded();
  state.loading.strain = -0.0499;
  EXPECT_FALSE(judge(stage, {180e3, 90e3, -0.0499, 6}, state).end);
  state.loading.strain = -0.05;
  EXPECT_TRUE(judge(stage, {180e3, 90e3, -0.05, 7}, state).end);
}
} // namespace
} // namespace isostat

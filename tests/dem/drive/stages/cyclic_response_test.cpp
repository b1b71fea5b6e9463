// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/stages/cyclic_response.hpp"

#include "dem/drive/programme.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
/// A specimen between 0 and 60 kPa, of which a test says how load and strain go.
class Response : public testing::Test
{
protected:
  Response()
  {
    state.path.start = ShearStart{Vec3::Ones(), 200e3};
    begin_response(0, state);
  }

  /// Strains on in the present direction while the load goes to another one in a line.
  void go(double load, double strain)
  {
    const double first_load = load_, first = state.loading.strain;
    for (int k = 1; k <= 100; ++k)
      {
        load_ = first_load + 0.01 * k * (load - first_load);
        state.loading.strain = first + 0.01 * k * sign(state.loading.direction) * strain;
        Verdict verdict;
        follow_response(load_, state.loading.strain, 30e3, triaxial_mode, 1, state, verdict);
        flows += !verdict.event.empty();
      }
  }
  void turn(bool at_load = true)
  {
    state.undrained.reversals += 1;
    state.loading.direction = opposite(state.loading.direction);
    turn_response(load_, state, at_load);
  }
  std::string name() const { return response_name(state.undrained, triaxial_mode); }

  DriveState state;
  int flows = 0;
  double load_ = 0;
};

TEST_F(Response, TheOtherSideDoesNotRecoverWhatSoftened)
{
  go(50e3, 2e-3), go(8e3, 0.05), turn(false); // at a strain, before its load
  ASSERT_EQ(name(), "flow");
  go(-60e3, 1e-3), turn();
  EXPECT_EQ(name(), "flow");
  begin_response(load_, state);
  EXPECT_EQ(name(), "flow") << "a later stage does not forget it";
  go(60e3, 1e-3), turn();
  EXPECT_EQ(name(), "limited flow");
}

TEST_F(Response, StrainThatRunsOnUnderAFallingLoadIsFlow)
{
  go(60e3, 1e-3), turn(), go(0, 1e-3), turn();
  EXPECT_EQ(name(), "no failure");
  go(50e3, 2e-3), go(10e3, 0.0009);
  EXPECT_EQ(flows, 0) << "not yet 0.1 % of strain beyond the peak";
  go(8e3, 0.05);
  EXPECT_EQ(flows, 1) << "told once";
  EXPECT_EQ(name(), "flow");
  EXPECT_FALSE(reverses_stress(state.undrained.response));
  EXPECT_EQ(state.undrained.response.flow->peak, 50e3);
  EXPECT_EQ(state.undrained.response.flow->reversals, 2u);
  EXPECT_NEAR_BECAUSE(state.undrained.response.flow->strain, 2e-3, 1e-9, "round-off of sums");
}

TEST_F(Response, FlowThatComesBackToItsTurningPointIsLimited)
{
  go(50e3, 2e-3), go(20e3, 0.03), go(60e3, 0.03), turn();
  EXPECT_EQ(name(), "limited flow");
}

TEST_F(Response, LoadThatPassesZeroAtSmallPressureIsCyclicMobility)
{
  go(60e3, 1e-3), turn();
  go(0, 1e-3), go(-100, 0.04), go(-60e3, 0.01), turn(); // liquefied after the turn, then it dilates
  go(100, 0.01), go(200, 0.05), go(60e3, 0.01), turn();
  state.undrained.liquefaction = Liquefaction{};
  EXPECT_EQ(flows, 0);
  EXPECT_EQ(name(), "cyclic mobility");
  EXPECT_TRUE(reverses_stress(state.undrained.response));
}

TEST_F(Response, StrainInOneDirectionWithoutLiquefactionAccumulates)
{
  for (int cycle = 0; cycle < 20; ++cycle)
    go(60e3, 4e-3), turn(), go(0, 1e-3), turn();
  EXPECT_EQ(name(), "plastic strain accumulation");
  EXPECT_EQ(flows, 0);
}

TEST_F(Response, AnOvershootBeyondZeroIsNoReversalOfStress)
{
  go(40e3, 1e-3), turn(), go(-0.1e3, 1e-3), turn(), go(40e3, 1e-3), turn();
  EXPECT_FALSE(reverses_stress(state.undrained.response));
  go(-4e3, 1e-3), turn();
  EXPECT_TRUE(reverses_stress(state.undrained.response));
}

TEST_F(Response, ASmallDropOfTheLoadIsNoSoftening)
{
  go(50e3, 2e-3), go(47.5e3, 0.03), go(60e3, 0.01), turn();
  EXPECT_EQ(name(), "no failure");
}

TEST(StaticBias, ASpecimenOutsideOfTheLoadsIsRefused)
{
  UndrainedCyclic stage;
  stage.deviator_average = 80e3;
  stage.deviator_amplitude = 30e3;
  Assembly assembly(test::specimen(300, 10));
  DriveState state;
  test::Unobserved nobody;
  test::expect_parts(test::refusal([&] { run_programme({.record = {}, .stages = {stage}}, assembly, state, nobody); }),
                     {"stage 0 (undrained-cyclic)", "q = ", "50 and 110 kPa", "deviator_average", "Static bias"});
}

/// Sheared to the average at constant lateral stress, then cycled about it.
TEST(StaticBias, TurnsAtBothLoads)
{
  struct Rows : test::Unobserved
  {
    std::vector<double> turns;
    void record(const Assembly &, const DriveState &state, const Observation &seen, bool) override
    {
      if (state.undrained.reversals > turns.size())
        turns.push_back(seen.q);
    }
  } rows;
  Drained bias = test::sheared_to<Drained>(6e-5);
  UndrainedCyclic stage;
  stage.deviator_average = 50e3;
  stage.deviator_amplitude = 45e3;
  stage.max_cycles = 2;
  Assembly assembly(test::specimen(500, 4));
  DriveState state;
  run_programme({.record = {}, .stages = {bias, stage}}, assembly, state, rows);
  ASSERT_EQ(rows.turns.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR_BECAUSE(rows.turns[k], k % 2 ? 5e3 : 95e3, 500, "the overshoot of a reversal, some 100 Pa");
  EXPECT_LT(state.undrained.worst_overshoot, 500);
  EXPECT_GE(state.undrained.worst_overshoot, 0);
  EXPECT_FALSE(reverses_stress(state.undrained.response));
}
} // namespace
} // namespace isostat

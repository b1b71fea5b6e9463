// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/element/rve_element.hpp"

#include "tests/coupling/rve_column.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using test::simple_shear;

RveElement element(bool undrained, unsigned halvings = 6)
{
  return {Rve(test::soft_specimen(4), {}), {{}, undrained, halvings}};
}
} // namespace

TEST(RveElement, EachTrialStartsFromTheCommittedState)
{
  RveElement tried = element(true), straight = element(true);
  for (int k = 0; k < 80; ++k) // beyond the 500 steps after which the way back is shortened
    {
      const Mat3 h = simple_shear(2e-5 * std::sin(0.9 * k));
      tried.trial(simple_shear(1e-4));
      EXPECT_EQ(tried.trial(h).stress, straight.trial(h).stress) << k;
      tried.commit(), straight.commit();
    }
  EXPECT_GT(straight.rve().assembly().step(), 500u);
  EXPECT_EQ(tried.pack(), straight.pack());
}

TEST(RveElement, TrialsLeaveNoTraceWhereTheCellIsExchangedForOthersOfItsLattice)
{
  // 70 grains sheared by 180 %; once it leans their cell is narrower than two of them, but no two images are as near
  test::CellRecipe recipe = test::soft_recipe(4, 100e3);
  recipe.grading = test::small_grading(70);
  RveSettings settings;
  settings.motion.strain_rate = 100;
  settings.max_increment = 0.05;
  const ElementSettings how = {settings, true, 6};
  RveElement tried(Rve(test::prepare_in_cell(recipe), settings), how);
  RveElement straight = tried;
  std::uint64_t flips = 0;
  int trials_through_a_flip = 0;
  double narrowest = HUGE_VAL;
  const Assembly &now = tried.rve().assembly();
  for (int k = 0; k < 90; ++k)
    {
      tried.trial(simple_shear(0.03)); // also through every flip that comes next
      trials_through_a_flip += now.cell()->flips != flips;
      if (k % 3 == 0)
        {
          tried.rollback();
          ASSERT_EQ(now.cell()->flips, flips);
        }
      const ElementTrial got = tried.trial(simple_shear(0.02)), expected = straight.trial(simple_shear(0.02));
      ASSERT_TRUE(expected.accepted) << expected.reason;
      ASSERT_EQ(got.stress, expected.stress) << k;
      tried.commit(), straight.commit();
      flips = now.cell()->flips;
      narrowest = std::min(narrowest, now.cell()->widths().minCoeff() / (2 * now.packing().max_radius()));
    }
  EXPECT_GE(flips, 2u);
  EXPECT_GE(trials_through_a_flip, 2);
  EXPECT_LT(narrowest, 2);
  EXPECT_EQ(tried.pack(), straight.pack());
}

TEST(RveElement, RollbackLeavesNoTrace)
{
  RveElement tried = element(true), straight = element(true);
  tried.trial(simple_shear(1e-4));
  EXPECT_NE(tried.rve().stress(), straight.rve().stress());
  tried.rollback();
  EXPECT_EQ(tried.rve().stress(), straight.rve().stress());
  tried.commit(); // nothing to commit
  EXPECT_EQ(tried.pack(), straight.pack());
}

TEST(RveElement, ItsCommittedStateIsMeasuredDuringATrial)
{
  RveElement tried = element(true);
  const Mat3 committed = tried.rve().stress();
  const Mat3 stress = tried.trial(simple_shear(1e-4)).stress;
  EXPECT_EQ(tried.at_committed([](const Rve &rve) { return rve.stress(); }), committed);
  EXPECT_EQ(tried.rve().stress(), stress);
}

TEST(RveElement, RejectedIncrementsAreTakenInParts)
{
  RveElement tried = element(false);
  Rve alone(test::soft_specimen(4), {});
  const Mat3 large = simple_shear(0.03); // beyond what an element takes at once
  const Mat3 stress = tried.trial(large).stress;
  for (int k = 0; k < 4; ++k)
    alone.advance(Mat3(large / 4)); // simple shear: powers of H vanish
  EXPECT_EQ(stress, alone.stress());
  tried.trial(simple_shear(1e-5));
  EXPECT_EQ(tried.trial(large).stress, stress);
}

TEST(RveElement, SaysWhatItCannotTake)
{
  RveElement tried = element(true, 1);
  const ElementTrial trial = tried.trial(simple_shear(0.9));
  EXPECT_FALSE(trial.accepted);
  EXPECT_THAT(trial.reason,
              testing::StartsWith("an increment of displacement gradient of 0.9 cannot be applied, even in 2 "));
  EXPECT_FALSE(tried.trial(simple_shear(std::nan(""))).accepted);
  EXPECT_TRUE(tried.trial(simple_shear(1e-5)).accepted);
}
} // namespace isostat

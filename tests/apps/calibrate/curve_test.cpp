// SPDX-License-Identifier: BSD-3-Clause
// Where curves are compared, and the misfit.
#include "apps/calibrate/curve.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr test::Tolerance round_off{1e-12, "round-off of some ten operations"};

TEST(ComparedStrains, BeginWithTheLaboratory)
{
  PlanCurve plan;
  plan.strain_end = 0.04;
  const Curve curve{{0.011, 0.04}, {1, 2}, {1, 2}};
  MisfitSettings settings;
  settings.points = 4;
  EXPECT_THAT(compared_strains(curve, plan, settings), testing::ElementsAre(0.02, 0.03, 0.04));
  settings.spacing = StrainSpacing::quadratic;
  EXPECT_THAT(compared_strains(curve, plan, settings), testing::ElementsAre(0.0225, 0.04));
}

TEST(Misfit, OfEqualCurvesIsZero)
{
  PlanCurve plan;
  const Curve curve{{0, 0.05, 0.1}, {0, 3, 4}, {0, -0.01, -0.03}};
  const Comparison same = compare(curve, {curve, curve}, plan, {});
  EXPECT_EQ(same.misfit, 0);
  EXPECT_EQ(same.scatter, std::optional(0.0));
  EXPECT_FALSE(compare(curve, {curve}, plan, {}).scatter);
}

/// q is off by a tenth of its scale throughout, the volumetric strain by nothing: sqrt((0.01 + 0)/2).
TEST(Misfit, IsTheShareOfTheLargestValue)
{
  PlanCurve plan;
  const Curve laboratory{{0, 0.1}, {10, 20}, {0.01, 0.04}}, model{{0, 0.1}, {12, 22}, {0.01, 0.04}};
  EXPECT_NEAR_BECAUSE(compare(laboratory, {model}, plan, {}).misfit, 0.1 / std::sqrt(2.0), round_off);
}

/// Two models one scale above and below: their mean is the laboratory's curve, its standard error the scale.
TEST(Misfit, TakesTheMeanOverSeeds)
{
  PlanCurve plan;
  const Curve laboratory{{0, 0.1}, {1, 1}, {1, 1}};
  const Curve above{{0, 0.1}, {2, 2}, {2, 2}}, below{{0, 0.1}, {0, 0}, {0, 0}};
  const Comparison result = compare(laboratory, {above, below}, plan, {});
  EXPECT_NEAR_BECAUSE(result.misfit, 0, round_off);
  EXPECT_NEAR_BECAUSE(result.scatter.value(), 1, round_off);
  EXPECT_NEAR_BECAUSE(result.deviation.q[0], std::sqrt(2.0), round_off);
}

TEST(Misfit, RefusesWhatCannotBeCompared)
{
  PlanCurve plan;
  plan.path = "lab.csv";
  const Curve flat{{0, 0.1}, {0, 0}, {1, 1}}, good{{0, 0.1}, {1, 2}, {1, 1}}, shorter{{0, 0.05}, {1, 2}, {1, 1}};
  test::expect_parts(test::refusal([&] { compare(flat, {good}, plan, {}); }), {"lab.csv", "q is zero throughout"});
  test::expect_parts(test::refusal([&] { compare(good, {shorter}, plan, {}); }), {"ended at a strain of 0.05", "0.1"});
}

TEST(Misfit, OfATrialIsWeightedAndLeavesOutBlindCurves)
{
  std::vector<PlanCurve> plan(3);
  plan[0].weight = 3;
  plan[2].blind = true;
  EXPECT_NEAR_BECAUSE(total_misfit({0.1, 0.2, 9}, plan), std::sqrt((3 * 0.01 + 0.04) / 4), round_off);
}
} // namespace
} // namespace isostat

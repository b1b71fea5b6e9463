// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/strength.hpp"

#include "tests/support/near.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
TEST(FrictionAngle, IsThatOfThePrincipalStresses)
{
  for (const double ratio : {3.0, 2.0, 1.0}) // s1/s3, phi = asin((r - 1)/(r + 1))
    {
      const double expected = 180 / M_PI * std::asin((ratio - 1) / (ratio + 1));
      const double compression = (ratio - 1) / ((ratio + 2) / 3), extension = -(ratio - 1) / ((2 * ratio + 1) / 3);
      EXPECT_NEAR_BECAUSE(friction_angle(compression), expected, 1e-12, "round-off");
      EXPECT_NEAR_BECAUSE(friction_angle(extension), expected, 1e-12, "round-off");
    }
}

TEST(DilatancyAngle, OfSimpleCases)
{
  EXPECT_EQ(dilatancy_angle(0), 0);
  EXPECT_NEAR_BECAUSE(dilatancy_angle(2), 30, 1e-12, "round-off"); // D = 2: sin psi = 1/2
  EXPECT_NEAR_BECAUSE(dilatancy_angle(-0.5), -180 / M_PI * std::asin(1 / 3.0), 1e-12, "round-off");
}

/// A peak of q/p' at 2 % and a volume that contracts by 0.1 % to 1 % of strain, then grows along a line of slope 0.6.
DrainedPath with_peak(double sign)
{
  DrainedPath path;
  for (int k = 0; k <= 1000; ++k)
    {
      const double e = 1e-4 * k;
      path.axial.push_back(sign * e);
      path.volumetric.push_back(e <= 0.01 ? 0.2 * e - 10 * e * e : 0.001 - 0.6 * (e - 0.01));
      path.stress_ratio.push_back(sign * (e <= 0.02 ? 1.4 * e / 0.02 : 1 + 0.4 * std::exp((0.02 - e) / 0.01)));
    }
  return path;
}

TEST(DrainedStrength, OfAPathWithAPeak)
{
  const DrainedStrength found = drained_strength(with_peak(1));
  EXPECT_NEAR_BECAUSE(found.peak_ratio, 1.4, 0.02, "a mean over 0.1 % of strain of a peak that is sharp");
  EXPECT_NEAR_BECAUSE(found.peak_strain, 0.02, 5e-4, "the mean of a sharp peak");
  EXPECT_NEAR_BECAUSE(found.peak_friction, friction_angle(1.4), 0.4, "0.02 in q/p'");
  EXPECT_NEAR_BECAUSE(found.end_friction, friction_angle(1 + 0.4 * std::exp(-8)), 0.01, "it still falls by 1e-4");
  EXPECT_DOUBLE_EQ(found.most_contracted, 0.001);
  EXPECT_NEAR_BECAUSE(found.contracted_strain, 0.01, 1e-12, "round-off");
  EXPECT_NEAR_BECAUSE(found.end_volumetric, 0.001 - 0.6 * 0.09, 1e-12, "round-off");
  EXPECT_NEAR_BECAUSE(found.dilatancy_rate, 0.6, 1e-9, "least squares of a line");
  ASSERT_TRUE(found.dilatancy);
  EXPECT_NEAR_BECAUSE(*found.dilatancy, 180 / M_PI * std::asin(0.6 / 2.6), 1e-7, "least squares of a line");
}

TEST(DrainedStrength, OfExtensionCountsAmounts)
{
  const DrainedStrength found = drained_strength(with_peak(-1));
  EXPECT_NEAR_BECAUSE(found.peak_ratio, -1.4, 0.02, "a mean over 0.1 % of strain of a peak that is sharp");
  EXPECT_NEAR_BECAUSE(found.dilatancy_rate, 0.6, 1e-9, "least squares of a line");
  EXPECT_FALSE(found.dilatancy);
}

TEST(DrainedStrength, OfTooFewRowsIsNothing)
{
  EXPECT_EQ(drained_strength({}).peak_ratio, 0);
  EXPECT_EQ(drained_strength({{0.1}, {0}, {1}}).peak_friction, 0);
  EXPECT_DOUBLE_EQ(drained_strength({{0, 0.1}, {0, -0.01}, {0, 1}}).dilatancy_rate, 0.1);
}
} // namespace
} // namespace isostat

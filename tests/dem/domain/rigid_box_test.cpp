// SPDX-License-Identifier: BSD-3-Clause
#include "dem/domain/rigid_box.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
TEST(RigidBox, VolumeStaysToRoundOffOverAMillionSteps)
{
  const RigidBox reference{Vec3(0.1, -0.2, 0.3), Vec3(8.1, 7.9, 8.4)};
  const double volume = reference.volume();
  double axial = 0, worst = 0;
  for (int k = 0; k < 1'000'000; ++k)
    {
      axial += (k / 50'000) % 2 ? -3.3e-7 : 4.1e-7;
      worst = std::max(worst, std::abs(reference.strained(isochoric(axial)).volume() / volume - 1));
    }
  EXPECT_BELOW_BECAUSE(worst, 1e-12, "round-off of three exponentials, whatever the number of steps");
}

TEST(RigidBox, IsochoricStrainSumsToExactlyZero)
{
  for (const double axial : {1e-7, 0.123456789, -3.3e-3})
    EXPECT_EQ(isochoric(axial).sum(), 0.0);
}

TEST(RigidBox, EdgesFollowTheLogarithmicStrainAboutTheCentre)
{
  const RigidBox reference{Vec3(-1, 0, 2), Vec3(1, 4, 3)};
  const RigidBox box = reference.strained({0.1, -0.2, 0.3});
  EXPECT_NEAR_BECAUSE(box.edges()[0], 2 * std::exp(0.1), 1e-15, "round-off of an exponential and a product");
  EXPECT_NEAR_BECAUSE(box.edges()[1], 4 * std::exp(-0.2), 1e-15, "round-off of an exponential and a product");
  EXPECT_NEAR_BECAUSE(box.edges()[2], 1 * std::exp(0.3), 1e-15, "round-off of an exponential and a product");
  EXPECT_NEAR_BECAUSE((box.centre() - reference.centre()).norm(), 0, 1e-15, "round-off of a mean of two");
}
} // namespace
} // namespace isostat

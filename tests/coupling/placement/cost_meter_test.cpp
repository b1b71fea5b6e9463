// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/placement/cost_meter.hpp"

#include "tests/support/near.hpp"

namespace isostat
{
TEST(CostMeter, IsARunningMeanThatBeginsWithTheFirstTrial)
{
  CostMeter meter(2);
  EXPECT_THAT(meter.means(), testing::ElementsAre(1, 1));
  meter.add_trial(std::vector{4.0, 2.0});
  EXPECT_THAT(meter.means(), testing::ElementsAre(4, 2));
  meter.add_trial(std::vector{4.0, 12.0});
  EXPECT_THAT(meter.means(), testing::ElementsAre(4, 3));
  for (int k = 0; k < 50; ++k)
    meter.add_trial(std::vector{1.0, 1.0});
  EXPECT_NEAR_BECAUSE(meter.means()[0], 1, 0.02, "3 * 0.9^50 = 0.015 of the start are left");
}
} // namespace isostat

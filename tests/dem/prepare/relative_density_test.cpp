// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/relative_density.hpp"

#include <gmock/gmock.h>
#include <limits>

namespace isostat
{
TEST(RelativeDensity, IsRemarkedOnFarBeyondItsLimits)
{
  for (const double usual : {-0.1, 0.0, 0.5, 1.0, 1.1, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(density_remark(usual), "");
  EXPECT_THAT(density_remark(-0.5), testing::HasSubstr("far looser than e_max"));
  EXPECT_THAT(density_remark(1.3), testing::HasSubstr("far denser than e_min"));
}
} // namespace isostat

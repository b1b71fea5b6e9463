// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/soil.hpp"
#include "tests/support/near.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
/// From the surface down: 1 m of silt, 5 m of sand, 4 m of gravel.
SoilProfile three_layers()
{
  SoilProfile soil;
  soil.layers = {{"silt", 1, 1800}, {"sand", 5, 2000}, {"gravel", 4, 2200}};
  soil.water.gravity = 10;
  return soil;
}

TEST(SoilProfile, HeightAndLayers)
{
  const SoilProfile soil = three_layers();
  EXPECT_EQ(soil.height(), 10);
  EXPECT_EQ(soil.layer_at(0), 2u);
  EXPECT_EQ(soil.layer_at(3.999), 2u);
  EXPECT_EQ(soil.layer_at(4), 1u); // the upper one on an interface
  EXPECT_EQ(soil.layer_at(9), 0u);
  EXPECT_EQ(soil.layer_at(10), 0u);
  EXPECT_EQ(soil.layer_at(-1), 2u); // outside: the nearest
  EXPECT_EQ(soil.layer_at(11), 0u);
}

TEST(SoilProfile, EffectiveStressByHand)
{
  const SoilProfile soil = three_layers(); // submerged unit weights 12, 10, 8 kN/m3
  const struct
  {
    double z, stress;
  } points[] = {{11, 0}, {10, 0}, {9.5, 4e3}, {9, 8e3}, {6.5, 33e3}, {4, 58e3}, {1, 94e3}, {0, 106e3}};
  for (const auto &[z, stress] : points)
    {
      EXPECT_NEAR_BECAUSE(soil.vertical_effective_stress(z), stress, 1e-9, "round-off of sums of 1e5 Pa") << z;
      EXPECT_NEAR_BECAUSE(soil.vertical_effective_stress(z, 20e3), stress + 20e3, 1e-9, "round-off of sums of 1e5 Pa")
          << z;
    }
}

TEST(SoilProfile, EffectiveStressIsContinuousAndItsSlopeIsTheSubmergedWeight)
{
  const SoilProfile soil = three_layers();
  const double step = 1e-3;
  for (double z = step / 2; z < 10 - step; z += step)
    {
      const double slope = (soil.vertical_effective_stress(z) - soil.vertical_effective_stress(z + step)) / step;
      const double low = soil.layers[soil.layer_at(z)].density, high = soil.layers[soil.layer_at(z + step)].density;
      EXPECT_BELOW_BECAUSE(slope, (std::max(low, high) - 1000) * 10 + 1e-5,
                           "round-off of a difference of 1e5 Pa over a step of 1 mm")
          << z;
      EXPECT_GE(slope, (std::min(low, high) - 1000) * 10 - 1e-5) << z;
    }
}

/// By hand, gravity 10: a slope with tan = 3/4, so that sin = 0.6 and cos = 0.8.
TEST(SoilProfile, StaticsOfTheInfiniteSlopeByHand)
{
  SoilProfile soil = three_layers();
  soil.slope.tangent = 0.75;
  constexpr test::Tolerance exact{1e-9, "round-off of sums of 1e5 Pa"};
  const auto expect = [&](double z, double normal, double shear, double surcharge = 0) {
    const PlaneStress stress = soil.in_situ(z, surcharge);
    EXPECT_NEAR_BECAUSE(stress.normal, normal, exact) << z;
    EXPECT_NEAR_BECAUSE(stress.shear, shear, exact) << z;
  };
  expect(9, 0.8 * 8e3, 0.6 * 18e3); // seepage: buoyancy across the slope only
  expect(4, 0.8 * 58e3, 0.6 * 118e3);
  expect(0, 0.8 * 106e3, 0.6 * 206e3);
  expect(4, 0.8 * 78e3, 0.6 * 138e3, 20e3); // a surcharge is vertical
  soil.water_table = 3;                     // 1 m of silt and 2 m of sand are not under water
  expect(9, 0.8 * 18e3, 0.6 * 18e3);
  expect(7.5, 0.8 * 48e3, 0.6 * 48e3);
  expect(7, 0.8 * 58e3, 0.6 * 58e3);
  expect(4, 0.8 * 88e3, 0.6 * 118e3);
  expect(0, 0.8 * 136e3, 0.6 * 206e3);
  EXPECT_TRUE(soil.is_wet(6.9));
  EXPECT_FALSE(soil.is_wet(7.1));
  soil.water_table = 0;
  soil.slope.water = SlopeWater::submerged; // buoyancy is vertical: as dry soil of its submerged weight
  expect(4, 0.8 * 58e3, 0.6 * 58e3);
  expect(0, 0.8 * 106e3, 0.6 * 106e3);
}

TEST(SoilProfile, LevelGroundCarriesNoShearAndATableIsAboutBuoyancyOnly)
{
  SoilProfile soil = three_layers();
  EXPECT_EQ(soil.in_situ(4, 1e3).shear, 0);
  soil.water_table = 3;
  EXPECT_NEAR_BECAUSE(soil.vertical_effective_stress(0), 206e3 - 7 * 10e3, 1e-9,
                      "total weight minus the hydrostatic pressure of 7 m");
}

TEST(Water, Mobility)
{
  Water water;
  water.density = 998;
  water.gravity = 9.8;
  EXPECT_DOUBLE_EQ(water.mobility(1e-4), 1e-4 / (998 * 9.8));
  EXPECT_EQ(water.mobility(0), 0);
}
} // namespace
} // namespace isostat

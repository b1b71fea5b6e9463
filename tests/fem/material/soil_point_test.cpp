// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/soil_point.hpp"

#include "base/error.hpp"
#include "fem/material/elastic.hpp"
#include "fem/material/mohr_coulomb.hpp"
#include "tests/fem/material/iwan_sample.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr Stress k0_stress{-50e3, -50e3, -100e3, 0, 0, 0}, isotropic{-p0, -p0, -p0, 0, 0, 0};
constexpr test::Tolerance landing{1.1e-5, "shear_to() ends within 1e-5 of the vertical stress"};
constexpr double far = std::numeric_limits<double>::infinity();

SoilPoint elastic() { return {std::make_unique<Elastic>(ElasticParameters{50e6, 0.25}, 1), k0_stress}; }

TEST(SoilPoint, ElasticSoilHasItsModuli)
{
  SoilPoint point = elastic();
  EXPECT_DOUBLE_EQ(point.shear_modulus(), 50e6);
  EXPECT_TRUE(point.shear_to(20e3, true, far));
  EXPECT_NEAR_BECAUSE(point.stress()[4], 20e3, 100e3 * landing);
  EXPECT_CLOSE_BECAUSE(point.strain()[4], point.stress()[4] / 50e6, 1e-12, "round-off of 20 steps");
  point.compress_to(250e3);
  // M = 2 G (1 - nu)/(1 - 2 nu) = 3 G
  EXPECT_NEAR_BECAUSE(point.row()[4], 150e3 / 150e6, 250e3 / 150e6 * landing);
  point.compress_to(100e3);
  EXPECT_NEAR_BECAUSE(point.row()[4], 0, 250e3 / 150e6 * landing);
  EXPECT_EQ(point.cyclic_shear(20e3, 3).to_liquefaction, far);
  EXPECT_FALSE(point.shear_to(1e9, true, 1e-3));
  EXPECT_NEAR_BECAUSE(point.strain()[4], 1e-3, 2e-5, "a step");
}

TEST(SoilPoint, DrainedShearKeepsTheVerticalStress)
{
  SoilPoint sand(std::make_unique<Iwan>(loose, 1), k0_stress);
  const MohrCoulombParameters friction{.cohesion = 0, .dilatancy = 0};
  SoilPoint plastic(std::make_unique<MohrCoulomb>(friction, 1), k0_stress);
  for (SoilPoint *point : {&sand, &plastic})
    {
      std::vector<SoilPoint::Row> path;
      point->shear(0.02, 200, true, &path);
      ASSERT_EQ(path.size(), 200u);
      for (const SoilPoint::Row &row : path)
        EXPECT_CLOSE_BECAUSE(row[2], 100e3, 1e-5, "the error of a step is 1e-6");
    }
  EXPECT_GT(sand.row()[4], 0); // loose sand contracts
  // sigma'_v sin(phi) cos(psi)/(1 - sin(phi) sin(psi)) in simple shear (Davis 1968), with psi = 0
  EXPECT_CLOSE_BECAUSE(plastic.stress()[4], 100e3 * std::sin(std::atan(friction.friction)), 1e-4,
                       "the vertical stress has an error of 1e-6 in each of 200 steps");
}

TEST(SoilPoint, SandWithoutDilatancyFollowsTheHyperbola)
{
  SoilPoint point(std::make_unique<Iwan>(dry(), 1), isotropic);
  const double strength = dry().strength_ratio * p0;
  for (double x : {0.1, 0.5, 1.0, 3.0})
    {
      EXPECT_TRUE(point.shear_to(strength * x / (1 + x), true, far));
      EXPECT_CLOSE_BECAUSE(point.strain()[4], x * strength / dry().shear_modulus, 0.06,
                           "twelve elements are within 1.8 % of tau, with dgamma/gamma = (1 + x) dtau/tau");
    }
}

TEST(SoilPoint, CyclesCountHalfCyclesByTheirStress)
{
  SoilPoint point(std::make_unique<Iwan>(loose, 1), isotropic), longer(std::make_unique<Iwan>(loose, 1), isotropic);
  std::vector<SoilPoint::Row> path;
  const SoilPoint::Cycles cycles = point.cyclic_shear(0.15 * p0, 100, 0, &path);
  Sample sample(loose);
  EXPECT_NEAR_BECAUSE(cycles.to_liquefaction, shake(sample, 0.15).cycles, 1,
                      "that test counts whole half cycles, and p' instead of sigma'_v");
  const auto ratio = [](const SoilPoint::Row &row) { return 1 - row[2] / p0; };
  EXPECT_TRUE(std::any_of(path.begin(), path.end(), [&](const auto &row) { return ratio(row) >= 0.95; }));
  EXPECT_GT(longer.cyclic_shear(0.15 * p0, 100, 2).largest_strain, cycles.largest_strain);
  SoilPoint weak(std::make_unique<Iwan>(loose, 1),
                 isotropic); // tau is above the strength: 3 % comes in the first quarter
  EXPECT_BELOW_BECAUSE(weak.cyclic_shear(0.99 * p0, 100).to_liquefaction, 0.25, "a quarter");
  EXPECT_THROW(SoilPoint(std::make_unique<Iwan>(loose, 1), Stress{}), InputError);
}
} // namespace
} // namespace isostat

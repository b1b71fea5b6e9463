// SPDX-License-Identifier: BSD-3-Clause
// Sloping ground and water tables of a column's scene: which slopes are stable, and what is refused.
#include "apps/deposit/slope.hpp"

#include "tests/apps/deposit/scene_texts.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double degree = std::numbers::pi / 180;

std::string slope(const std::string &angle, const std::string &more = "")
{
  return "[slope]\nangle = \"" + angle + " deg\"\n" + more;
}

const std::string wet_sand = sand + "permeability = \"1e-5 m/s\"\n";

TEST(SlopeScene, KeysComeThroughTextAndGoToTheSoil)
{
  const ColumnScene scene =
      parse_column_scene(wet_sand + "[water]\ntable = \"2 m\"\n" + slope("4", "water = \"seepage\"\n") + dynamic, "s");
  EXPECT_EQ(parse_column_scene(to_toml(scene), "again"), scene);
  const SoilProfile soil = soil_profile(scene);
  EXPECT_EQ(soil.water_table, 2);
  EXPECT_NEAR_BECAUSE(soil.slope.tangent, std::tan(4 * degree), 1e-15, "round-off");
  const ColumnScene level = parse_column_scene(wet_sand + dynamic, "s");
  EXPECT_EQ(level.slope, Slope{});
  EXPECT_EQ(level.water.table, 0);
}

TEST(SlopeScene, FactorOfSafetyOfTheInfiniteSlope)
{
  const std::string loose = sand + "k0 = 1.0\nstrength_ratio = 0.6\n"; // tan(phi) of simple shear
  const auto factor = [](const std::string &text) { return slope_safety(parse_column_scene(text, "s"))->factor; };
  constexpr test::Tolerance exact{1e-12, "round-off of a closed form"};
  const double tangent = std::tan(10 * degree);
  EXPECT_NEAR_BECAUSE(factor(loose + dry + slope("10") + dynamic), 0.6 / tangent, exact);
  EXPECT_NEAR_BECAUSE(factor(loose + undrained + slope("10", "water = \"submerged\"\n") + dynamic), 0.6 / tangent,
                      exact);
  // seepage parallel to a surface that the water reaches: gamma'/gamma tan(phi)/tan(angle)
  EXPECT_NEAR_BECAUSE(factor(loose + undrained + slope("10") + dynamic), 0.5 * 0.6 / tangent, exact);
  const ColumnScene deep = parse_column_scene(
      loose + "permeability = \"1e-5 m/s\"\n[water]\ntable = \"2 m\"\n" + slope("10") + dynamic, "s");
  const SlopeSafety safety = *slope_safety(deep); // 5 m of 2000 kg/m3, water in the lower 3 m: 1 - 3/5 1000/2000
  EXPECT_NEAR_BECAUSE(safety.factor, 0.7 * 0.6 / tangent, exact);
  EXPECT_EQ(safety.depth, 5);
  // in addition to a deviator of k0 = 0.5, sqrt(0.6^2 (2/3)^2 - 0.25/3) of the normal stress is left
  EXPECT_NEAR_BECAUSE(factor(sand + "k0 = 0.5\nstrength_ratio = 0.6\n" + dry + slope("10") + dynamic),
                      std::sqrt(0.16 - 0.25 / 3) / tangent, exact);
  // Mohr-Coulomb at k0 = 1: its circle has the radius sin(phi) of the normal stress, and a cohesion adds c cos(phi)
  const std::string frictional = "[[layer]]\nthickness = \"5 m\"\nmaterial = \"mohr_coulomb\"\nshear_velocity = \"200 "
                                 "m/s\"\ncells = 5\nk0 = 1.0\ndilatancy_angle = \"0 deg\"\n";
  EXPECT_NEAR_BECAUSE(
      factor(frictional + "friction_angle = \"30 deg\"\ncohesion = \"0 kPa\"\n" + dry + slope("10") + dynamic),
      0.5 / tangent, exact);
  const double weight = 5 * 2000 * 9.81; // at the base, where cohesion helps least
  EXPECT_NEAR_BECAUSE(
      factor(frictional + "friction_angle = \"30 deg\"\ncohesion = \"10 kPa\"\n" + dry + slope("10") + dynamic),
      (0.5 + 10e3 * std::cos(30 * degree) / (weight * std::cos(10 * degree))) / tangent, exact);
  EXPECT_FALSE(slope_safety(parse_column_scene(loose + dry + dynamic, "level")));
  EXPECT_FALSE(slope_safety(parse_column_scene(layer + dry + slope("10") + dynamic, "elastic")));
}

TEST(SlopeScene, SlopesThatFallAreRefused)
{
  const std::string loose = sand + "k0 = 1.0\nstrength_ratio = 0.6\n";
  expect_refused(
      loose + dry + slope("31") + dynamic,
      {"column.toml:7: layer.0.strength_ratio = 0.6; is too low for a stable slope", "depth of 5 m", "slope.angle"});
  EXPECT_NO_THROW(parse_column_scene(loose + dry + slope("30.9") + dynamic, "s")); // tan = 0.5985
  expect_refused(loose + undrained + slope("17") + dynamic, {"static shear stress is", "k0 = 1"});
  EXPECT_NO_THROW(parse_column_scene(loose + undrained + slope("16.6") + dynamic, "s")); // tan = 0.298
  // in addition to a deviator of k0 = 0.5: tan = 0.2769
  expect_refused(sand + "k0 = 0.5\nstrength_ratio = 0.6\n" + dry + slope("15.5") + dynamic, {"k0 = 0.5"});
  EXPECT_NO_THROW(parse_column_scene(sand + "k0 = 0.5\nstrength_ratio = 0.6\n" + dry + slope("15.4") + dynamic, "s"));
  expect_refused("[[layer]]\nthickness = \"5 m\"\nmaterial = \"mohr_coulomb\"\nshear_velocity = \"200 "
                 "m/s\"\ncells = 5\nfriction_angle = \"30 deg\"\ncohesion = \"0 kPa\"\n" +
                     dry + slope("29") + dynamic,
                 {"column.toml:6: layer.0.friction_angle = 30 deg; is too low for a stable slope", "k0 = 0.5"});
  expect_refused(loose + dry + slope("61") + dynamic,
                 {"slope.angle", "in [0 deg, 60 deg] because x points down", "no slope of soil is steeper"});
  expect_refused(loose + dry + slope("-1") + dynamic, {"slope.angle", "in [0 deg, 60 deg]"});
}

TEST(SlopeScene, PackingsThatNoFrictionHoldsAreRefused)
{
  const std::string packings = "[[layer]]\nname = \"sand\"\nthickness = \"5 m\"\nmaterial = \"grains\"\ncells = 5\n"
                               "[grains]\nlibrary = \"none.h5\"\n";
  const auto expect_limit = [&](const std::string &more, double angle, const Overrides &overrides = {}) {
    const auto text = [&](double a) { return packings + more + slope(std::to_string(a)) + dynamic; };
    expect_refused(text(angle + 0.05),
                   {"slope.angle", "layer.0 (sand)", "at a depth of 5 m", "friction angle of 60",
                    "no packing carries more than 60 deg"},
                   overrides);
    EXPECT_NO_THROW(parse_column_scene(text(angle - 0.05), "s", overrides));
  };
  // sin(60 deg) is the radius of Mohr's circle over its centre
  const double sine = std::sqrt(0.75), level = std::sqrt(std::pow(0.75 * sine, 2) - 0.0625); // k0 = 0.5
  expect_limit(dry, std::atan(level) / degree);
  expect_limit(dry, std::atan(sine) / degree, {"layer.0.k0=1"});
  expect_limit(undrained, std::atan(0.5 * sine) / degree, {"layer.0.k0=1"}); // seepage: gamma'/gamma
  expect_limit(undrained, std::atan(0.5 * std::tan(60 * degree)) / degree, {"grains.in_situ=no-lateral-strain"});
}

TEST(SlopeScene, WaterTablesThatAreRefused)
{
  const auto table = [](const std::string &depth) { return "[water]\ntable = \"" + depth + " m\"\n"; };
  EXPECT_NO_THROW(parse_column_scene(wet_sand + table("2") + dynamic, "s"));
  expect_refused(wet_sand + table("2.3") + dynamic, {"column.toml:8: water.table = 2.3 m", "nearest is at 2 m"});
  expect_refused(wet_sand + table("5") + dynamic, {"less than the height of the soil, 5 m", "\"dry\""});
  expect_refused(wet_sand + table("-1") + dynamic, {"water.table", ">= 0 m"});
  expect_refused(wet_sand + table("2") + dynamic, {"has no meaning", "\"dry\"", "\"coupled\""}, {"water.drainage=dry"});
  EXPECT_NO_THROW(parse_column_scene(wet_sand + table("2") + dynamic, "s", {"water.drainage=undrained"}));
  expect_refused("[[layer]]\nthickness = \"5 m\"\nmaterial = \"grains\"\ncells = 5\n[grains]\nlibrary = \"a.h5\"\n" +
                     table("2") + dynamic,
                 {"must not be below the top of packings", "\"coupled\""}, {"water.drainage=undrained"});
  expect_refused(wet_sand + table("2") + slope("4", "water = \"submerged\"\n") + dynamic,
                 {"must be 0 m if slope.water is \"submerged\""});
  // light soil may lie above the table, not below it
  EXPECT_NO_THROW(
      parse_column_scene("[[layer]]\nthickness = \"2 m\"\ncells = 2\nmaterial = \"elastic\"\n"
                         "shear_velocity = \"100 m/s\"\ndensity = \"900 kg/m3\"\npermeability = \"0 m/s\"\n" +
                             wet_sand + table("2") + dynamic,
                         "s"));
  expect_refused(wet_sand + "density = \"900 kg/m3\"\n" + table("2") + dynamic, {"floats away"});
  expect_refused("[[layer]]\nthickness = \"2 m\"\ncells = 2\nmaterial = \"elastic\"\nsaturation = 0.9\n"
                 "shear_velocity = \"100 m/s\"\npermeability = \"0 m/s\"\n" +
                     wet_sand + table("2") + dynamic,
                 {"column.toml:5: layer.0.saturation = 0.9; has no effect above the water table"});
}
} // namespace
} // namespace isostat

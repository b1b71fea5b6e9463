// SPDX-License-Identifier: BSD-3-Clause
// What is possible in a scene but odd: one claim for each warning.
#include "apps/deposit/plausible.hpp"

#include "tests/apps/deposit/scene_texts.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
const std::string two = layer + layer + dry + dynamic;

void expect_warning(const std::string &text, const Overrides &overrides, const std::vector<std::string> &parts)
{
  const std::vector<std::string> warnings = profile_warnings(parse_column_scene(text, "s", overrides));
  ASSERT_EQ(warnings.size(), 1u);
  test::expect_parts(warnings[0], parts);
}

TEST(Plausible, Profiles)
{
  EXPECT_TRUE(profile_warnings(parse_column_scene(two, "s")).empty());
  expect_warning(two, {"layer.0.shear_velocity=20 m/s", "layer.0.name=mud"},
                 {"layer.0.shear_velocity gives layer.0 (mud)", "20 m/s", "30 to 1500 m/s", "unit"});
  expect_warning(two, {"layer.0.shear_modulus=50 kPa"}, {"layer.0.shear_modulus", "of 5 m/s"});
  expect_warning(two, {"layer.1.shear_velocity=2000 m/s"}, {"layer.1.shear_velocity", "2000 m/s"});
  expect_warning(two, {"layer.1.shear_velocity=60 m/s"},
                 {"3.3 times as fast in layer.0 as in layer.1 below it (200 and 60 m/s in situ)", "at most 3 times"});
  expect_warning(two, {"base={ kind = 'compliant', density = '2300 kg/m3', shear_velocity = '150 m/s' }"},
                 {"base.shear_velocity = 150 m/s is below", "200 m/s"});
}

TEST(Plausible, Motions)
{
  ColumnScene scene = parse_column_scene(
      smallest + "[[motion]]\nkind = \"record\"\nfile = \"a.txt\"\n[[motion]]\naxis = \"y\"\nkind = \"ricker\"\n"
                 "amplitude = \"1 g\"\nfrequency = \"2 Hz\"\n",
      "s");
  const auto warnings = [&](double peak, double interval) {
    return motion_size_warnings(scene, {Motion({0, peak, 0}, interval), Motion({0, peak, 0}, 0.05), Motion()});
  };
  EXPECT_TRUE(warnings(20, 0.02).empty());
  ASSERT_EQ(warnings(45, 0.02).size(), 2u);
  test::expect_parts(warnings(45, 0.02)[0], {"motion.0", "4.59 g", "below 3 g", "unit"});
  test::expect_parts(warnings(45, 0.02)[1], {"motion.1", "amplitude"});
  ASSERT_EQ(warnings(20, 0.05).size(), 1u);
  test::expect_parts(warnings(20, 0.05)[0], {"motion.0", "0.05 s apart", "above 10 Hz", "highest_frequency is 25 Hz"});
}
} // namespace
} // namespace isostat

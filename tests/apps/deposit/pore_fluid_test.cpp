// SPDX-License-Identifier: BSD-3-Clause
// What a column's scene says of its pore fluid, air in it and how it flows, and what of it is refused.
#include "apps/deposit/scene.hpp"
#include "tests/apps/deposit/scene_texts.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
const std::string coupled = layer + "permeability = \"1e-5 m/s\"\n" + dynamic; // lines 1 to 8

void expect_overrides_refused(const std::string &text, const Overrides &overrides,
                              const std::vector<std::string> &parts)
{
  test::expect_parts(test::refusal([&] { parse_column_scene(text, "column.toml", overrides); }), parts);
}

TEST(PoreFluidOfAScene, IsRead)
{
  const ColumnScene scene =
      parse_column_scene(coupled, "s",
                         {"layer.0.saturation=0.98", "water.relative_viscosity=30", "water.air=boyle",
                          "water.henry=0.02", "water.atmospheric_pressure=80 kPa"});
  EXPECT_EQ(scene.layers[0].saturation, 0.98);
  EXPECT_EQ(scene.water.relative_viscosity, 30);
  EXPECT_EQ(scene.water.air, AirLaw::boyle);
  EXPECT_EQ(scene.water.henry, 0.02);
  EXPECT_EQ(scene.water.atmospheric_pressure, 80e3);
  EXPECT_EQ(parse_column_scene(to_toml(scene), "s"), scene);
  EXPECT_EQ(soil_profile(scene).layers[0].saturation, 0.98);
}

TEST(PoreFluidOfAScene, RangesHaveReasons)
{
  expect_overrides_refused(coupled, {"layer.0.saturation=0.7"},
                           {"must be in [0.8, 1] because water fills no more than the pores"});
  expect_overrides_refused(coupled, {"layer.0.saturation=1.01"},
                           {"must be in [0.8, 1] because water fills no more than the pores"});
  expect_overrides_refused(coupled, {"water.relative_viscosity=0"},
                           {"must be > 0 because it divides the permeability"});
  expect_overrides_refused(coupled, {"water.henry=0.2"}, {"must be in [0, 0.1]"});
  expect_overrides_refused(coupled, {"water.atmospheric_pressure=2 kPa"}, {"must be >= 5 kPa because water boils"});
  expect_overrides_refused(coupled, {"water.air=charles"}, {"must be \"constant\" or \"boyle\""});
}

TEST(PoreFluidOfAScene, PermeabilityThatVariesNeedsWaterThatMoves)
{
  const Overrides law = {"layer.0.permeability_law=kozeny-carman"};
  const ColumnScene scene = parse_column_scene(coupled, "s", law);
  EXPECT_EQ(scene.layers[0].permeability_law, PermeabilityLaw::kozeny_carman);
  EXPECT_TRUE(soil_profile(scene).permeability_varies());
  EXPECT_EQ(parse_column_scene(to_toml(scene), "s"), scene);
  expect_overrides_refused(coupled, {"layer.0.permeability_law=hazen"}, {"must be \"constant\" or \"kozeny-carman\""});
  expect_overrides_refused(coupled, {law[0], "layer.0.permeability=0 m/s"}, {"no effect on a permeability of 0 m/s"});
  expect_overrides_refused(smallest, law, {"layer.0.permeability_law", "has no effect where no water moves"});
  expect_overrides_refused(layer + undrained + dynamic, law, {"has no effect where no water moves"});
}

TEST(PoreFluidOfAScene, AirNeedsAVolumeThatChanges)
{
  const std::vector<std::string> no_effect = {"has no effect if water.drainage is \"dry\"", "drainage = \"coupled\""};
  expect_overrides_refused(smallest, {"layer.0.saturation=0.99"}, no_effect);
  expect_overrides_refused(layer + "saturation = 0.99\n" + undrained + dynamic, {},
                           {"column.toml:6: layer.0.saturation = 0.99", no_effect[0]});
  expect_overrides_refused(smallest, {"water.henry=0.02"}, no_effect);
  expect_overrides_refused(layer + undrained + dynamic,
                           {"water.lagged_compressibility=true", "layer.0.saturation=0.9999"}, {"accepted"});
  expect_overrides_refused(coupled, {"water.air=boyle"}, {"water.air", "has no effect without air"});
  expect_overrides_refused(coupled, {"water.air=boyle", "water.henry=0.02"}, {"accepted"});
  expect_overrides_refused(coupled, {"water.henry=0.02"}, {"has no effect in saturated soil", "water.air = \"boyle\""});
  expect_overrides_refused(coupled, {"water.henry=0.02", "layer.0.saturation=0.99"}, {"accepted"});
  expect_overrides_refused(consolidation, {"water.air=boyle", "layer.0.saturation=0.99"},
                           {"must be \"constant\" in a consolidation"});
  expect_overrides_refused(consolidation, {"layer.0.saturation=0.99"}, {"accepted"});
}

TEST(PoreFluidOfAScene, NoPWaveInAnUndrainedColumnOnRock)
{
  const std::string rock = "[base]\nkind = \"compliant\"\ndensity = \"2300 kg/m3\"\nshear_velocity = \"800 m/s\"\n",
                    motion =
                        "[[motion]]\naxis = \"z\"\nkind = \"ricker\"\namplitude = \"0.1 g\"\nfrequency = \"9 Hz\"\n";
  expect_overrides_refused(layer + undrained + dynamic + rock + motion, {},
                           {"column.toml:15: motion.0.axis = z; must not be z", "no P wave comes up"});
  expect_overrides_refused(layer + undrained + dynamic + motion, {}, {"accepted"});
  expect_overrides_refused(coupled + rock + motion, {}, {"accepted"});
}
} // namespace
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/resistance.hpp"

#include "tests/apps/deposit/scene_texts.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
const std::string level = dry + dynamic;

std::string with(const std::string &keys, const std::string &rest = level)
{
  return sand + keys + "\nk0 = 0.5\n" + rest;
}

TEST(LayerResistance, KeysComeThroughTextAndGoToTheSand)
{
  const ColumnScene scene = parse_column_scene(with("n1_60cs = 12"), "s");
  EXPECT_EQ(parse_column_scene(to_toml(scene), "again"), scene);
  // 2.5 m of 2000 kg/m3, dry
  EXPECT_DOUBLE_EQ(middle_stress(scene, 0)[2], -2000 * 9.81 * 2.5);
  const SandDensity density{.n1_60cs = 12};
  EXPECT_EQ(layer_resistance(scene, 0), resistance(density, 2000 * 9.81 * 2.5));
  const IwanParameters made = resisting_layer(scene, 0).sand();
  EXPECT_EQ(made, resisting(scene.layers[0].sand(), density, middle_stress(scene, 0)));
  EXPECT_GT(made.reconsolidation, 0);
  for (const char *same : {"qc1ncs = 90", "relative_density = 0.45"})
    EXPECT_TRUE(layer_resistance(parse_column_scene(with(same), "s"), 0));
  const ColumnScene none = parse_column_scene(with("contraction = 0.2"), "s");
  EXPECT_FALSE(layer_resistance(none, 0));
  EXPECT_EQ(resisting_layer(none, 0).iwan, none.layers[0].sand());
}

TEST(LayerResistance, BelowTheWaterAndASurcharge)
{
  const ColumnScene scene = parse_column_scene(sand + "permeability = \"0 m/s\"\n" + sand +
                                                   "k0 = 0.5\npermeability = \"0 m/s\"\nn1_60cs = 12\n" +
                                                   "[load]\nsurcharge = \"20 kPa\"\n" + dynamic,
                                               "s");
  EXPECT_CLOSE_BECAUSE(middle_stress(scene, 1)[2], -20e3 - 1000 * 9.81 * 7.5, 1e-12, "round-off");
  EXPECT_DOUBLE_EQ(middle_stress(scene, 1)[0], scene.layers[1].k0 * middle_stress(scene, 1)[2]);
}

TEST(LayerResistance, Warnings)
{
  const auto warnings = [](const char *keys) {
    const ColumnScene scene = parse_column_scene(with(keys), "s");
    return resistance_warnings(scene, resisting_layers(scene));
  };
  EXPECT_TRUE(warnings("n1_60cs = 12").empty());
  ASSERT_EQ(warnings("n1_60cs = 30").size(), 1);
  EXPECT_NE(warnings("n1_60cs = 30")[0].find("comes up to its strength"), std::string::npos);
}

TEST(LayerResistance, Refusals)
{
  expect_refused(with("n1_60cs = 12\nqc1ncs = 90"), {"column.toml:7", "excludes"});
  expect_refused(with("n1_60cs = 12\ncontraction = 0.5"), {"column.toml:7", "excludes"});
  expect_refused(with("n1_60cs = 12\nfabric_limit = 9"), {"column.toml:7", "follows from n1_60cs"});
  expect_refused(with("n1_60cs = 40"), {"column.toml:6", "[1, 37]"});
  expect_refused(layer + "n1_60cs = 12\n" + level, {"column.toml:6", "n1_60cs"});
}
} // namespace
} // namespace isostat

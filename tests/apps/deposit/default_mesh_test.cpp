// SPDX-License-Identifier: BSD-3-Clause
// Cells that layers leave out, the rows of histories, and stiffness in situ.
#include "apps/deposit/default_mesh.hpp"

#include "apps/deposit/formula_soil.hpp"
#include "tests/apps/deposit/scene_texts.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
const std::string open_sand = "[[layer]]\nthickness = \"6 m\"\nmaterial = \"iwan\"\nshear_velocity = \"200 m/s\"\n";

unsigned cells(const std::string &text, const Overrides &overrides = {})
{
  return parse_column_scene(text, "s", overrides).layers[0].cells;
}

/// 2 V_s/(10 f) of quadratic elements, half of it of linear ones, and 2 m at most.
TEST(DefaultMesh, ElasticLayersCarryTheHighestFrequency)
{
  const std::string text = layer_without_cells + dry + dynamic; // 5 m, 200 m/s
  EXPECT_EQ(cells(text), 4u);                                   // of 1.6 m
  EXPECT_EQ(cells(text, {"mesh.degree=1"}), 7u);
  EXPECT_EQ(cells(text, {"analysis.highest_frequency=50 Hz"}), 7u);
  EXPECT_EQ(cells(text, {"layer.0.shear_velocity=2000 m/s"}), 3u);
  const std::string pulse = "[[motion]]\nkind = \"ricker\"\namplitude = \"0.1 g\"\nfrequency = \"2 Hz\"\n";
  const double highest = highest_frequency(column_motions(parse_column_scene(text + pulse, "s"))[0], 25);
  EXPECT_LT(highest, 8); // and not 25
  EXPECT_EQ(cells(text + pulse, {"layer.0.shear_velocity=20 m/s"}), std::ceil(5 / (2 * 20 / (10 * highest))));
  EXPECT_EQ(cells(text, {"layer.0.cells=2"}), 2u);
  const ColumnScene scene = parse_column_scene(text, "s");
  EXPECT_EQ(parse_column_scene(to_toml(scene), "resolved"), scene);
}

/// The fewest with h <= min(0.4 x 2 V_s/(10 f), 1 m), V_s at h/2: that of the middle, and V_s ~ p'^0.25 as G ~ p'^0.5.
TEST(DefaultMesh, SandSoftens)
{
  const ColumnScene scene = parse_column_scene(open_sand + undrained + dynamic, "s");
  const auto velocity = [](double depth) { return 200 * std::pow(depth / 3, 0.25); };
  EXPECT_NEAR_BECAUSE(std::sqrt(moduli_in_situ(scene, scene.layers[0], 4)->s / 2000), velocity(2), 1e-9,
                      "round-off of the same formula");
  const auto enough = [&](double n) { return 6 / n <= std::min(0.08 * velocity(3 / n) / 25, 1.0); };
  const double n = scene.layers[0].cells;
  EXPECT_TRUE(enough(n)) << n;
  EXPECT_FALSE(enough(n - 1)) << n;
}

TEST(DefaultMesh, WhoMustGiveCells)
{
  for (const std::string material : {"\"user\"\n", "\"grains\"\nrelative_density = 0.5\n"})
    expect_refused("[[layer]]\nthickness = \"5 m\"\nmaterial = " + material + dry + dynamic +
                       (material[1] == 'g' ? "[grains]\nlibrary = \"a.h5\"\n" : ""),
                   {"column.toml:1: layer.0; must have exactly one of cells, cell_size", "cells = 10", "dynamic"});
  expect_refused(layer_without_cells + "permeability = \"1e-6 m/s\"\n" +
                     consolidation.substr(consolidation.find("[load]")),
                 {"column.toml:1: layer.0; must have exactly one of cells, cell_size"});
  expect_refused(layer_without_cells + dry + dynamic, {"layer.0; needs more than 1000000 cells", "highest_frequency"},
                 {"analysis.highest_frequency=1e9 Hz"});
}

TEST(DefaultMesh, TheWaterTableIsBetweenElements)
{
  const auto boundary = [](const char *table) {
    const ColumnScene scene =
        parse_column_scene(open_sand + undrained + dynamic, "s", {std::string("water.table=") + table});
    const double at = scene.water.table / 6 * scene.layers[0].cells;
    return std::abs(at - std::round(at)) < 1e-6;
  };
  EXPECT_TRUE(boundary("1.5 m"));
  EXPECT_TRUE(boundary("2.3 m"));
  expect_refused(open_sand + undrained + dynamic,
                 {"water.table = 1.23457 m; is within layer.0, but not on a boundary", "layer.0.cells"},
                 {"water.table=1.23457 m"});
}

TEST(DefaultMesh, RowsShowTheHighestFrequency)
{
  const auto interval = [](const Overrides &overrides) {
    return parse_column_scene(smallest, "s", overrides).output.history_interval;
  };
  EXPECT_EQ(interval({}), 0.01);
  EXPECT_EQ(interval({"analysis.highest_frequency=10 Hz"}), 0.01);
  EXPECT_EQ(interval({"analysis.highest_frequency=50 Hz"}), 0.005);
  EXPECT_EQ(interval({"analysis.highest_frequency=50 Hz", "output.history_interval=0.02 s"}), 0.02);
}
} // namespace
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/layer_curve.hpp"

#include "fem/material/iwan_curve.hpp"
#include "fem/material/viscoelastic.hpp"
#include "tests/apps/deposit/scene_texts.hpp"
#include "tests/support/near.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
const std::string rest = undrained + dynamic;

ColumnLayer with_curve(const std::string &keys) { return parse_column_scene(sand + keys + rest, "s").layers[0]; }

TEST(LayerCurve, IsThatOfTheMiddleOfTheLayer)
{
  const ColumnLayer clay = with_curve("curve = \"darendeli\"\nplasticity_index = 30\noverconsolidation_ratio = 2\n");
  EXPECT_EQ(curve_of(clay).reduction, darendeli_curve(clay.in_situ_pressure, 30, 2).reduction);
  EXPECT_EQ(clay.in_situ_depth, 2.5);
  EXPECT_EQ(small_strain_damping(clay), curve_of(clay).damping.front());
  const ColumnLayer gravel = with_curve("curve = \"menq\"\nuniformity = 8\nd50 = \"5 mm\"\ndamping = 0.004\n");
  EXPECT_EQ(curve_of(gravel).damping, menq_curve(gravel.in_situ_pressure, 8, 5e-3).damping);
  EXPECT_EQ(small_strain_damping(gravel), 0.004);
  EXPECT_EQ(curve_of(with_curve("curve = \"vucetic-dobry\"\n")).reduction, vucetic_dobry_curve(0).reduction);
  EXPECT_EQ(curve_of(with_curve("curve = \"epri\"\n")).damping, epri_curve(2.5).damping);
  EXPECT_EQ(small_strain_damping(parse_column_scene(smallest, "s").layers[0]), 0);
}

TEST(LayerCurve, ShearChangesThePressureOnlyIfAskedFor)
{
  const IwanParameters without = with_curve("curve = \"epri\"\n").iwan;
  EXPECT_EQ(without.contraction, 0);
  EXPECT_EQ(without.dilation, 0);
  const IwanParameters with = with_curve("curve = \"epri\"\ncontraction = 0.2\n").iwan;
  EXPECT_EQ(with.contraction, 0.2);
  EXPECT_EQ(with.dilation, IwanParameters().dilation);
  const ColumnScene scene = parse_column_scene(sand + "curve = \"epri\"\nunloading = \"mrdf\"\n" + rest, "s");
  EXPECT_EQ(parse_column_scene(to_toml(scene), "again"), scene);
}

TEST(LayerCurve, StrengthAndStiffnessAreThoseInSitu)
{
  const ColumnLayer soil = with_curve("curve = \"darendeli\"\nshear_strength = \"30 kPa\"\n");
  const double damping = small_strain_damping(soil), p = soil.in_situ_pressure;
  const auto m = damped_material(soil, 1);
  m->set_initial_stress(std::vector{Stress{-0.75 * p, -0.75 * p, -1.5 * p}}); // without a time step: slow loading
  Stress s;
  const Gradient small{0, 0, 1e-9}, large{0, 0, 1};
  m->trial({&small, 1}, {&s, 1});
  EXPECT_CLOSE_BECAUSE(s[4] / 1e-9, soil.in_situ_modulus() / ZenerBody(damping).at_one_hertz(), 1e-6,
                       "stress of 1e-11");
  m->trial({&large, 1}, {&s, 1});
  EXPECT_CLOSE_BECAUSE(s[4], 30e3, 1e-9, "round-off");
  EXPECT_GT(*strain_of_strength(soil), 1e-5); // 30 kPa is less than the stress of the curve at 1 %
  EXPECT_FALSE(strain_of_strength(with_curve("curve = \"darendeli\"\nshear_strength = \"300 kPa\"\n")));
}

TEST(LayerCurve, MistakesAreRefused)
{
  const auto refused = [](const std::string &keys, const std::vector<std::string> &parts) {
    expect_refused(sand + keys + rest, parts);
  };
  refused("curve = \"darendelli\"\n", {"column.toml:6: layer.0.curve = darendelli; is no known family", "menq"});
  refused("curve = \"menq\"\nuniformity = 2\n", {"layer.0.curve", "needs uniformity and d50"});
  refused("curve = \"epri\"\nd50 = \"1 mm\"\n", {"column.toml:7: layer.0.d50", "has no effect on the curve \"epri\""});
  refused("plasticity_index = 20\n", {"layer.0.plasticity_index", "has no effect without a curve"});
  refused("unloading = \"mrdf\"\n", {"layer.0.unloading", "needs the damping of a curve"});
  refused("strength_ratio = 0.6\nshear_strength = \"30 kPa\"\n", {"layer.0.shear_strength", "excludes strength_ratio"});
  refused("damping = 0.2\n", {"layer.0.damping = 0.2; must be in [0, 0.1]"});
  expect_refused(layer + "curve = \"epri\"\n" + rest, {"does not belong to a layer of material \"elastic\""});
}

TEST(LayerCurve, TablesAreFoundNextToTheScene)
{
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / "isostat_layer_curve";
  fs::create_directories(folder);
  const auto read = [&](const std::string &keys, const std::string &table) {
    std::ofstream(folder / "clay.csv") << table;
    std::ofstream(folder / "column.toml") << sand + keys + rest;
    return read_column_scene((folder / "column.toml").string());
  };
  const std::string table = "strain (-),G/G_max (-)\n1e-5,1\n1e-4,0.8\n1e-3,0.3\n", curve = "curve = \"clay.csv\"\n";
  const ColumnScene scene = read(curve, table);
  EXPECT_EQ(scene.layers[0].curve.source, folder / "clay.csv");
  EXPECT_EQ(curve_of(scene.layers[0]).reduction_at(1e-4), 0.8);
  EXPECT_EQ(small_strain_damping(scene.layers[0]), 0);
  test::expect_parts(test::refusal([&] { read(curve + "unloading = \"mrdf\"\n", table); }),
                     {"column.toml:7: layer.0.unloading", "has no column `damping (-)`"});
  test::expect_parts(test::refusal([&] { read(curve, table + "1e-2,0.4\n"); }), {"clay.csv:5: G/G_max (-) = 0.4"});
  fs::remove_all(folder);
}
} // namespace
} // namespace isostat

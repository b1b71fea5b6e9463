// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/layer_tables.hpp"

#include "apps/deposit/scene.hpp"
#include "tests/apps/deposit/scene_texts.hpp"
#include "tests/support/refusal.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
namespace fs = std::filesystem;

const std::string header = "density (kg/m3),layer,thickness (m),shear_velocity (m/s)\n";
const std::string above =
    "[[layer]]\nthickness = \"1 m\"\ncells = 2\nmaterial = \"elastic\"\nshear_velocity = \"90 m/s\"\n";
const std::string profile = "[[layer]]\ntable = \"profile.csv\"\ncell_size = \"1 m\"\nmaterial = \"iwan\"\nk0 = 0.7\n";

class LayerTables : public testing::Test
{
protected:
  LayerTables() { fs::create_directories(folder); }
  ~LayerTables() override { fs::remove_all(folder); }

  void write(const std::string &name, const std::string &text) const { std::ofstream(folder / name) << text; }
  ColumnScene read(const std::string &text, const Overrides &overrides = {}) const
  {
    write("column.toml", text + dry + dynamic);
    return read_column_scene((folder / "column.toml").string(), overrides);
  }
  void expect_refused(const std::string &text, const std::vector<std::string> &parts,
                      const Overrides &overrides = {}) const
  {
    test::expect_parts(test::refusal([&] { read(text, overrides); }), parts);
  }

  fs::path folder = fs::temp_directory_path() / "isostat_layer_tables";
};

TEST_F(LayerTables, RowsBecomeLayers)
{
  write("profile.csv", header + "1800,1,0.1,150\n1950.5,2,3.3,212.25\n\n2100,3,4,300\n");
  const ColumnScene scene = read(above + profile + above);
  ASSERT_EQ(scene.layers.size(), 5U);
  const double thickness[] = {1, 0.1, 3.3, 4, 1}, velocity[] = {90, 150, 212.25, 300, 90};
  const double density[] = {2000, 1800, 1950.5, 2100, 2000};
  const unsigned cells[] = {2, 1, 4, 4, 2};
  for (std::size_t i = 0; i < 5; ++i)
    {
      const ColumnLayer &layer = scene.layers[i];
      EXPECT_EQ(layer.thickness, thickness[i]);
      EXPECT_EQ(*layer.shear_velocity, velocity[i]);
      EXPECT_EQ(layer.density, density[i]);
      EXPECT_EQ(layer.n_cells(), cells[i]);
      const bool is_row = i > 0 && i < 4;
      EXPECT_EQ(layer.material, is_row ? LayerMaterial::iwan : LayerMaterial::elastic);
      EXPECT_EQ(layer.k0, is_row ? 0.7 : 0.5);
    }
  EXPECT_EQ(parse_column_scene(to_toml(scene), "again"), scene) << "the scene of the results needs no table";
}

TEST_F(LayerTables, AsRWritesThem)
{
  write("profile.csv", "\"\",\"thickness (m)\",\"shear_velocity (m/s)\",\"density (kg/m3)\"\n\"1\",3,150,1800\n"
                       "\"2\",12,320,2000\n");
  const ColumnScene scene = read(profile);
  ASSERT_EQ(scene.layers.size(), 2U);
  EXPECT_EQ(scene.layers[1].thickness, 12);
  EXPECT_EQ(scene.layers[1].density, 2000);
}

TEST_F(LayerTables, OverridesCountTheLayersOfTheFile)
{
  write("profile.csv", header + "1800,1,2,150\n1900,2,3,200\n");
  const ColumnScene scene = read(profile + above, {"layer.1.thickness=5 m", "layer.0.k0=0.6"});
  ASSERT_EQ(scene.layers.size(), 3U);
  EXPECT_EQ(scene.layers[1].k0, 0.6);
  EXPECT_EQ(scene.layers[2].thickness, 5);
  expect_refused(profile + above, {"--set layer.2.thickness", "must be in [0.001 m, 100000 m]"},
                 {"layer.1.thickness=0 m"});
}

TEST_F(LayerTables, MistakesInTheScene)
{
  expect_refused(profile, {"column.toml:2: layer.0.table = profile.csv; does not exist"});
  write("profile.csv", header + "1800,1,2,150\n");
  expect_refused(above + profile + "density = \"2000 kg/m3\"\n",
                 {"column.toml:11: layer.1.density", "excludes table", "column.toml:7", "Keep one"});
  expect_refused("[[layer]]\ntable = 3\n", {"column.toml:2: layer.0.table = 3; must be text"});
  expect_refused("[[layer]]\ntable = \"profile.csv\"\nmaterial = \"grains\"\n", {"layer.0.table", "only to elastic"});
  expect_refused(above + profile + "poisson_ratio = 0.6\n", {"column.toml:11: layer.1.poisson_ratio", "[0, 0.5)"});
}

TEST_F(LayerTables, MistakesInTheTable)
{
  for (const auto &[text, parts] : std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"thickness (m),density (kg/m3)\n1,2\n", {"profile.csv:1", "shear_velocity (m/s)"}},
           {header, {"profile.csv:2", "no rows"}},
           {header + "1800,1,2,150\n1800,2,0,150\n", {"profile.csv:3", "thickness = 0 m", "> 0 m"}},
           {header + "1800,1,2,-150\n", {"profile.csv:2", "shear_velocity = -150 m/s", "> 0 m/s"}},
           {header + "1800,1,2,fast\n", {"profile.csv:2", "fast"}},
           {header + "1800,1,2\n", {"profile.csv:2", "3 values"}}})
    {
      write("profile.csv", text);
      expect_refused(profile, parts);
    }
}
} // namespace
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// A scene with a mesh from a file: what its layers get from it, in-situ stress, what is refused.
#include "apps/deposit/formula_soil.hpp"
#include "tests/apps/deposit/scene_texts.hpp"
#include "tests/support/drawn_mesh.hpp"
#include "tests/support/near.hpp"

namespace isostat
{
namespace
{
/// A mesh of 8 m x 5 m in 10 x 8 elements, in a folder of its own.
class MeshOfFile : public testing::Test
{
protected:
  MeshOfFile()
  {
    std::string name = testing::TempDir() + "isostat_mesh_XXXXXX";
    folder_ = mkdtemp(name.data());
    write("slope.msh", [](std::array<double, 3> at) {
      at = test::PushedAbout<2>{10}(at);
      return std::array<double, 3>{8 * at[0], 5 * at[1], 0};
    });
  }
  ~MeshOfFile() override { std::filesystem::remove_all(folder_); }

  template <typename Move>
  void write(const std::string &name, const Move &move) const
  {
    std::ofstream(folder_ / name) << test::gmsh_text<2>({10, 8, 0}, move);
  }
  ColumnScene read(const std::string &more, const Overrides &overrides = {}) const
  {
    const std::string text = "[mesh]\ndimension = 2\nsides = \"walls\"\nfile = \"slope.msh\"\n" + dry +
                             "[[layer]]\nname = \"soil\"\nmaterial = \"elastic\"\nshear_velocity = \"200 m/s\"\n";
    return parse_column_scene(text + more, (folder_ / "scene.toml").string(), overrides);
  }
  void refused(const std::string &more, const std::vector<std::string> &parts, const Overrides &overrides = {}) const
  {
    test::expect_parts(test::refusal([&] { read(more, overrides); }), parts);
  }
  const std::filesystem::path &folder() const { return folder_; }

private:
  std::filesystem::path folder_;
};

TEST_F(MeshOfFile, GivesLayersTheirThicknessAndStress)
{
  const ColumnScene scene = read(dynamic);
  EXPECT_NEAR_BECAUSE(scene.layers[0].thickness, 5, 1e-12, "round-off of an area");
  EXPECT_EQ(scene.layers[0].cells, 7u); // 5 m in squares of 0.71 m, as 40 m2 in 80
  EXPECT_EQ(scene.mesh.width, 8);
  EXPECT_NEAR_BECAUSE(scene.layers[0].in_situ_depth, 2.5, 1e-12, "round-off of a centre");
  EXPECT_NEAR_BECAUSE(scene.layers[0].in_situ_pressure, 2. / 3 * 2000 * 9.81 * 2.5, 1e-7, "round-off of 3e4 Pa");
  EXPECT_EQ(mesh_spec(scene).ground_at({3, 0, 0}), 5);
  EXPECT_TRUE(scene.mesh.is_boundary(0.8));
  EXPECT_FALSE(scene.mesh.is_boundary(1));
  EXPECT_EQ(parse_column_scene(to_toml(scene), "resolved"), scene) << to_toml(scene);
}

TEST_F(MeshOfFile, HasTheMeanStressOfALayerWhoseCentreIsNotInIt)
{
  write("bowl.msh", [](std::array<double, 3> at) {
    return std::array<double, 3>{8 * at[0], 12 * std::pow(at[0] - 0.5, 2) + 0.4 * at[1], 0};
  });
  const ColumnScene scene = read(dynamic, {"mesh.file=bowl.msh"}); // of area: 0.8 m above the soil
  EXPECT_NEAR_BECAUSE(scene.layers[0].in_situ_depth, 0.2, 1e-9, "round-off");
  EXPECT_NEAR_BECAUSE(scene.layers[0].in_situ_pressure, 2. / 3 * 2000 * 9.81 * 0.2, 1e-5, "round-off of 3e3 Pa");
}

TEST_F(MeshOfFile, InThreeDimensionsHasWidthsOfItsOwn)
{
  std::ofstream(folder() / "block.msh") << test::gmsh_text<3>({4, 3, 2}, [](std::array<double, 3> at) {
    return std::array<double, 3>{8 * at[0], 6 * at[1], (5 + at[0] + at[1]) * at[2]};
  });
  const ColumnScene scene = read(dynamic, {"mesh.file=block.msh", "mesh.dimension=3"});
  EXPECT_NEAR_BECAUSE(scene.layers[0].thickness, 6, 1e-12, "round-off of a volume");
  EXPECT_NEAR_BECAUSE(scene.layers[0].in_situ_pressure, 2. / 3 * 2000 * 9.81 * (36 + 1. / 6) / 12, 1e-7,
                      "round-off of 4e4 Pa");
  const MeshSpec mesh = mesh_spec(scene);
  EXPECT_EQ(mesh.line, (std::array<double, 2>{4, 3}));
  EXPECT_NEAR_BECAUSE(mesh.on_line(1)[2], 5, 1e-9, "round-off");
  EXPECT_EQ(parse_column_scene(to_toml(scene), "resolved"), scene) << to_toml(scene);
}

TEST_F(MeshOfFile, RefusesWhatTheFileSays)
{
  refused("thickness = \"4 m\"\n" + dynamic, {"layer.0.thickness = 4 m; and cells follow from mesh.file", "Remove"});
  refused("cell_size = \"1 m\"\n" + dynamic, {"layer.0.cell_size", "no effect with mesh.file"});
  refused(dynamic, {"mesh.width", "must be that of mesh.file, 8 m"}, {"mesh.width=9 m"});
  refused(dynamic, {"mesh.cells_across", "no effect with mesh.file"}, {"mesh.cells_across=4"});
  refused(dynamic, {"mesh.file", "dimension = 2"}, {"mesh.dimension=1", "mesh.sides=tied"});
  refused(dynamic, {"slope.msh: no hexahedra", "Correct mesh.dimension"}, {"mesh.dimension=3"});
  refused(dynamic, {"mesh.ground_x", "no effect with mesh.file"}, {"mesh.ground_x=['0 m', '8 m']"});
  refused(dynamic, {"mesh.file = other.msh; does not exist"}, {"mesh.file=other.msh"});
  refused(dynamic, {"physical group \"soil\", which is no layer of the scene", "\"silt\""}, {"layer.0.name=silt"});
  write("dips.msh", [](std::array<double, 3> at) {
    return std::array<double, 3>{8 * at[0], 5 * at[1] + at[0] * (1 - at[1]), 0};
  });
  refused(dynamic, {"mesh.sides", "layer.0 dips"}, {"mesh.file=dips.msh", "mesh.sides=free-field"});
  write("mm.msh", [](std::array<double, 3> at) { return std::array<double, 3>{8e3 * at[0], 5e3 * at[1], 0}; });
  refused(dynamic, {"mesh.file = mm.msh; is 8000 m wide and 5000 m high", "drawn in mm by 0.001"},
          {"mesh.file=mm.msh"});
  refused("[[layer]]\nname = \"soil\"\n" + dynamic, {"layer.1.name = soil; is that of another layer"});
  refused(dynamic, {"slope.angle", "upright"}, {"slope.angle=3 deg", "mesh.sides=tied"});
}
} // namespace
} // namespace isostat

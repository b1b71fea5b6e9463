// SPDX-License-Identifier: BSD-3-Clause
// Meshes of Gmsh: what is read of them, what a borehole meets, what is refused.
#include "fem/space/column_line.hpp"
#include "fem/space/discretisation.hpp"
#include "tests/support/drawn_mesh.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <numeric>

namespace isostat
{
namespace
{
/// A trapezoid of two cells with sloping ground: clay below, sand (group 1 without a name) on top.
const std::string of_two_layers = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
5
1 1 "base"
1 2 "surface"
1 3 "x_low"
1 4 "x_high"
2 9 "clay"
$EndPhysicalNames
$Entities
1 6 2 0
1 0 0 0 0
1 0 0 0 4 0 0 1 1 0
2 0 3 0 4 3 0 1 2 0
3 0 0 0 0 3 0 1 3 0
4 4 0 0 4 2 0 1 4 0
5 0 1 0 4 1 0 1 77 0
6 0 1 0 4 1 0 0 0
1 0 0 0 4 1 0 1 9 0
2 0 1 0 4 3 0 1 1 0
$EndEntities
$Nodes
1 6 1 60
2 1 0 6
10
20
30
40
50
60
0 0 0
4 0 0
0 1 0
4 1 0
0 3 0
4 2 0
$EndNodes
$Elements
8 10 1 11
0 1 15 1
1 10
1 1 1 1
2 10 20
1 2 1 1
3 50 60
1 3 1 2
4 10 30
5 30 50
1 4 1 2
6 20 40
7 40 60
1 5 1 1
11 30 40
2 1 3 1
8 10 20 40 30
2 2 3 1
9 50 30 40 60
$EndElements
)";

std::string with(std::string text, const std::string &old, const std::string &now)
{
  text.replace(text.find(old), old.size(), now);
  return text;
}
} // namespace

TEST(GivenMesh, IsReadFromFormat41)
{
  const auto mesh = test::read_gmsh_text(of_two_layers, 2, {"sand", "clay"});
  ASSERT_EQ(mesh->cells.size(), 2u);
  EXPECT_EQ(mesh->cells[0].layer, 1u);
  EXPECT_EQ(mesh->cells[1].layer, 0u);
  EXPECT_EQ(mesh->sides.size(), 6u); // the curve between the layers is none
  EXPECT_EQ(mesh->ground, (GroundLine{{{0, 3}, {4, 2}}}));
  EXPECT_EQ(mesh->width(), 4);
  EXPECT_NEAR_BECAUSE(mesh->size(0), 6, 1e-12, "round-off");
  EXPECT_NEAR_BECAUSE(mesh->mean(1, [](const Place &place) { return place[2]; }), 0.5, 1e-12, "round-off");
  EXPECT_TRUE(mesh->is_boundary(4));
  EXPECT_FALSE(mesh->is_boundary(2));
}

TEST(GivenMesh, BoreholeAndStressOfTheWeightAboveAPlace)
{
  MeshSpec spec = test::soil_of(test::read_gmsh_text(of_two_layers, 2, {"sand", "clay"}));
  spec.soil.layers = {{.name = "sand", .density = 1900}, {.name = "clay", .density = 1600}};
  for (const auto &[x, sand] : {std::pair{0.0, 2.0}, {1.0, 1.75}, {4.0, 1.0}})
    {
      const SoilProfile hole = spec.given->borehole(spec.soil, x);
      ASSERT_EQ(hole.layers.size(), 2u);
      EXPECT_NEAR_BECAUSE(hole.layers[0].thickness, sand, 1e-9, "round-off");
      EXPECT_EQ(hole.layers[1].name, "clay");
      EXPECT_NEAR_BECAUSE(spec.vertical_effective_stress({x, 0, 0.25}), 9.81 * (900 * sand + 600 * 0.75), 1e-6,
                          "round-off of 2e4 Pa");
    }
  const std::vector<double> nodes = node_depths(spec), expected = {0, 1, 2, 2.5, 3};
  ASSERT_EQ(nodes.size(), expected.size());
  for (std::size_t k = 0; k < nodes.size(); ++k)
    EXPECT_NEAR_BECAUSE(nodes[k], expected[k], 1e-9, "round-off");
}

/// A block of 4 m x 2 m whose ground is a twisted surface, cells pushed about inside.
TEST(GivenMesh, BoreholeAndStressInThreeDimensions)
{
  const auto ground = [](double x, double y) { return 3 + x / 4 - y / 2 + x * y / 8; };
  const auto text = [&](const auto &push) {
    return test::gmsh_text<3>({2, 2, 3}, [&](std::array<double, 3> at) {
      at = push(at);
      return std::array<double, 3>{4 * at[0], 2 * at[1], at[2] * ground(4 * at[0], 2 * at[1])};
    });
  };
  MeshSpec spec = test::soil_of(test::read_gmsh_text(text(test::PushedAbout<3>{3}), 3));
  spec.soil.layers[0].density = 1900;
  for (const auto &[x, y] : {std::pair{0.0, 0.0}, {2.0, 1.0}, {2.0, 0.3}, {1.1, 0.7}, {4.0, 2.0}, {4.0, 1.0}})
    {
      const double z = ground(x, y);
      EXPECT_NEAR_BECAUSE(spec.given->ground_at(x, y), z, 1e-9, "round-off");
      EXPECT_NEAR_BECAUSE(spec.given->borehole(spec.soil, x, y).height(), z, 1e-6, "round-off along edges");
      EXPECT_NEAR_BECAUSE(spec.vertical_effective_stress({x, y, 1}), 9.81 * 900 * (z - 1), 1e-2,
                          "round-off of 3e4 Pa along edges");
    }
  const Discretisation<3> space(spec, {});
  const double volume = std::accumulate(space.weight.begin(), space.weight.end(), 0.0);
  EXPECT_NEAR_BECAUSE(volume, 8 * 3.25, 1e-12, "round-off");
  EXPECT_NEAR_BECAUSE(test::read_gmsh_text(text(std::identity()), 3)->thickness(0), 3.25, 1e-12, "round-off");
  const auto refused = [&](const std::string &from, const std::string &to, const std::vector<std::string> &parts) {
    test::expect_parts(test::refusal([&] { test::read_gmsh_text(with(text(std::identity()), from, to), 3); }), parts);
  };
  refused("\"surface\"", "\"x_low\"", {"no surface"});
  refused("2 5 \"base\"\n2 6 \"surface\"", "2 6 \"base\"\n2 5 \"surface\"", {"is not the highest point"});
}

TEST(GivenMesh, HasTheVolumeOfItsCellsWhateverTheirShape)
{
  for (unsigned degree : {1, 2})
    {
      MeshSpec spec = test::soil_of(test::read_gmsh_text(test::gmsh_text<2>({6, 6, 0}, test::PushedAbout<2>{6}), 2));
      spec.degree = degree;
      const Discretisation<2> space(spec, {});
      EXPECT_NEAR_BECAUSE(std::accumulate(space.weight.begin(), space.weight.end(), 0.0), 1, 1e-13, "round-off");
      const Vector surface = space.face_area(Face::surface);
      EXPECT_NEAR_BECAUSE(surface.l1_norm(), 3, 1e-13, "round-off; three components");
      EXPECT_EQ(space.point_id[4 * space.points_per_cell()], 4 * space.points_per_cell()); // numbers of the file
      EXPECT_GE(column_line(space).points.size(), 6u);
    }
}

TEST(GivenMesh, MayHaveCellsOfEitherOrientation)
{
  const auto volume = [](const std::string &text) {
    MeshSpec spec = test::soil_of(test::read_gmsh_text(text, 2, {"sand", "clay"}));
    spec.soil.layers = {{.name = "sand"}, {.name = "clay"}};
    const Discretisation<2> space(spec, {});
    return std::accumulate(space.weight.begin(), space.weight.end(), 0.0);
  };
  EXPECT_NEAR_BECAUSE(volume(with(of_two_layers, "8 10 20 40 30", "8 30 40 20 10")), volume(of_two_layers), 1e-12,
                      "round-off");
}

TEST(GivenMesh, RefusesWhatIsNoSoil)
{
  const std::string &good = of_two_layers;
  const auto refused = [](const std::string &text, const std::vector<std::string> &parts,
                          const std::vector<std::string> &layers = {"sand", "clay"}) {
    test::expect_parts(test::refusal([&] { test::read_gmsh_text(text, 2, layers); }), parts);
  };
  refused(with(good, "2 1 3 1\n8 10 20 40 30", "2 1 2 1\n8 10 20 40"), {"element 8 is a triangle", "Recombine"});
  refused(with(good, "2 1 3 1\n8 10 20 40 30", "2 1 10 1\n8 10 20 40 30"), {":57: element 8", "type 10", "order 1"});
  refused(with(good, "4 0 0 4 2 0 1 4 0", "4 0 0 4 2 0 0 0"), {"element 6 at the boundary", "named base, surface"});
  refused(with(good, "1 4 1 2\n6 20 40\n7 40 60\n", "1 4 1 1\n6 20 40\n"), {"a side at x = 4 m, z = 1 m", "x_high"});
  refused(good, {"element 8", "\"clay\", which is no layer", "\"sand\", \"mud\""}, {"sand", "mud"});
  refused(good, {"no cells of layer.2 (\"rock\")"}, {"sand", "clay", "rock"});
  refused(with(good, "4.1 0 8", "4.1 1 8"), {":2: a binary mesh", "-bin"});
  refused(with(good, "4.1 0 8", "4 0 8"), {":2: version 4 of the format", "2.2 or 4.1"});
  refused(with(good, "4 2 0\n$EndNodes", "4 two 0\n$EndNodes"), {"\"two\" where a number is expected"});
  refused(with(good, "0 3 0\n4 2 0\n", "0 3 0\n0 2 0\n"), {"surface: ", "overhangs"});
  refused(with(good, "4 2 0\n$EndNodes", "4 nan 0\n$EndNodes"), {"\"nan\" where a number is expected"});
  refused(with(good, "2 2 3 1\n9 50 30 40 60\n", "2 2 3 2\n9 50 30 40 60\n10 50 30 40 60\n"),
          {"element 10 has a side that two others have"});
  refused(with(good, "4 0 0\n0 1 0\n", "4 -1 0\n0 1 0\n"), {"the smallest z is -1 m; must be 0 m"});
  for (const double middle : {0.95, 0.77}) // a corner is beyond the diagonal; the points of the second are not
    {
      const MeshSpec folded = test::soil_of(test::read_gmsh_text(
          test::gmsh_text<2>({2, 2, 0},
                             [middle](std::array<double, 3> at) {
                               return at[0] == 0.5 && at[1] == 0.5 ? std::array<double, 3>{middle, middle, 0} : at;
                             }),
          2));
      test::expect_parts(test::refusal([&] { Discretisation<2>(folded, {}); }), {"folded or flat"});
    }
}
} // namespace isostat

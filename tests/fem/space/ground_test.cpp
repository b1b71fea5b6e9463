// SPDX-License-Identifier: BSD-3-Clause
// Ground that is not level: its line, and the mesh below it.
#include "fem/space/column_line.hpp"
#include "fem/space/discretisation.hpp"
#include "fem/space/ground.hpp"
#include "tests/support/columns.hpp"
#include "tests/support/near.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>
#include <numeric>

namespace isostat
{
namespace
{
const GroundLine line{{{2, 3}, {4, 5}, {8, 1}}};

MeshSpec hill()
{
  MeshSpec mesh;
  mesh.soil.layers = {{.name = "upper", .thickness = 2, .cells = 2}, {.name = "lower", .thickness = 3, .cells = 3}};
  mesh.width = {10, 1};
  mesh.cells_across = {10, 1};
  mesh.ground = line;
  mesh.line = {4, 0};
  return mesh;
}

TEST(GroundLine, IsStraightBetweenItsPointsAndLevelBeyond)
{
  EXPECT_EQ(line.at(0), 3);
  EXPECT_EQ(line.at(2), 3);
  EXPECT_EQ(line.at(3), 4);
  EXPECT_EQ(line.at(4), 5);
  EXPECT_EQ(line.at(5), 4);
  EXPECT_EQ(line.at(9), 1);
  EXPECT_EQ(line.highest(), 5);
}

TEST(GroundLine, RefusesWhatIsNone)
{
  test::expect_parts(test::refusal([] { GroundLine{{{0, 1}}}.check(); }), {"1 point", "at least two"});
  test::expect_parts(test::refusal([] { GroundLine{{{0, 1}, {0, 2}}}.check(); }), {"x = 0 m after 0 m", "must rise"});
  test::expect_parts(test::refusal([] { GroundLine{{{0, 1}, {1, 0}}}.check(); }), {"point 1 is 0 m", "> 0"});
}

TEST(GroundMesh, HasTheAreaBelowTheLineAndLayersInProportion)
{
  const Discretisation<2> space(hill(), {});
  const double area = std::accumulate(space.weight.begin(), space.weight.end(), 0.0);
  EXPECT_NEAR_BECAUSE(area, 2 * 3 + 2 * 4 + 4 * 3 + 2 * 1, 1e-12, "round-off: elements follow the straight lines");
  double upper = 0;
  for (std::size_t q = 0; q < space.n_points(); ++q)
    {
      const Place &place = space.position[q];
      const bool is_upper = space.cell_layer[q / space.points_per_cell()] == 0;
      upper += is_upper ? space.weight[q] : 0;
      EXPECT_EQ(is_upper, place[2] > 0.6 * line.at(place[0])) << place[0] << ' ' << place[2];
      EXPECT_EQ(space.mesh().depth(place), line.at(place[0]) - place[2]);
    }
  EXPECT_NEAR_BECAUSE(upper, 0.4 * area, 1e-12, "round-off");
}

TEST(GroundMesh, SeparatesDepthsBelowTheGroundOfItsLine)
{
  const Discretisation<2> space(hill(), {});
  const ColumnLine column = column_line(space);
  EXPECT_EQ(column.node_depths.size(), 11u);
  EXPECT_EQ(column.node_depths.back(), 5); // at the top of the hill
  EXPECT_EQ(column.points.size(), 15u);    // of the elements on the right of it
  for (std::size_t q : column.points)
    EXPECT_NEAR_BECAUSE(space.position[q][0], 4.1127, 1e-4, "the first of three Gauss points of an element of 1 m");
}

TEST(GroundMesh, HasALineJustBeforeTheLastWall)
{
  MeshSpec mesh = hill();
  mesh.line = {9.99, 0};
  const Discretisation<2> space(mesh, {});
  for (std::size_t q : column_line(space).points)
    EXPECT_NEAR_BECAUSE(space.position[q][0], 9.8873, 1e-4, "the last of three Gauss points of an element of 1 m");
  EXPECT_EQ(column_line(space).points.size(), 15u);
}

TEST(GroundMesh, RefusesGroundThatLayersDoNotReach)
{
  MeshSpec mesh = hill();
  mesh.soil.layers[0].thickness = 1;
  test::expect_parts(test::refusal([&] { Discretisation<2>(mesh, {}); }), {"5 m", "4 m", "the same"});
  mesh = hill();
  test::expect_parts(test::refusal([&] { Discretisation<3>(mesh, {}); }), {"3 dimensions", "must be in 2"});
}

TEST(Patch, HasItsPartOfAFaceAndTheFaceTheRest)
{
  MeshSpec mesh = hill();
  mesh.patches = {{Face::base, 2, 5}, {Face::x_high, 0, 0.2}};
  const Discretisation<2> space(mesh,
                                {.tied_sides = false, .fixed = {{patch_face(0), 2}}, .together = {}, .drained = {}});
  const auto area = [&](Face face) {
    const Vector areas = space.face_area(face);
    double sum = 0;
    for (std::size_t i = 2; i < areas.locally_owned_size(); i += 3)
      sum += areas.local_element(i);
    return sum;
  };
  constexpr test::Tolerance round_off{1e-12, "round-off"};
  EXPECT_NEAR_BECAUSE(area(patch_face(0)), 3, round_off);
  EXPECT_NEAR_BECAUSE(area(Face::base), 7, round_off);
  EXPECT_NEAR_BECAUSE(area(patch_face(1)), 0.2, round_off);
  EXPECT_NEAR_BECAUSE(area(Face::x_high), 0.8, round_off);
  EXPECT_EQ(space.fixed_dofs.size(), 7u); // nodes of three elements of degree 2
}

TEST(Patch, RefusesEndsInsideOfElements)
{
  MeshSpec mesh = hill();
  mesh.patches = {{Face::base, 2, 5.5}};
  test::expect_parts(test::refusal([&] { Discretisation<2>(mesh, {}); }), {"patch 0", "2 m to 5.5 m", "boundaries"});
  mesh.patches = {{Face::base, 2.3, 5.3}}; // as long as three elements
  test::expect_parts(test::refusal([&] { Discretisation<2>(mesh, {}); }), {"reach from 2 m to 5 m", "boundaries"});
  mesh.patches = {{Face::base, 8, 11}};
  test::expect_parts(test::refusal([&] { Discretisation<2>(mesh, {}); }),
                     {"reach from 8 m to 10 m", "inside its face"});
}
} // namespace
} // namespace isostat

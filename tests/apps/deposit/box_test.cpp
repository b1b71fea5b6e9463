// SPDX-License-Identifier: BSD-3-Clause
// A box of soil between walls in a scene: what it becomes, and what is refused.
#include "apps/deposit/box.hpp"

#include "base/tell.hpp"
#include "tests/apps/deposit/scene_texts.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
std::string box(const std::string &more = "", const std::string &of_mesh = "")
{
  const std::string cells = of_mesh.find("cells_across") == std::string::npos ? "cells_across = 5\n" : "";
  return sand + "permeability = \"1e-5 m/s\"\n[mesh]\ndimension = 2\nwidth = \"10 m\"\nsides = \"walls\"\n" + cells +
         of_mesh + more + dynamic;
}

const std::string ground = "ground_x = [\"0 m\", \"4 m\", \"10 m\"]\nground_z = [\"5 m\", \"5 m\", \"2 m\"]\n";

TEST(BoxScene, KeysComeThroughTextAndGoToTheMesh)
{
  const ColumnScene scene = parse_column_scene(
      box("[load]\nsurcharge = \"20 kPa\"\nsurcharge_from = \"4 m\"\nsurcharge_to = \"6 m\"\n", ground), "s");
  EXPECT_EQ(parse_column_scene(to_toml(scene), "again"), scene);
  const MeshSpec mesh = mesh_spec(scene);
  EXPECT_EQ(mesh.ground.at(7), 3.5);
  EXPECT_EQ(mesh.line[0], 5); // the middle
  EXPECT_EQ(mesh.ground_at({5, 0, 0}), 4.5);
  EXPECT_FALSE(scene.load.bears_on_all());
}

TEST(BoxScene, RefinementsComeThroughTextAndGoToTheMesh)
{
  const std::string refine = "[[refine]]\nfrom = [\"2 m\", \"1 m\"]\nto = [\"5 m\", \"4 m\"]\nlevels = 2\n",
                    above = "[[refine]]\nfrom = [\"0 m\", \"3 m\"]\n";
  const ColumnScene scene = parse_column_scene(box(refine + above), "s");
  EXPECT_EQ(parse_column_scene(to_toml(scene), "again"), scene);
  const std::vector<Refinement> boxes = mesh_spec(scene).refine;
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(boxes[0].levels, 2u);
  EXPECT_EQ(boxes[0].from[0], 2);
  EXPECT_EQ(boxes[0].to[2], 4);
  EXPECT_EQ(boxes[1].levels, 1u);
  EXPECT_GT(boxes[1].to[0], 1e6);
  expect_refused(sand + dry + above + dynamic, {"column.toml:8", "refine", "needs mesh.dimension 2 or 3"});
  expect_refused(box(refine), {"refine.0.from", "must have 2 lengths: x and height"}, {"refine.0.from=[\"1 m\"]"});
  expect_refused(box(refine), {"refine.0.to", "must be above"}, {"refine.0.to=[\"5 m\", \"1 m\"]"});
  expect_refused(box(refine), {"refine.0.from", "below the end of the soil"},
                 {"refine.0.from=[\"50 m\", \"1 m\"]", "refine.0.to=[\"60 m\", \"4 m\"]"});
  expect_refused(box(refine), {"refine.0.levels", "in [1, 8] because a level makes 4"}, {"refine.0.levels=9"});
  expect_refused(box(refine),
                 {"analysis.petsc", "implicit steps of coupled soil solve for. Give -statics_pc_type gamg"},
                 {"analysis.petsc=-statics_pc_type fieldsplit"});
  expect_refused(box(refine), {"refine.0.to", "leaves no centre of an element in the box along x"},
                 {"refine.0.to=[\"2.9 m\", \"4 m\"]"}); // the first one is at 3 m
  expect_refused(box(refine), {"refine.0.to", "leaves elements at one side of two that are tied"},
                 {"mesh.sides=tied", "refine.0.from=[\"0 m\", \"1 m\"]"});
  const WarningsTaken said;
  parse_column_scene(box(refine), "s", {"refine.0.to=[\"5 m\", \"50 m\"]"});
  ASSERT_EQ(said.lines.size(), 1u);
  EXPECT_THAT(said.lines[0], testing::HasSubstr("refine.0 goes beyond the soil; it covers 2 to 5 m, 1 to "));
  parse_column_scene(box(refine), "s", {"refine.0.levels=8"});
  ASSERT_EQ(said.lines.size(), 2u);
  EXPECT_THAT(said.lines[1], testing::HasSubstr("refine.0 makes about "));
}

TEST(BoxScene, WithoutWallsAllIsAsItWas)
{
  const ColumnScene scene = parse_column_scene(sand + dry + dynamic, "s");
  EXPECT_EQ(scene.mesh.sides, Sides::tied);
  EXPECT_TRUE(mesh_spec(scene).ground.is_level());
  EXPECT_EQ(mesh_spec(scene).line[0], 0);
}

const std::string plate = "[water]\ndrainage = \"dry\"\n[analysis]\nkind = \"plate\"\ndisplacement = \"-0.2 m\"\n";

std::string with_plate(const std::string &of_mesh = "", const std::string &more = "")
{
  return sand + "[mesh]\ndimension = 2\nwidth = \"10 m\"\ncells_across = 5\nsides = \"walls\"\n" + of_mesh + plate +
         more;
}

TEST(BoxScene, PlatesComeThroughTextAndGoToTheMesh)
{
  const ColumnScene scene = parse_column_scene(
      with_plate(ground,
                 "on = \"right\"\nfrom = \"0.5 m\"\nrough = false\nload_steps = 7\nrelaxation_iterations = 9\n"),
      "s");
  EXPECT_EQ(parse_column_scene(to_toml(scene), "again"), scene);
  EXPECT_EQ(scene.plate.displacement, -0.2);
  EXPECT_EQ(scene.load_steps.newton.relaxation_iterations, 9u);
  EXPECT_EQ(scene.plate.axis(), 0u);
  EXPECT_EQ(scene.plate.inwards(), -1);
  const MeshSpec mesh = mesh_spec(scene);
  ASSERT_EQ(mesh.patches.size(), 1u);
  EXPECT_EQ(mesh.patches[0].of, Face::x_high);
  EXPECT_EQ(mesh.patches[0].from, 0.5);
  EXPECT_EQ(mesh.patches[0].to, 2); // up to the ground there
  EXPECT_TRUE(mesh_spec(parse_column_scene(box(), "s")).patches.empty());
}

TEST(BoxScene, RefusesPlatesThatAreNone)
{
  expect_refused(with_plate("", "to = \"11 m\"\n"), {"analysis.to", "from 0 m to 11 m of 10 m"});
  expect_refused(with_plate(), {"analysis.displacement", "nothing moves"}, {"analysis.displacement=0 m"});
  expect_refused(with_plate(), {"analysis.displacement", "within +-", "taken as small"}, {"analysis.displacement=9 m"});
  expect_refused(with_plate("", "from = \"0.3 m\"\nto = \"1.3 m\"\n"), {"analysis.to", "boundaries between elements"});
  expect_refused(with_plate(), {"water.drainage", "\"dry\""}, {"water.drainage=coupled", "layer.0.permeability=1 m/s"});
  expect_refused(with_plate(), {"mesh.sides", "\"walls\" with a plate"}, {"mesh.sides=tied"});
  expect_refused(with_plate(), {"load.kind", "\"none\""}, {"load.kind=step", "load.amplitude=1 kPa"});
  expect_refused(with_plate("", "max_iterations = 0\n"), {"analysis.max_iterations", "relaxation_iterations"});
  expect_refused(box(), {"analysis.on", "only to plate"}, {"analysis.on=base"});
}

std::string block(const std::string &more = "")
{
  return sand + "[mesh]\ndimension = 2\ncells_across = 4\n" + dry + "[analysis]\nkind = \"biaxial\"\n" + more;
}

TEST(BiaxialScene, ComesThroughText)
{
  const ColumnScene scene = parse_column_scene(
      block("confinement = \"50 kPa\"\naxial_strain = -0.01\ntest_duration = \"7 s\"\nmap_every = 2\nload_steps = 3\n"
            "relaxation_iterations = 9\nnonlocal = { length = \"0.1 m\", stiffness = 2 }\n"
            "[analysis.weak]\ncells = 2\ncolumn = 1\nrow = 3\nfactor = 0.7\nrelative_density = 0.5\nrealisation = 4\n"),
      "s");
  EXPECT_EQ(parse_column_scene(to_toml(scene), "again"), scene);
  EXPECT_EQ(scene.biaxial.nonlocal.length, 0.1);
  EXPECT_EQ(scene.biaxial.weak.grains.relative_density, 0.5);
  const double width = scene.mesh.width / 4, height = scene.height() / cells_up(scene);
  for (unsigned column = 0; column < 4; ++column)
    for (unsigned row = 0; row < cells_up(scene); ++row)
      EXPECT_EQ(in_weak_zone(scene, {(column + 0.5) * width, 0, (row + 0.5) * height}),
                column >= 1 && column < 3 && row >= 3 && row < 5);
}

TEST(BiaxialScene, RefusesBlocksThatAreNone)
{
  expect_refused(block("[analysis.weak]\ncells = 4\ncolumn = 1\n"), {"analysis.weak.column", "out of the block"});
  expect_refused(block("weak = { cells = 4, row = 9 }\n"), {"analysis.weak", "analysis.weak.row", "out of the block"});
  expect_refused(block(), {"mesh.dimension", "must be 2"}, {"mesh.dimension=1"});
  expect_refused(block(), {"mesh.points", "Give points = 3"},
                 {"water.drainage=coupled", "layer.0.permeability=0 m/s", "mesh.points=2"});
  expect_refused(block("nonlocal.length = \"0.1 m\"\n"), {"analysis.nonlocal.length", "needs relaxation"});
  expect_refused(block("max_iterations = 0\n"), {"analysis.max_iterations", "relaxation_iterations"});
  expect_refused(block(), {"analysis.axial_strain", "must not be 0"}, {"analysis.axial_strain=0"});
  expect_refused(block(), {"load.surcharge", "has no effect on a biaxial block"}, {"load.surcharge=1 kPa"});
  expect_refused(block(), {"output.depths", "has no effect on a biaxial block"}, {"output.depths=[\"1 m\"]"});
}

TEST(BoxScene, RefusesKeysOfABoxWhereTheSidesAreTied)
{
  expect_refused(sand + dry + "[output]\nx = \"1 m\"\n" + dynamic, {"column.toml:9", "output.x", "belongs to a box"});
  expect_refused(sand + dry + "[load]\nsurcharge_to = \"1 m\"\n" + dynamic, {"load.surcharge_to", "sides = \"walls\""});
}

TEST(BoxScene, RefusesWhatCannotBeInABox)
{
  expect_refused(box(), {"mesh.sides", "2 and 3 dimensions only", "is 1"}, {"mesh.dimension=1"});
  expect_refused(box("", "ground_x = [\"0 m\", \"10 m\"]\nground_z = [\"5 m\", \"4 m\"]\n"),
                 {"mesh.ground_x", "in 3 dimensions give a mesh"}, {"mesh.dimension=3"});
  expect_refused(box("[base]\nkind = \"compliant\"\ndensity = \"2300 kg/m3\"\nshear_velocity = \"800 m/s\"\n"),
                 {"base.kind", "must be \"rigid\""});
  expect_refused(box("", ground), {"mesh.sides", "level next to each side", "Add a point of the same height"},
                 {"mesh.sides=free-field"});
  expect_refused(box(), {"load.surcharge_from", "on one side with a free field"},
                 {"mesh.sides=free-field", "load.surcharge=50 kPa", "load.surcharge_from=4 m"});
  expect_refused(box(), {"analysis.large_strain", "must be false"},
                 {"mesh.sides=free-field", "analysis.large_strain=true"});
  expect_refused(with_plate(), {"mesh.sides", "\"walls\" with a plate"}, {"mesh.sides=free-field"});
  expect_refused(box(), {"mesh.points", "at least the degree, 2"}, {"mesh.points=1"});
  expect_refused(box("[slope]\nangle = \"5 deg\"\n"), {"slope.angle", "ground_x"});
  expect_refused(box("[water]\ntable = \"1 m\"\n"), {"water.table", "must be 0 m"});
}

TEST(BoxScene, RefusesGroundThatIsNone)
{
  expect_refused(box("", "ground_x = [\"0 m\", \"10 m\"]\nground_z = [\"5 m\"]\n"),
                 {"column.toml:13: mesh.ground_z", "length 1", "mesh.ground_x 2;"});
  expect_refused(box("", "ground_z = [\"5 m\"]\n"), {"column.toml:12: mesh.ground_z", "length 1", "mesh.ground_x 0;"});
  expect_refused(box("", "ground_x = [\"0 m\", \"10 m\"]\n"), {"column.toml:12: mesh.ground_x", "needs mesh.ground_z"});
  expect_refused(box("", "ground_x = [\"3 m\", \"3 m\"]\nground_z = [\"5 m\", \"4 m\"]\n"), {"3 m after 3 m"});
  expect_refused(box("", "ground_x = [\"0 m\", \"10 m\"]\nground_z = [\"4 m\", \"3 m\"]\n"),
                 {"mesh.ground_z", "must reach 5 m", "reaches 4 m"});
}

TEST(BoxScene, RefusesPlacesOutside)
{
  expect_refused(box("[output]\ndepths = [\"4.6 m\"]\n", ground), {"output.depths", "[0 m, 4.5 m]"});
  expect_refused(box("[load]\nsurcharge_to = \"4.5 m\"\n", "cells_across = 10\n"),
                 {"load.surcharge_to = 4.5 m", "boundary between elements", "1 m wide"});
  expect_refused(box("[load]\nsurcharge_to = \"10 m\"\n", "cells_across = 10\n"), {"load.surcharge_to", "left out"});
  expect_refused(box("", "cells_across = 10\nground_x = [\"0 m\", \"4.5 m\", \"10 m\"]\n"
                         "ground_z = [\"5 m\", \"5 m\", \"2 m\"]\n"),
                 {"mesh.ground_x", "boundaries between elements", "4.5 m"});
  expect_refused(box("[output]\nx = \"10 m\"\n"), {"output.x", "[0 m, 10 m)"});
  expect_refused(box("[load]\nsurcharge_to = \"11 m\"\n"), {"load.surcharge_to", "from 0 m to 11 m of 10 m"});
  expect_refused(box("[load]\nsurcharge_from = \"5 m\"\nsurcharge_to = \"4 m\"\n"), {"from 5 m to 4 m"});
}
} // namespace
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// Which settings make a path. Paths of packings: tests/verification/path_test.cpp.
#include "dem/drive/stages/path.hpp"

#include "base/error.hpp"
#include "dem/drive/programme.hpp"
#include "dem/scene/scene.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
std::string scene(const std::string &stage)
{
  return "[contact]\nfriction = \"18 deg\"\n[specimen]\npreparation_friction = \"10 deg\"\ndomain = \"periodic-cell\"\n"
         "[[stage]]\nkind = \"path\"\n" +
         stage;
}

std::string complaint(const std::string &stage)
{
  try
    {
      parse_scene(scene(stage), "s.toml");
      return "";
    }
  catch (const InputError &error)
    {
      return error.what();
    }
}

TEST(PathKeys, SayWhatEachComponentDoes)
{
  const Scene read = parse_scene(scene("drive = \"y\"\nb = 0.5\nx = { keep = \"stress\", stress = \"300 kPa\" }\n"
                                       "z.keep = \"b\"\nturn = { low = \"-10 kPa\", high = \"50 kPa\" }\n"
                                       "until = { cycles = 3, q = \"70 kPa\" }\n"),
                                 "s.toml");
  const auto &path = *as<Path>(read.stages[0]);
  EXPECT_EQ(path.components[0].keep, PathCondition::stress);
  EXPECT_EQ(path.components[0].stress, 300e3);
  EXPECT_EQ(path.components[2].keep, PathCondition::b);
  EXPECT_EQ(path.turn.low, -10e3);
  EXPECT_EQ(path.end.cycles, 3u);
  EXPECT_EQ(path.end.q, 70e3);
  EXPECT_EQ(parse_scene(to_toml(read), "again.toml"), read);
}

TEST(PathKeys, ThatMakeNoPathAreRefused)
{
  const std::string until = "until.strain = 0.01\n";
  for (const auto &[stage, part] : std::initializer_list<std::pair<std::string, std::string>>{
           {"", "nothing ends it"},
           {until + "y.keep = \"stress\"", "y is driven"},
           {until + "x = { keep = \"strain\", stress = \"1 kPa\" }", "x.stress goes with"},
           {until + "x = { keep = \"stress\", strain_ratio = 1 }", "x.strain_ratio goes with"},
           {until + "x.keep = \"b\"\nz.keep = \"b\"", "one axis keeps it"},
           {until + "drive = \"none\"\ny.keep = \"b\"", "y cannot keep it"},
           {until + "xy.keep = \"volume\"", "xy.keep must be"},
           {until + "mean_stress = \"1 kPa\"", "mean_stress needs an axis"},
           {until + "drive = \"none\"\nturn.strain = 0.1", "turn needs a driven component"},
           {until + "turn = { low = \"2 kPa\", high = \"1 kPa\" }", "turn.low must be below"},
           {"until.cycles = 2\nuntil.strain = 0.1", "until.cycles needs turn"},
           {until + "table = \"a.csv\"\nx = { keep = \"stress\", stress = \"1 kPa\" }", "a table excludes"}})
    EXPECT_NE(complaint(stage).find(part), std::string::npos) << stage << "\n" << complaint(stage);
}

TEST(PathKeys, ShearNeedsTheCell)
{
  const std::string text = scene("drive = \"xy\"\nuntil.strain = 0.1\n");
  EXPECT_NO_THROW(parse_scene(text, "s.toml"));
  EXPECT_THROW(parse_scene(text, "s.toml", {"specimen.domain=rigid-box"}), InputError);
}

TEST(PathTurn, ASpecimenOutsideOfItsLoadsIsRefused)
{
  Path path;
  path.turn = {.low = 20e3, .high = 60e3};
  path.end.cycles = 1;
  Assembly assembly(test::specimen(300, 10));
  DriveState state;
  test::Unobserved nobody;
  try
    {
      run_programme({.record = {}, .stages = {path}}, assembly, state, nobody);
      FAIL() << "an isotropic specimen was cycled between 20 and 60 kPa";
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find("outside of turn.low = 20"), std::string::npos) << error.what();
    }
}
} // namespace
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// Which settings make a path. Paths of packings: tests/verification/path_test.cpp.
#include "dem/drive/stages/path.hpp"

#include "base/error.hpp"
#include "dem/drive/programme.hpp"
#include "dem/scene/scene.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/specimens.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

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
  return test::refusal([&] { parse_scene(scene(stage), "s.toml"); });
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
           {until + "turn.low = \"-2 kPa\"",
            "turn.low alone turns it once and never back; give turn.high, or turn.strain"},
           {until + "turn.strain = 0.01", "a path that turns may never end; give until.cycles or max_steps"},
           {until + "turn.high = \"2 kPa\"", "turn.high alone turns it once and never back; give turn.low"},
           {"drive = \"none\"", "nothing is prescribed"},
           {until + "drive = \"none\"\nx.keep = \"stress\"\nmax_steps = 10", "nothing is prescribed"},
           {until + "drive = \"none\"\nx.keep = \"p\"\ny.keep = \"p\"", "nothing is prescribed"},
           {"until.cycles = 2\nuntil.strain = 0.1", "until.cycles needs turn"},
           {until + "table = \"a.csv\"\nx = { keep = \"stress\", stress = \"1 kPa\" }", "a table excludes"}})
    EXPECT_NE(complaint(stage).find(part), std::string::npos) << stage << "\n" << complaint(stage);
}

TEST(PathKeys, OfOneLoadAndAStrainOrOfAnIntermediateStressMakeAPath)
{
  for (const char *stage :
       {"turn = { low = \"-20 kPa\", strain = 0.01 }\nuntil.cycles = 3", "turn.strain = 0.01\nuntil.cycles = 3",
        "drive = \"none\"\nmean_stress = \"300 kPa\"\nx.keep = \"p\"",
        "drive = \"none\"\ny.keep = \"stress\"\nz.keep = \"b\"\nb = 0.5"})
    EXPECT_EQ(complaint(stage), "accepted") << stage;
}

/// Loads that do not hold q = 0 or tau = 0 are refused where the scene says that these are what a stage begins with.
TEST(StaticBias, ThatIsotropicConsolidationCannotGiveIsRefusedAtReading)
{
  const std::string
      triaxial = "[[stage]]\nkind = \"undrained-cyclic\"\ndeviator_average = \"80 kPa\"\n"
                 "deviator_amplitude = \"40 kPa\"\n",
      shear = "[[stage]]\nkind = \"undrained-cyclic-simple-shear\"\nstatic_stress_ratio = -0.3\n"
              "stress_ratio = 0.1\n",
      path = "[[stage]]\nkind = \"path\"\nturn = { low = \"10 kPa\", high = \"50 kPa\" }\nuntil.cycles = 3\n",
      compress = "[[stage]]\nkind = \"compress\"\npressure = \"100 kPa\"\n",
      friction = "[[stage]]\nkind = \"friction\"\nfriction = \"9 deg\"\n",
      anisotropic = "[[stage]]\nkind = \"path\"\ndrive = \"none\"\ny = { keep = \"stress\", stress = \"300 kPa\" }\n",
      hold = "[[stage]]\nkind = \"hold\"\n", k0 = "[[stage]]\nkind = \"k0-compress\"\n",
      limited = compress + "max_steps = 10\n";
  const auto message = [](const std::string &stages, const std::vector<std::string> &set = {}) -> std::string {
    const std::string head = "[contact]\nfriction = \"18 deg\"\n[specimen]\npreparation_friction = \"10 deg\"\n"
                             "domain = \"periodic-cell\"\n"; // six lines with the last stage's first
    return test::refusal([&] { parse_scene(head + stages, "s.toml", set); });
  };
  EXPECT_EQ(message(triaxial).find("s.toml:8: stage.0.deviator_average = 80 kPa; cannot be held after isotropic "
                                   "consolidation to 200 kPa: q = 0 kPa when it begins, outside of the loads"),
            0u)
      << message(triaxial);
  EXPECT_NE(message(shear).find("s.toml:8: stage.0.static_stress_ratio"), std::string::npos) << message(shear);
  EXPECT_NE(message(path).find("s.toml:8: stage.0.turn.low = 10 kPa; cannot"), std::string::npos) << message(path);
  for (const std::string &before :
       {compress, compress + friction, compress + "[[stage]]\nkind = \"repeat\"\ntimes = 2\n"})
    EXPECT_NE(message(before + triaxial).find("to 100 kPa"), std::string::npos) << before << message(before + triaxial);
  for (const std::string &before :
       {anisotropic, compress + hold, compress + k0, limited, compress + anisotropic + friction})
    EXPECT_EQ(message(before + triaxial), "accepted") << before;
  for (const char *set : {"specimen.consolidation=k0", "specimen.file=a.h5", "stage.0.deviator_average=0 kPa",
                          "stage.0.deviator_average=40.5 kPa", "stage.0.deviator_amplitude=90 kPa"})
    EXPECT_EQ(message(triaxial, {set}), "accepted") << set;
}

using ScenesOnDisk = TemporaryFolder;

/// The written form of a scene has its default loads, and would be refused.
TEST_F(ScenesOnDisk, DefaultLoadsCountAsWell)
{
  const std::string text = "[specimen]\npreparation_friction = \"10 deg\"\n[[stage]]\nkind = "
                           "\"undrained-cyclic\"\ndeviator_average = \"80 kPa\"\n";
  EXPECT_THAT(test::refusal([&] { parse_scene(text, "s.toml"); }),
              testing::StartsWith("s.toml:5: stage.0.deviator_average = 80 kPa; cannot be held"));
  const std::string path = put("s.toml", text).string();
  EXPECT_THAT(test::refusal([&] { read_scene(path); }), testing::HasSubstr("cannot be held"));
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
  EXPECT_THAT(test::refusal([&] { run_programme({.record = {}, .stages = {path}}, assembly, state, nobody); }),
              testing::HasSubstr("outside of the loads turn.low = 20"));
}
} // namespace
} // namespace isostat

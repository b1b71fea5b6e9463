// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/given_packing.hpp"

#include "base/error.hpp"
#include "dem/prepare/specimen.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Scene scene(const std::string &grading, const std::string &contact, const std::string &more,
            const std::string &stage = "kind = \"hold\"")
{
  return parse_scene("[grading]\n" + grading + "\n[contact]\n" + contact +
                         "\n[specimen]\ndomain = \"periodic-cell\"\n" + more + "\n[[stage]]\n" + stage + "\n",
                     "s");
}

constexpr const char *usual = "friction = \"18 deg\"\nyoung = \"1 GPa\"", *file = "file = \"p.h5\"";

/// Two grains in a cell that press on each other, made as usual.
Specimen pressed()
{
  Specimen made;
  Snapshot &s = made.state;
  s.law = scene("", usual, file).contact;
  s.grains = make_packing({Vec3(1e-3, 1e-3, 1e-3), Vec3(2.99e-3, 1e-3, 1e-3)}, {1e-3, 1e-3}, 2650);
  s.cell = PeriodicCell::with_edges(Vec3(5e-3, 4e-3, 4e-3));
  const double overlap = 1e-5, force = s.law->normal_force(1e-3, 1e-3, overlap);
  s.contacts = {{0, 1, overlap, force, {.normal = Vec3::UnitX()}}};
  made.numbers = {{"seed", 7}, {"preparation_friction_deg", 8}};
  return made;
}

std::vector<std::string> notes(const Scene &s) { return check_given_packing(s, pressed(), "p.h5"); }

/// At the pressure that the contact carries.
std::string at_pressure(const std::string &more = file)
{
  const double p = 1e-3 * pressed().state.contacts[0].normal_force * 1.99e-3 / 3 / 80e-9;
  return more + "\npressure = \"" + std::to_string(p) + " kPa\"";
}
} // namespace

TEST(GivenPacking, WhatAgreesIsNoNews) { EXPECT_THAT(notes(scene("", usual, at_pressure())), ElementsAre()); }

TEST(GivenPacking, ItsOwnValuesCountAndAreNamed)
{
  const std::vector<std::string> found =
      notes(scene("grains = 800\nd50 = \"1 mm\"\nseed = 3\ndensity = \"2700 kg/m3\"", usual, at_pressure()));
  ASSERT_EQ(found.size(), 1u);
  for (const char *part : {"p.h5: is taken as it is", "grading.grains = 800 (2)", "grading.d50 = 1 mm (2 mm)",
                           "grading.seed = 3 (7)", "grading.density = 2700 kg/m3 (2650 kg/m3)"})
    EXPECT_THAT(found[0], HasSubstr(part));
  EXPECT_THAT(notes(scene("", usual, at_pressure("preparation_friction = \"12 deg\""))),
              ElementsAre(HasSubstr("specimen.preparation_friction = 12 deg (8 deg)")));
  EXPECT_THAT(notes(scene("", usual, at_pressure("void_ratio = 0.7"))),
              ElementsAre(HasSubstr("specimen.void_ratio = 0.7 (8.5")));
  EXPECT_THAT(notes(scene("", usual, at_pressure("relative_density = 0.5"))),
              ElementsAre(HasSubstr("specimen.relative_density = 0.5 (-28")));
  EXPECT_THAT(notes(scene("", usual, "file = \"p.h5\"\npressure = \"150 kPa\"")),
              ElementsAre(HasSubstr("specimen.pressure = 150 kPa; the test starts from what it has")));
  EXPECT_THAT(notes(scene("", usual, file)), ElementsAre()) << "a default";
}

TEST(GivenPacking, DefaultsThatAreWrittenCountAsOtherValues)
{
  EXPECT_THAT(notes(scene("", usual, "file = \"p.h5\"\npressure = \"200 kPa\"")),
              ElementsAre(HasSubstr("specimen.pressure = 200 kPa; the test starts from what it has")));
  const std::vector<std::string> found = notes(
      scene("grains = 10000\nseed = 1\ncurve = \"karlsruhe-fine-sand\"\ntruncate = [0, 100]\ncloud_edge = \"10 mm\"\n"
            "solid_fraction = 0.33\ndensity = \"2650 kg/m3\"",
            usual, at_pressure()));
  ASSERT_EQ(found.size(), 1u);
  for (const char *part :
       {"grading.grains = 10000 (2)", "grading.seed = 1 (7)", "grading.curve = \"karlsruhe-fine-sand\" (grains of 2 to",
        "grading.truncate = [0, 100] (", "grading.cloud_edge = 10 mm (", "grading.solid_fraction = 0.33 ("})
    EXPECT_THAT(found[0], HasSubstr(part));
  EXPECT_THAT(found[0], Not(HasSubstr("density")));
  Specimen heavy = pressed();
  heavy.state.grains.density = 3000;
  EXPECT_THAT(check_given_packing(scene("", usual, at_pressure()), heavy, "p.h5"), ElementsAre()) << "no density said";
  EXPECT_THAT(check_given_packing(scene("density = \"2650 kg/m3\"", usual, at_pressure()), heavy, "p.h5"),
              ElementsAre(HasSubstr("grading.density = 2650 kg/m3 (3000 kg/m3)")));
  const Scene said = scene("", usual, "file = \"p.h5\"\npressure = \"200 kPa\""),
              again = parse_scene(to_toml(said), "s");
  EXPECT_EQ(again, said);
  EXPECT_EQ(notes(again).size(), 1u) << to_toml(said);
  EXPECT_THAT(notes(parse_scene(to_toml(scene("", usual, file)), "s")), ElementsAre()) << "still left out";
}

TEST(GivenPacking, SizesAreThoseThatTheGradingWouldMake)
{
  const auto notes_of = [](const std::string &grading) { return notes(scene(grading, usual, at_pressure())); };
  const std::string two_percent = "table = [[\"1.98 mm\", 0], [\"2.02 mm\", 100]]\n";
  EXPECT_THAT(notes_of(two_percent + "cloud_edge = \"2.9397 mm\""), ElementsAre()) << "the solid volume of the grains";
  EXPECT_THAT(notes_of(two_percent + "cloud_edge = \"3.1 mm\""),
              ElementsAre(HasSubstr("grading.cloud_edge = 3.1 mm (grains of 2 to 2 mm)")));
  EXPECT_THAT(notes_of("table = [[\"1 mm\", 0], [\"2.02 mm\", 100]]\nd50 = \"2 mm\""),
              ElementsAre(HasSubstr("grading.table = 2 sizes (grains of 2 to 2 mm)")));
  EXPECT_THAT(notes_of("truncate = [0, 90]"), ElementsAre(HasSubstr("grading.truncate = [0, 90] (")));
}

TEST(GivenPacking, AnotherWayToASpecimenIsNamed)
{
  Specimen given = pressed();
  given.provenance["consolidation"] = "isotropic";
  EXPECT_THAT(
      check_given_packing(scene("", usual, at_pressure("preparation_friction = \"8 deg\"\nconsolidation = \"k0\"")),
                          given, "p.h5"),
      testing::Contains(HasSubstr("specimen.consolidation = k0 (isotropic)")));
  EXPECT_THAT(check_given_packing(scene("", usual, at_pressure()), given, "the specimen that is given"),
              ElementsAre(HasSubstr("specimen.file = p.h5 (the specimen that is given)")));
}

TEST(GivenPacking, AnotherStiffnessNeedsConsolidation)
{
  const std::string stiff = "friction = \"18 deg\"\nyoung = \"5 GPa\"";
  EXPECT_THAT(message_of<InputError>([&] { notes(scene("", stiff, at_pressure())); }),
              HasSubstr("p.h5: was made with another contact stiffness than contact.young = 5 GPa (1 GPa): its normal "
                        "forces would change by 400 % at once"));
  for (const char *stage : {"kind = \"rebalance\"", "kind = \"compress\"\npressure = \"50 kPa\"",
                            "kind = \"friction\"\nfriction = \"9 deg\"\n[[stage]]\nkind = \"rebalance\""})
    EXPECT_THAT(notes(scene("", stiff, file, stage)), ElementsAre(HasSubstr("by 400 % at once; the first stage")));
  EXPECT_THAT(message_of<InputError>([&] { notes(scene("", "law = \"hertz-mindlin\"\nfriction = \"18 deg\"", file)); }),
              HasSubstr("contact.law = \"hertz-mindlin\" (\"linear-rolling\")"));
  const std::string ratio = std::string(usual) + "\nstiffness_ratio = 0.5"; // forces stay as they are
  EXPECT_THAT(notes(scene("", ratio, at_pressure())), ElementsAre());
}

TEST(GivenPacking, AWarningNamesLessFriction)
{
  EXPECT_THAT(notes(scene("", "young = \"1 GPa\"\nfriction = \"5 deg\"", at_pressure())),
              ElementsAre(HasSubstr("in balance with a friction of 18 deg and tested with 5 deg")));
  EXPECT_THAT(notes(scene("", "young = \"1 GPa\"\nfriction = \"25 deg\"", at_pressure())), ElementsAre());
}

TEST(GivenPacking, DefaultLimitsBelongToTheGrainsOfThePaper)
{
  const auto foreign = [](const std::string &grading, const std::string &contact) {
    return foreign_to_default_limits(scene(grading, contact, "preparation_friction = \"8 deg\""));
  };
  const std::string rolling = "\nrolling = { stiffness = 0.3, limit = 0.5 }";
  EXPECT_EQ(foreign("", usual + rolling), "");
  EXPECT_EQ(foreign("", usual), "no contact.rolling");
  EXPECT_EQ(
      foreign("truncate = [10, 90]", "friction = \"25 deg\"\nrolling = { limit = 0.2 }"),
      "contact.friction = 25 deg, contact.rolling = { stiffness = 0.3, limit = 0.2 }, grading.truncate = [10, 90]");
  EXPECT_EQ(foreign("", "law = \"hertz-mindlin\"\nfriction = \"18 deg\"" + rolling), "") << "the same resistance";
}

TEST(GivenPacking, SceneIsWrittenWithoutDefaultsOfWhatThePackingHas)
{
  const std::string head =
      "[grading]\ngrains = 800\ndensity = \"2700 kg/m3\"\n[specimen]\npressure = \"50 kPa\"\nfile = ";
  const auto written = [&](const std::string &name, const std::string &kind) {
    return to_toml(parse_scene(head + name + "\n[[stage]]\nkind = \"" + kind + "\"\n", "s"));
  };
  const auto holds = [](const std::string &text, const char *key) { return text.find(key) != std::string::npos; };
  const std::string stored = written("\"a.h5#s0001\"", "hold"), rebalanced = written("\"a.h5\"", "rebalance");
  for (const std::string &text : {stored, rebalanced})
    {
      for (const char *key : {"seed", "truncate", "cloud_edge"})
        EXPECT_FALSE(holds(text, key)) << key << "\n" << text;
      for (const char *key : {"\ngrains = 800", "density = \"2700 kg/m3\"", "pressure = \"50 kPa\""})
        EXPECT_TRUE(holds(text, key)) << key << " is held against the packing\n" << text;
    }
  EXPECT_EQ(to_toml(parse_scene(stored, "s")), stored);
}

TEST(GivenPacking, NothingRemainsOfItsPreparation)
{
  const Scene k0 = scene("", usual, "relative_density = 0.5\nexpansion = 0.02\nconsolidation = \"k0\"");
  const SpecimenSpec given = without_preparation(k0.specimen);
  EXPECT_EQ(given.consolidation, "isotropic") << "else no scene with its file could be read";
  EXPECT_FALSE(given.relative_density || given.has_limits() || given.expansion > 0);
  const SpecimenSpec own = without_preparation(scene("", usual, "void_ratio = 0.7\ne_min = 0.5\ne_max = 0.8").specimen);
  EXPECT_FALSE(own.void_ratio);
  EXPECT_TRUE(own.has_limits());
}

TEST(Recipe, NamesAnExpansionButNoneThatIsNot)
{
  const std::string plain = specimen_recipe(scene("", usual, "relative_density = 0.5")),
                    none = specimen_recipe(scene("", usual, "relative_density = 0.5\nexpansion = 0")),
                    opened = specimen_recipe(scene("", usual, "relative_density = 0.5\nexpansion = 0.02"));
  EXPECT_EQ(none, plain) << "specimens of older caches stay";
  EXPECT_NE(opened, plain);
  EXPECT_EQ(parse_scene(opened, "recipe").specimen.expansion, 0.02);
}
} // namespace isostat

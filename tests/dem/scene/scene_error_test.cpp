// SPDX-License-Identifier: BSD-3-Clause
// What a scene file or an override can have wrong, and the message for the user: place, value, allowed range, remedy.
#include "base/error.hpp"
#include "dem/scene/scene.hpp"
#include "tests/support/refusal.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using Overrides = std::vector<std::string>;

const std::string smallest = "[specimen]\nrelative_density = 0.64\n";

const std::string cell = smallest + "domain = \"periodic-cell\"\n";

/// See test::refusal().
std::string complaint(const std::string &text, const Overrides &overrides = {})
{
  return test::refusal([&] { parse_scene(text, "scene.toml", overrides); });
}

void expect_complaint(const std::string &text, const std::vector<std::string> &parts, const Overrides &overrides = {})
{
  test::expect_parts(complaint(text, overrides), parts);
}

std::string cyclic_with(const std::string &line)
{
  return smallest + "[[stage]]\nkind = \"undrained-cyclic\"\n" + line + "\n";
}

TEST(SceneError, UnknownKeyNamesTheNearest)
{
  expect_complaint(smallest + "[motion]\ndampin = 0.2",
                   {"scene.toml:4: motion.dampin = 0.2;", "Did you mean motion.damping?"});
  expect_complaint(smallest + "[motion]\nzzz = 1",
                   {"scene.toml:4: motion.zzz = 1; is an unknown key", "--print-defaults"});
  expect_complaint("damping = 0.2\n" + smallest, {"scene.toml:1: damping", "Did you mean", "damping?"});
  expect_complaint(smallest + "[motoin]\ndamping = 0.2", {"motoin; is an unknown key", "Did you mean motion?"});
  expect_complaint(cyclic_with("amplitude = \"60 kPa\""),
                   {"scene.toml:5: stage.0.amplitude", "Did you mean stage.deviator_amplitude?"});
  expect_complaint(cyclic_with("until = { cycle = 3 }"),
                   {"stage.0.until.cycle = 3", "Did you mean stage.until.cycles?"});
  expect_complaint("\"motion.damping\" = 0.2\n" + smallest, {"scene.toml:1: \"motion.damping\"", "Remove the quotes"});
}

TEST(SceneError, PressureThatNoContactCarries)
{
  expect_complaint(smallest + "pressure = \"200 MPa\"\n[contact]\nyoung = \"1 GPa\"",
                   {"scene.toml:3: specimen.pressure", "must be at most 50000 kPa", "contact.young = 1 GPa"});
  expect_complaint(smallest + "[contact]\nyoung = \"1 MPa\"", {"specimen.pressure", "must be at most 50 kPa"});
  expect_complaint(smallest + "[contact]\nlaw = \"hertz-mindlin\"\nyoung = \"1 MPa\"",
                   {"specimen.pressure", "must be at most 19.", "contact.young = 0.001 GPa"});
}

TEST(SceneError, UnitsAndForms)
{
  expect_complaint(
      smallest + "pressure = 200",
      {"scene.toml:3: specimen.pressure = 200; must be a pressure with its unit", "Give for example \"200 kPa\"."});
  expect_complaint(smallest + "pressure = \"200\"",
                   {"specimen.pressure = 200; must be a pressure", "no unit is given"});
  expect_complaint(smallest + "pressure = \"10 mm\"", {"scene.toml:3:", "but mm is the unit of a length"});
  expect_complaint(smallest + "pressure = \"10 psi\"", {"\"psi\" is none of these units"});
  expect_complaint(smallest + "e_min = \"0.5\"", {"scene.toml:3:", "plain number without unit or quotes"});
  expect_complaint(smallest + "[grading]\ngrains = 1e4", {"scene.toml:4: grading.grains", "whole number"});
  expect_complaint(smallest + "[grading]\ngrains = 2000.0", {"whole number"});
  expect_complaint(smallest + "[grading]\nseed = -1", {"grading.seed = -1; must be >= 0"});
  expect_complaint(smallest + "[output]\nenergy = \"yes\"", {"output.energy = yes; must be true or false"});
  expect_complaint(smallest + "[output]\nsnapshots = \"often\"", {"must be \"none\", \"reversals\" or \"strain\""});
  expect_complaint(smallest + "[output]\nfolder = 3", {"output.folder = 3; must be text in quotes"});
  expect_complaint("title = 3\n" + smallest, {"scene.toml:1: title = 3; must be text in quotes"});
  expect_complaint("motion = 3\n" + smallest, {"scene.toml:1: motion = 3; must be a table"});
  expect_complaint(smallest + "[contact]\nfriction = \"1 deg\"\nrolling = 0.3",
                   {"scene.toml:5: contact.rolling = 0.3", "{ stiffness = 0.3, limit = 0.5 }"});
}

TEST(SceneError, Ranges)
{
  EXPECT_EQ(
      complaint(smallest + "[contact]\nfriction = \"95 deg\""),
      "scene.toml:4: contact.friction = 95 deg; must be in [0 deg, 90 deg) because tan() is used. Give for example "
      "\"18 deg\".");
  for (const char *value : {"1e300", "-1e-300", "1.01e30", "0.99e-30"})
    expect_complaint(
        smallest + fmt::format("[contact]\nrolling = {{ stiffness = {}, limit = 1 }}", value),
        {"rolling.stiffness = ", "must be between 1e-30 and 1e+30 in size, because products of larger or"});
  for (const char *value : {"1e30", "1e-30"})
    expect_complaint(smallest + fmt::format("[contact]\nfriction = \"18 deg\"\nrolling = {{ limit = {} }}", value),
                     {"accepted"});
  expect_complaint(smallest + "pressure = \"1e-40 kPa\"", {"in size (in SI units), because"});
  expect_complaint(smallest + "pressure = \"1e-10 kPa\"", {"must be in [0.001 kPa, 1e9 kPa] because less is"});
  expect_complaint(smallest + "[contact]\nstiffness_ratio = 20", {"must be in (0, 10] because without tangential"});
  for (const char *angle : {"90 deg", "185 deg", "-1 deg", "1.6 rad"})
    expect_complaint(smallest + fmt::format("[contact]\nfriction = \"{}\"", angle), {"must be in [0 deg, 90 deg)"});
  expect_complaint(smallest + "[motion]\ndamping = 1.0", {"motion.damping = 1", "must be in [0, 1)", "no grain"});
  for (const char *value : {"-0.1", "2"})
    expect_complaint(smallest + fmt::format("[motion]\ndamping = {}", value), {"must be in [0, 1)"});
  for (const char *value : {"nan", "inf", "-inf"})
    expect_complaint(smallest + fmt::format("[motion]\ndamping = {}", value), {"must be a finite number. Give"});
  expect_complaint(smallest + "pressure = \"0 kPa\"", {"must be in [0.001 kPa, 1e9 kPa]"});
  expect_complaint(smallest + "[grading]\ngrains = 1", {"must be in [2, 100000000]"});
  expect_complaint(cyclic_with("until = { strain = 15 }"),
                   {"stage.0.until.strain = 15; must be in (0, 1]", "not percent"});
  expect_complaint("[specimen]\nrelative_density = 64", {"scene.toml:2:", "must be in [0, 1]", "e_max"});
}

TEST(SceneError, StageKeysBelongToTheirKind)
{
  const std::string monotonic = smallest + "[[stage]]\nkind = \"undrained-monotonic\"\nstrain = 0.05\n";
  EXPECT_EQ(complaint(monotonic), "accepted");
  expect_complaint(monotonic + "deviator_amplitude = \"60 kPa\"",
                   {"scene.toml:6: stage.0.deviator_amplitude = 60 kPa; does not belong to a stage of kind "
                    "\"undrained-monotonic\", only to undrained-cyclic."});
  expect_complaint(monotonic + "until = { cycles = 3 }", {"stage.0.until; does not belong"});
  expect_complaint(cyclic_with("strain = 0.05"), {"stage.0.strain = 0.05; does not belong"});
  expect_complaint(smallest + "[[stage]]\nkind = \"hold\"\n[[stage]]\nkind = \"friction\"\nbalance = 0.1",
                   {"scene.toml:7: stage.1.balance"});
  expect_complaint(smallest + "[[stage]]\nkind = \"shear\"",
                   {"scene.toml:4: stage.0.kind = shear; must be \"compress\""});
}

TEST(SceneError, StrainMeansWhatItsKindDoes)
{
  const std::string axial = "[[stage]]\nkind = \"drained\"\nstrain = 1.5",
                    shear = "[[stage]]\nkind = \"undrained-simple-shear\"\nstrain = ",
                    cyclic = "[[stage]]\nkind = \"undrained-cyclic-simple-shear\"\n";
  expect_complaint(cell + axial, {"scene.toml:6: stage.0.strain = 1.5; must be in (0, 1]", "not percent"});
  EXPECT_EQ(complaint(cell + shear + "1.5"), "accepted");
  for (const char *wrong : {"0", "-0.1", "10.1", "20"})
    expect_complaint(cell + shear + wrong, {"scene.toml:6: stage.0.strain", "must be in (0, 10]", "1 is 100 percent",
                                            "Give for example 0.2."});
  expect_complaint(cell + cyclic + "until = { strain = 15 }",
                   {"scene.toml:6: stage.0.until.strain = 15; must be in (0, 10]", "shear strain"});
  for (const char *wrong : {"0", "-0.15", "1.01", "15"})
    expect_complaint(cell + cyclic + "stress_ratio = " + wrong,
                     {"scene.toml:6: stage.0.stress_ratio", "must be in (0, 1]", "Give for example 0.15."});
  expect_complaint(cell + cyclic + "stress_ratio = \"30 kPa\"", {"scene.toml:6: stage.0.stress_ratio", "plain number"});
  // the kinds of both entries are named
  expect_complaint(cell + "[[stage]]\nkind = \"hold\"\nstrain = 0.1",
                   {"only to undrained-monotonic, drained, constant-p or undrained-simple-shear."});
}

TEST(SceneError, KeysOfTheNewKinds)
{
  const auto stage = [](const std::string &kind, const std::string &line) {
    return cell + "[[stage]]\nkind = \"" + kind + "\"\n" + line;
  };
  expect_complaint(stage("k0-compress", "strain = 0.1"), {"scene.toml:6: stage.0.strain", "does not belong"});
  expect_complaint(stage("k0-compress", "strain_rate = \"1 1/s\""), {"stage.0.strain_rate", "does not belong"});
  expect_complaint(stage("undrained-simple-shear", ""), {"scene.toml:4: stage.0.strain; is missing", "strain = 0.2"});
  expect_complaint(stage("undrained-simple-shear", "strain = 1\nstress_ratio = 0.1"),
                   {"scene.toml:7: stage.0.stress_ratio", "only to undrained-cyclic-simple-shear."});
  expect_complaint(stage("undrained-simple-shear", "strain = 1\nuntil = { cycles = 1 }"), {"stage.0.until"});
  expect_complaint(stage("undrained-simple-shear", "strain = 1\npressure = \"1 kPa\""), {"stage.0.pressure"});
  expect_complaint(stage("undrained-cyclic-simple-shear", "strain = 1"), {"stage.0.strain", "does not belong"});
  expect_complaint(stage("undrained-cyclic-simple-shear", "deviator_amplitude = \"60 kPa\""),
                   {"stage.0.deviator_amplitude", "only to undrained-cyclic."});
  expect_complaint(stage("undrained-cyclic", "stress_ratio = 0.1"), {"stage.0.stress_ratio", "does not belong"});
}

TEST(SceneError, WhatNeedsThePeriodicCell)
{
  for (const char *kind :
       {"k0-compress\"", "undrained-simple-shear\"\nstrain = 0.2", "undrained-cyclic-simple-shear\""})
    {
      const std::string stages = std::string("[[stage]]\nkind = \"hold\"\n[[stage]]\nkind = \"") + kind + "\n";
      EXPECT_EQ(complaint(cell + stages), "accepted");
      expect_complaint(smallest + stages,
                       {"scene.toml:6: stage.1.kind = ",
                        "; needs the periodic cell, but specimen.domain is \"rigid-box\" (scene.toml:1). Give domain = "
                        "\"periodic-cell\" in [specimen], or change the kind."});
      expect_complaint(cell + stages, {"stage.1.kind", "(--set specimen.domain)"}, {"specimen.domain=rigid-box"});
      EXPECT_EQ(complaint(smallest + stages, {"specimen.domain=periodic-cell"}), "accepted");
    }
  EXPECT_EQ(complaint(smallest + "consolidation = \"isotropic\""), "accepted");
  EXPECT_EQ(complaint(cell + "consolidation = \"k0\""), "accepted");
  expect_complaint(smallest + "consolidation = \"k0\"",
                   {"scene.toml:3: specimen.consolidation = k0; needs the periodic cell", "leave consolidation out."});
  expect_complaint(cell + "consolidation = \"K0\"", {"scene.toml:4:", "must be \"isotropic\" or \"k0\""});
  expect_complaint(cell + "consolidation = \"k0\"",
                   {"scene.toml:4: specimen.consolidation = k0; excludes specimen.file (--set specimen.file): the file "
                    "says how it was consolidated. Leave consolidation out"},
                   {"specimen.file=a.h5"});
  EXPECT_EQ(complaint(cell, {"specimen.file=a.h5"}), "accepted");
}

TEST(SceneError, MissingKeys)
{
  expect_complaint(smallest + "[[stage]]\nstrain = 0.05", {"scene.toml:3: stage.0.kind; is missing"});
  expect_complaint(smallest + "[[stage]]\nkind = \"drained\"",
                   {"scene.toml:3: stage.0.strain; is missing", "Give for example strain = 0.05"});
  expect_complaint(smallest + "[[stage]]\nkind = \"friction\"", {"stage.0.friction; is missing"});
  expect_complaint("stage = []\n" + smallest, {"scene.toml:1: stage", "at least one stage"});
  expect_complaint("stage = [3]\n" + smallest, {"scene.toml:1: stage.0 = 3; must be a table"});
  expect_complaint(smallest + "[stage]\nkind = \"hold\"", {"scene.toml:3: stage", "[[stage]]"});
  EXPECT_TRUE(parse_scene(smallest, "scene.toml").stages.empty());
}

TEST(SceneError, KeysThatExcludeEachOther)
{
  expect_complaint("[specimen]\n", {"scene.toml:1: specimen; must have exactly one of relative_density, void_ratio, "
                                    "preparation_friction, file."});
  expect_complaint("", {"scene.toml: specimen; must have exactly one of"});
  for (const char *other : {"void_ratio = 0.7", "preparation_friction = \"10 deg\"", "file = \"a.h5\""})
    {
      EXPECT_EQ(complaint(std::string("[specimen]\n") + other), "accepted");
      expect_complaint(smallest + other,
                       {"scene.toml:3: specimen.", "excludes specimen.relative_density (scene.toml:2)"});
    }
  expect_complaint(smallest + "[motion]\nstrain_rate = \"0.5 1/s\"\ninertial_number = 1e-4",
                   {"motion.strain_rate = 0.5 1/s", "excludes motion.inertial_number (scene.toml:5)"});
  expect_complaint(smallest + "[motion]\nincrement = 1e-6",
                   {"motion.increment", "no effect with motion.drive = \"dynamic\""});
  for (const char *key : {"inertial_number = 1e-4", "strain_rate = \"1 1/s\"", "load_per_wave = 0.1"})
    expect_complaint(smallest + "[motion]\ndrive = \"static\"\n" + key, {"no effect with motion.drive = \"static\""});
  expect_complaint(smallest + "[motion]\ndrive = \"static\"",
                   {"motion.drive = static; has no effect, because no stage shears"});
  for (const char *number : {"0", "1", "-1e-4", "nan"})
    expect_complaint(smallest + "[motion]\ninertial_number = " + number, {"scene.toml:4: motion.inertial_number"});
  expect_complaint(smallest + "[motion]\ninertial_number = \"1e-4 1/s\"", {"scene.toml:4: motion.inertial_number"});
  expect_complaint(smallest + "[grading]\ncurve = \"karlsruhe-fine-sand\"\ntable = [[\"1 mm\", 0], [\"2 mm\", 100]]",
                   {"grading.table", "excludes grading.curve"});
  expect_complaint(
      smallest + "[grading]\ncloud_edge = \"5 mm\"\nd50 = \"0.45 mm\"\n",
      {"scene.toml:5: grading.d50 = 0.45 mm; excludes grading.cloud_edge (scene.toml:4). Keep one of them."});
  expect_complaint(smallest, {"--set grading.", "excludes"}, {"grading.cloud_edge=5 mm", "grading.d50=0.45 mm"});
  expect_complaint(smallest + "[grading]\nd50 = \"0 mm\"\n", {"scene.toml:4: grading.d50 = 0 mm; must be > 0 mm"});
  expect_complaint(smallest + "[grading]\nd50 = \"5 kPa\"\n", {"scene.toml:4: grading.d50 = 5 kPa", "a length"});
  const std::string table = "[grading]\ntable = [[\"1 mm\", 0], [\"2 mm\", 100]]\n[specimen]\n";
  expect_complaint(table + "relative_density = 0.5", {"scene.toml:4: specimen.relative_density = 0.5",
                                                      "e_min and e_max of this grading", "void_ratio_limits"});
  expect_complaint(table + "void_ratio = 0.7\ne_min = 0.5", {"scene.toml:5: specimen.e_min = 0.5", "the other limit"});
  expect_complaint(smallest + "e_min = 0.9", {"scene.toml:3: specimen.e_min = 0.9; e_min must be below e_max"});
  expect_complaint(smallest + "[[stage]]\nkind = \"friction\"\nfriction = \"18 deg\"",
                   {"stage.0.friction", "has no effect"});
  expect_complaint("[specimen]\nexpansion = 0.2", {"scene.toml:2", "specimen.expansion = 0.2", "in [0, 0.1]"});
  for (const std::string key : {"expansion = 0.01", "density_tolerance = 0.05", "damping = 0.4"})
    expect_complaint("[specimen]\nfile = \"a.h5\"\n" + key,
                     {"scene.toml:3: specimen." + key, "has no effect with specimen.file (scene.toml:2)"});
  EXPECT_EQ(complaint("[specimen]\nfile = \"a.h5\"\nexpansion = 0\ndamping = 0.3"), "accepted"); // printed defaults
  expect_complaint("[specimen]\nfile = \"\"", {"specimen.file", "must name a file"});
  for (const std::string file : {"packing.txt", "tests/n1000", "a.h5.csv", "a.csv#s0001"})
    expect_complaint("[specimen]\nfile = \"" + file + "\"",
                     {"scene.toml:", "specimen.file = " + file, "must be a file of Isostat (.h5)",
                      "isostat convert " + file + " packing.h5"});
  expect_complaint(smallest + "[contact]\nrolling = {}", {"scene.toml:4: contact.rolling", "without friction"});
}

TEST(SceneError, TomlItself)
{
  expect_complaint("[specimen\n", {"scene.toml:1:", "is not valid TOML"});
  expect_complaint(smallest + "relative_density = 0.3", {"scene.toml:3:", "is not valid TOML"});
  expect_complaint(smallest + "[\nmotion]\n", {"scene.toml:3:", "is not valid TOML"}); // toml++ 3.3 aborts on it
}

TEST(SceneError, MissingFiles)
{
  EXPECT_THROW(read_scene("/nowhere/scene.toml"), InputError);
  EXPECT_THROW(read_scene("/tmp"), InputError);
  const std::string path = testing::TempDir() + "isostat_scene_test.toml";
  std::ofstream(path) << "[specimen]\nfile = \"/nowhere/specimen.h5\"\n";
  EXPECT_THROW(read_scene(path), InputError);
  const std::string packing = testing::TempDir() + "isostat_scene_test.h5";
  std::ofstream(packing) << "";
  EXPECT_EQ(read_scene(path, {"specimen.file=" + packing}).output.folder, "results/isostat_scene_test");
  std::filesystem::remove(path);
  std::filesystem::remove(packing);
}

TEST(SceneOverride, IsNamedInErrors)
{
  const std::string sketch = "title = \"x\"\n" + smallest +
                             "[motion]\ndamping = 0.2\n[[stage]]\nkind = \"hold\"\n"
                             "[[stage]]\nkind = \"drained\"\nstrain = 0.1\n";
  EXPECT_EQ(complaint(sketch), "accepted");
  expect_complaint(sketch, {"--set specimen.", "excludes"}, {"specimen.void_ratio=0.7", "specimen.file=a.h5"});
  expect_complaint(sketch, {"--set motion.damping: motion.damping = 3; must be in [0, 1)"}, {"motion.damping=3"});
  expect_complaint(sketch, {"--set specimen.pressure: specimen.pressure = 200; must be"}, {"specimen.pressure=200"});
  expect_complaint(sketch, {"--set motion.dampin: motion.dampin", "Did you mean motion.damping?"}, {"motion.dampin=0"});
  expect_complaint(sketch, {"--set contact.rolling: contact.rolling.limit = -1"}, {"contact.rolling={limit=-1}"});
  expect_complaint(sketch, {"--set motion.damping", "must be key=value"}, {"motion.damping"});
  expect_complaint(sketch, {"there is no stage 2; scene.toml has 2"}, {"stage.2.strain=0.1"});
  expect_complaint(sketch, {"--set stage.x.strain", "by number"}, {"stage.x.strain=0.1"});
  expect_complaint(smallest, {"--set stage.0.strain", "scene.toml has no stage"}, {"stage.0.strain=0.1"});
  expect_complaint(sketch, {"--set title.a", "holds no keys"}, {"title.a=1"});
  expect_complaint(sketch, {"--set stage.0: a stage is set key by key"}, {"stage.0=1"});
  EXPECT_NE(complaint(sketch, {"motion.damping=0.3\n[output]\nenergy=true"}), "accepted");
}

TEST(SceneError, Grading)
{
  const std::string head = smallest + "[grading]\n";
  for (const char *wrong :
       {"[]", "3", "[[\"1 mm\", 100]]", "[[\"1 mm\", 10], [\"2 mm\", 90]]", "[[\"2 mm\", 10], [\"1 mm\", 100]]",
        "[[\"1 mm\", 50], [\"2 mm\", 10]]", "[[1, 10], [2, 100]]", "[[\"1 mm\", \"10\"], [\"2 mm\", 100]]",
        "[[\"0 mm\", 10], [\"2 mm\", 100]]", "[[\"1 kPa\", 10], [\"2 mm\", 100]]"})
    expect_complaint(head + "table = " + wrong, {"scene.toml:4: grading.table", "must"});
  for (const char *wrong : {"[5]", "[95, 5]", "[-1, 50]", "[0, 101]", "5", "[\"5\", 95]"})
    expect_complaint(head + "truncate = " + wrong, {"scene.toml:4: grading.truncate", "must"});
}
} // namespace
} // namespace isostat

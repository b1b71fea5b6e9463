// SPDX-License-Identifier: BSD-3-Clause
// What a scene says; what is refused is in tests/dem/scene/scene_error_test.cpp.
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/scene/scene.hpp"

#include "dem/scene/schema.hpp"
#include "tests/support/near.hpp"
#include "tests/support/schema_checks.hpp"

#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <random>

namespace isostat
{
namespace
{
using Overrides = std::vector<std::string>;

const std::string smallest = "[specimen]\nrelative_density = 0.64\n";

const std::string cell = smallest + "domain = \"periodic-cell\"\n";

const std::string sketch = R"(title = "Undrained cyclic triaxial test, Karlsruhe fine sand, D_r = 0.64"
[grading]
curve = "karlsruhe-fine-sand"
truncate = [5, 99.75]
grains = 10000
cloud_edge = "10 mm"
[contact]
young = "10 GPa"
stiffness_ratio = 0.3
friction = "18 deg"
rolling = { stiffness = 0.3, limit = 0.5 }
twisting = { stiffness = 0.3 }
[specimen]
domain = "rigid-box"
pressure = "200 kPa"
relative_density = 0.64
[motion]
damping = 0.2
inertial_number = 2e-4
[[stage]]
kind = "undrained-cyclic"
direction = "extension"
deviator_amplitude = "55 kPa"
until = { reversals_after_liquefaction = 12, strain = 0.1 }
[[stage]]
kind = "undrained-monotonic"
strain = 0.05
strain_rate = "0.5 1/s"
[output]
snapshots = "none"
)";

std::string read_all(const std::string &path)
{
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string cyclic_with(const std::string &line)
{
  return smallest + "[[stage]]\nkind = \"undrained-cyclic\"\n" + line + "\n";
}

TEST(Scene, ReadsTheSketchOfTheDesign)
{
  const Scene scene = parse_scene(sketch, "scene.toml");
  EXPECT_EQ(scene.grading.grains, 10000u);
  EXPECT_EQ(scene.grading.cloud_edge, 10e-3);
  EXPECT_EQ(scene.grading.finest_percent, 5);
  EXPECT_EQ(scene.grading.coarsest_percent, 99.75);
  EXPECT_EQ(scene.contact->young, 1e10);
  EXPECT_NEAR_BECAUSE(scene.contact->friction, 0.32491969623290632616, 1e-16,
                      "half a unit of the last place of a tangent near 1/3");
  EXPECT_EQ(scene.contact.as<LinearRolling>().active(), LawFeatures{});
  EXPECT_EQ(scene.specimen.relative_density, 0.64);
  EXPECT_FALSE(scene.specimen.void_ratio || scene.specimen.preparation_friction);
  EXPECT_EQ(scene.motion.inertial_number, 2e-4);
  ASSERT_EQ(scene.stages.size(), 2u);
  const auto &cyclic = std::get<UndrainedCyclic>(scene.stages[0]);
  EXPECT_EQ(cyclic.direction, LoadDirection::extension);
  EXPECT_EQ(cyclic.deviator_amplitude, 55e3);
  EXPECT_EQ(cyclic.reversals_after_liquefaction, 12u);
  EXPECT_EQ(cyclic.max_strain, 0.1);
  EXPECT_EQ(cyclic.max_cycles, 200u);
  const auto &monotonic = std::get<UndrainedMonotonic>(scene.stages[1]);
  EXPECT_EQ(monotonic.strain_end, 0.05);
  EXPECT_EQ(monotonic.strain_rate, 0.5);
  EXPECT_EQ(scene.output.snapshots, "none");
}

/// The defaults of the schema are those of the structs, so a scene made in C++ and an empty file agree.
TEST(Scene, DefaultsAreThoseOfTheStructs)
{
  Scene expected;
  expected.specimen.relative_density = 0.64;
  expected.contact = LinearRolling().with({false, false, false});
  EXPECT_EQ(parse_scene(smallest, "scene.toml"), expected);

  expected.stages = {UndrainedCyclic{}};
  EXPECT_EQ(parse_scene(cyclic_with(""), "scene.toml"), expected);
}

/// All but targets of a path, which its conditions in their examples exclude (tests/dem/drive/stages/path_test.cpp).
TEST(Scene, EveryStageKindParsesWithEachOfItsKeys)
{
  const std::span<const Stage> kinds = stage_kinds();
  for (std::size_t i = 0; i < kinds.size(); ++i)
    {
      std::string text = cell + fmt::format("[contact]\nfriction = \"18 deg\"\n[[stage]]\nkind = \"hold\"\n"
                                            "[[stage]]\nkind = \"{}\"\n",
                                            behaviour(kinds[i]).kind());
      for (const Key &key : scene_schema().keys)
        if (key.section() == "stage" && key.belongs_to(i) && !key.table && key.name() != "kind" &&
            !key.name().ends_with("stress"))
          text += fmt::format("{} = {}\n", key.name(), example(key));
      EXPECT_NO_THROW(parse_scene(text, "scene.toml")) << text;
    }
}

TEST(Scene, PeriodicCell)
{
  const Scene scene = parse_scene(cell + "consolidation = \"k0\"\n", "s");
  EXPECT_EQ(scene.specimen.domain, "periodic-cell");
  EXPECT_EQ(scene.specimen.consolidation, "k0");
  EXPECT_NE(to_toml(scene).find("consolidation = \"k0\""), std::string::npos);
  EXPECT_EQ(parse_scene(to_toml(scene), "s"), scene);

  const Scene isotropic = parse_scene(cell, "s");
  EXPECT_EQ(isotropic.specimen.consolidation, "isotropic");
  EXPECT_NE(to_toml(isotropic).find("consolidation = \"isotropic\""), std::string::npos);
  // recipes of box specimens are what they were before there was a cell, and so are their names in caches
  EXPECT_EQ(to_toml(parse_scene(smallest, "s")).find("consolidation"), std::string::npos);
}

TEST(Scene, SimpleShear)
{
  const Scene scene = parse_scene(cell + R"([[stage]]
kind = "k0-compress"
[[stage]]
kind = "undrained-simple-shear"
strain = 10
direction = "extension"
[[stage]]
kind = "undrained-cyclic-simple-shear"
until = { cycles = 20, strain = 2.5 }
[[stage]]
kind = "undrained-cyclic-simple-shear"
stress_ratio = 0.2
strain_rate = "0.5 1/s"
)",
                                  "s");
  ASSERT_EQ(scene.stages.size(), 4u);
  EXPECT_EQ(std::get<K0Compress>(scene.stages[0]).pressure, 0); // that of the specimen
  const auto &monotonic = std::get<UndrainedSimpleShear>(scene.stages[1]);
  EXPECT_EQ(monotonic.strain_end, 10);
  EXPECT_EQ(monotonic.direction, LoadDirection::extension);
  const auto &cyclic = std::get<UndrainedCyclicSimpleShear>(scene.stages[2]);
  EXPECT_EQ(cyclic.stress_ratio, 0.15);
  EXPECT_EQ(cyclic.liquefaction_ratio, 0.01);
  EXPECT_EQ(cyclic.max_cycles, 20u);
  EXPECT_EQ(cyclic.max_strain, 2.5);
  UndrainedCyclicSimpleShear expected;
  expected.stress_ratio = 0.2;
  expected.strain_rate = 0.5;
  EXPECT_EQ(scene.stages[3], Stage{expected});
}

TEST(Scene, GradingTable)
{
  const std::string head = "[specimen]\nvoid_ratio = 0.7\n[grading]\n";
  const Scene scene =
      parse_scene(head + "table = [[\"0.0631 mm\", 1.53], [\"125 um\", 28], [\"0.3135 mm\", 100]]", "s");
  const SizeCurve expected{{0.0631e-3, 1.53}, {125e-6, 28}, {0.3135e-3, 100}};
  EXPECT_EQ(scene.grading.table, expected);
  EXPECT_EQ(scene.grading.curve, "");
}

TEST(Scene, MedianDiameterInPlaceOfTheCloudsEdge)
{
  const std::string by_d50 = smallest + "[grading]\nd50 = \"450 um\"\n",
                    by_edge = smallest + "[grading]\ncloud_edge = \"7 mm\"\n";
  const Scene scene = parse_scene(by_d50, "s");
  EXPECT_EQ(scene.grading.d50, 0.45e-3);
  const std::string text = to_toml(scene);
  EXPECT_NE(text.find("d50 = \"0.45 mm\""), std::string::npos) << text;
  EXPECT_EQ(text.find("cloud_edge"), std::string::npos) << text;
  EXPECT_EQ(parse_scene(text, "s"), scene);
  // scenes without it, and with them the recipes of specimens in caches, are what they were
  EXPECT_EQ(to_toml(parse_scene(by_edge, "s")).find("d50"), std::string::npos);
  EXPECT_EQ(parse_scene(by_edge, "s", {"grading.d50=0.45 mm"}), scene);
  EXPECT_EQ(parse_scene(by_d50, "s", {"grading.cloud_edge=7 mm"}), parse_scene(by_edge, "s"));
}

TEST(SceneOverride, ReplacesValues)
{
  const Scene scene =
      parse_scene(sketch, "scene.toml",
                  {"motion.damping=0.3", "specimen.pressure=100kPa", "stage.1.strain=0.02", "title=\"New = title\"",
                   "contact.rolling.limit = 0.4", "output.checkpoint=10 min", "grading.truncate=[1, 99]",
                   "stage.0.until={ cycles = 3 }", "output.energy=true", "stage.0.direction=compression"});
  EXPECT_EQ(scene.motion.damping, 0.3);
  EXPECT_EQ(scene.specimen.pressure, 100e3);
  EXPECT_EQ(std::get<UndrainedMonotonic>(scene.stages[1]).strain_end, 0.02);
  EXPECT_EQ(scene.title, "New = title");
  EXPECT_EQ(scene.contact.as<LinearRolling>().rolling_limit, 0.4);
  EXPECT_EQ(scene.output.checkpoint_minutes, 10);
  EXPECT_EQ(scene.grading.finest_percent, 1);
  const auto &cyclic = std::get<UndrainedCyclic>(scene.stages[0]);
  EXPECT_EQ(cyclic.max_cycles, 3u);
  EXPECT_EQ(cyclic.reversals_after_liquefaction, 10u);
  EXPECT_TRUE(scene.output.energy);
  EXPECT_EQ(cyclic.direction, LoadDirection::compression);
  for (const char *pressure : {"200 kPa", "200kPa", "\"200 kPa\"", "'0.2 MPa'"})
    EXPECT_EQ(parse_scene(sketch, "s", {std::string("specimen.pressure=") + pressure}).specimen.pressure, 200e3);
}

TEST(SceneOverride, TakesThePlaceOfWhatItExcludes)
{
  const Scene scene = parse_scene(sketch, "s", {"specimen.preparation_friction=10 deg", "motion.strain_rate=0.5/s"});
  EXPECT_FALSE(scene.specimen.relative_density);
  EXPECT_EQ(scene.specimen.preparation_friction, parse_quantity("10 deg", Dimension::angle).value);
  EXPECT_EQ(scene.motion.strain_rate, 0.5);
  const Scene slow = parse_scene(to_toml(scene), "s", {"motion.inertial_number=1e-5"});
  EXPECT_FALSE(slow.motion.strain_rate);
  EXPECT_EQ(slow.motion.inertial_number, 1e-5);
}

TEST(Scene, InertialNumber)
{
  EXPECT_EQ(parse_scene(smallest, "s").motion.inertial_number, MotionSpec{}.inertial_number);
  for (const double number : {1e-12, 1e-4, 0.999})
    {
      const Scene scene = parse_scene(smallest + fmt::format("[motion]\ninertial_number = {}\n", number), "s");
      EXPECT_EQ(scene.motion.inertial_number, number);
      EXPECT_EQ(parse_scene(to_toml(scene), "s"), scene) << to_toml(scene);
    }
}

/// A value the key can hold, with random digits.
void scramble(const Key &key, const Field &field, std::mt19937_64 &random)
{
  std::uniform_real_distribution<double> unit(0, 1);
  const double high = std::min(key.range.high, 1e9);
  double number = std::max(key.range.low, 0.0) + (high - std::max(key.range.low, 0.0)) * (0.1 + 0.8 * unit(random));
  if (key.unit.dimension == Dimension::angle)
    number = 0.01 + unit(random);
  if (double *const *plain = std::get_if<double *>(&field))
    **plain = number;
  else if (std::optional<double> *const *maybe = std::get_if<std::optional<double> *>(&field); maybe && **maybe)
    **maybe = number;
  else if (std::uint64_t *const *count = std::get_if<std::uint64_t *>(&field))
    **count = static_cast<std::uint64_t>(number) + 2;
  else if (std::string *const *text = std::get_if<std::string *>(&field); text && key.kind() == Kind::text)
    **text = (*text)->empty() ? "" : "a \"b\" \\ c\n\t# \u00b5";
}

/// Stages from their lines after `kind = "`.
std::string stages(const std::vector<std::string> &lines)
{
  std::string text;
  for (const std::string &line : lines)
    text += "[[stage]]\nkind = \"" + line + "\n";
  return text;
}

TEST(Scene, RoundTripBitForBit)
{
  std::mt19937_64 random(3);
  const std::string box =
      sketch + "folder = \"x\"\n" +
      stages({"compress\"\npressure = \"1 kPa\"", "friction\"\nfriction = \"9 deg\"", "rebalance\"",
              "drained\"\nstrain = 0.1\nstrain_rate = \"1 1/s\"", "constant-p\"\nstrain = 0.1", "hold\""});
  const std::string cell_only = stages({"k0-compress\"\npressure = \"1 kPa\"", "undrained-simple-shear\"\nstrain = 1.5",
                                        "undrained-cyclic-simple-shear\"\nstrain_rate = \"1 1/s\""});
  std::string quartz = sketch;
  quartz.erase(quartz.find("stiffness_ratio"), std::string("stiffness_ratio = 0.3\n").size());
  const Overrides variants[] = {{},
                                {"motion.strain_rate=0.1/s", "specimen.preparation_friction=9 deg"},
                                {"specimen.void_ratio=0.7", "grading.table=[['0.1 mm', 3], ['0.3 mm', 100]]"},
                                {"specimen.file=a.h5", "motion.time_step=3 ns", "grading.d50=0.3 mm"},
                                {"specimen.domain=periodic-cell", "specimen.consolidation=k0"},
                                {"specimen.domain=periodic-cell", "specimen.file=a.h5"},
                                {"contact.law=hertz-mindlin"}};
  for (const Overrides &variant : variants)
    for (int repeat = 0; repeat < 50; ++repeat)
      {
        const bool in_cell = !variant.empty() && variant[0] == "specimen.domain=periodic-cell";
        const std::size_t law = !variant.empty() && variant[0] == "contact.law=hertz-mindlin" ? 1 : 0;
        Scene scene = parse_scene(in_cell ? box + cell_only : law == 1 ? quartz : box, "scene.toml", variant);
        for (const Key &key : scene_schema().keys)
          if (key.kinds == 0 ? key.name() != "inertial_number" : key.section() == "contact" && key.belongs_to(law))
            scramble(key, key.field(scene), random);
          else if (key.kinds != 0 && key.section() != "contact")
            for (Stage &stage : scene.stages)
              if (key.belongs_to(stage.index()))
                scramble(key, key.field(stage), random);
        for (Stage &stage : scene.stages)
          if (auto *cyclic =
                  as<UndrainedCyclic>(stage)) // what isotropic consolidation leaves must be between its loads
            cyclic->deviator_average *= cyclic->deviator_amplitude / 1e9;
        scene.specimen.pressure = scene.contact->young / (law == 1 ? 3700 : 37); // at most a twentieth of the modulus
        if (scene.grading.d50)
          scene.grading.cloud_edge = GradingSpec{}.cloud_edge;
        if (!scene.specimen.file.empty()) // whose grains are its own: a scrambled grading was not written
          {
            scene.specimen.file += ".h5";
            scene.specimen.expansion = 0;
            scene.specimen.density_tolerance = SpecimenSpec{}.density_tolerance;
            scene.specimen.damping = SpecimenSpec{}.damping;
            scene.grading = {};
          }
        scene.drive = {}; // of a static one
        if (scene.specimen.e_min)
          scene.specimen.e_max = *scene.specimen.e_min * 1.37;
        for (auto &[diameter, percent] : scene.grading.table)
          diameter *= 1.0 / 3.0;
        EXPECT_EQ(parse_scene(to_toml(scene), "resolved.toml"), scene) << to_toml(scene);
      }
}

TEST(Scene, StaticDrive)
{
  const std::string text = smallest + "[motion]\ndrive = \"static\"\nincrement = 2e-6\nbalance = 1e-4\nleft_out = 0\n" +
                           "[[stage]]\nkind = \"drained\"\nstrain = 0.1\n";
  const Scene scene = parse_scene(text, "s");
  EXPECT_TRUE(scene.drive.on);
  EXPECT_EQ(scene.drive.increment, 2e-6);
  EXPECT_EQ(scene.drive.balance, (BalanceSpec{1e-4, 0}));
  EXPECT_EQ(parse_scene(to_toml(scene), "s"), scene);
  EXPECT_FALSE(parse_scene(smallest, "s").drive.on);
}

TEST(Scene, LimitsOfTheVoidRatioBelongToTheGrading)
{
  const std::string table = "[grading]\ntable = [[\"1 mm\", 0], [\"2 mm\", 100]]\n[specimen]\nvoid_ratio = 0.7\n";
  EXPECT_TRUE(parse_scene(smallest, "s").specimen.has_limits());
  EXPECT_FALSE(parse_scene(table, "s").specimen.has_limits());
  EXPECT_FALSE(parse_scene("[specimen]\nfile = \"a.h5\"\n", "s").specimen.has_limits());
  const Scene given = parse_scene(table + "e_min = 0.5\ne_max = 0.8\n", "s");
  EXPECT_EQ(given.specimen.e_max, 0.8);
  for (const Scene &scene : {parse_scene(table, "s"), given})
    EXPECT_EQ(parse_scene(to_toml(scene), "s"), scene) << to_toml(scene);
}

TEST(Scene, RoundTripWithPartsOfTheLawOff)
{
  for (const char *contact : {"", "friction = \"0 deg\"\nrolling = {}", "friction = \"12.3 deg\"",
                              "friction = \"12.3 deg\"\ntwisting = { stiffness = 2 }"})
    {
      const Scene scene = parse_scene(smallest + "[contact]\n" + contact, "s");
      EXPECT_EQ(parse_scene(to_toml(scene), "s"), scene) << to_toml(scene);
    }
}

TEST(Scene, PrintedDefaultsAreAScene)
{
  const Scene scene = parse_scene(default_scene(), "default.toml");
  Scene expected;
  expected.specimen.relative_density = 0.64;
  expected.contact->friction = parse_quantity("18 deg", Dimension::angle).value;
  expected.stages = {UndrainedCyclic{}};
  EXPECT_EQ(scene, expected);

  for (const Key &key : scene_schema().keys)
    {
      const bool of_another_law = key.section() == "contact" && key.kinds != 0 && !key.belongs_to(0);
      EXPECT_TRUE(of_another_law || default_scene().find(std::string(key.name())) != std::string::npos) << key.path;
    }
}

TEST(Schema, EveryKeyIsDescribed)
{
  test::expect_described(scene_schema());
  for (const Key &key : scene_schema().keys)
    EXPECT_EQ(key.kinds != 0, key.section() == "stage" || (key.section() == "contact" && key.name() != "law"))
        << key.path;
}

TEST(Manual, EqualsTheFileInDocs)
{
  EXPECT_EQ(read_all(ISOSTAT_SOURCE_DIR "/docs/scene_reference.md"), scene_manual())
      << "regenerate docs/scene_reference.md from scene_manual()";
}
} // namespace
} // namespace isostat

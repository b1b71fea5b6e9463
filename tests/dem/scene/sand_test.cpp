// SPDX-License-Identifier: BSD-3-Clause
// Sands that scenes take from files. What runs, libraries and commands make of them: tests/apps/sands_test.py.
#include "dem/scene/sand.hpp"

#include "base/error.hpp"
#include "base/tell.hpp"
#include "dem/scene/scene.hpp"
#include "tests/support/near.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace isostat
{
namespace
{
using ::testing::ElementsAre, ::testing::HasSubstr, ::testing::StartsWith;

constexpr const char *sand = R"([sand]
source = "a guess"
misfit = 0.2
lowest_pressure = "50 kPa"
highest_pressure = "100 kPa"
highest_void_ratio = 0.7
largest_strain = 0.05
[grading]
table = [["0.1 mm", 0], ["0.2 mm", 100]]
[contact]
young = "1 GPa"
friction = "22 deg"
rolling = { limit = 0.1 }
[specimen]
preparation_friction = "12 deg"
e_min = 0.5
e_max = 0.8
)";

class Sand : public testing::Test
{
protected:
  std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "isostat_sand";
  std::string scene = (folder / "scene.toml").string(), file = (folder / "my_sand.toml").string();

  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  static void write(const std::string &path, const std::string &text) { std::ofstream(path) << text; }

  Scene taken(const std::string &text, const std::string &of_sand = sand) const
  {
    write(file, of_sand);
    write(scene, "sand = \"my_sand.toml\"\n" + text);
    return read_scene(scene);
  }
  std::string refusal(const std::string &text, const std::string &of_sand = sand) const
  {
    try
      {
        taken(text, of_sand);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }
};

TEST_F(Sand, IsThatSceneWithItsKeysWritten)
{
  Scene written = parse_scene("[sand]\nname = \"my_sand\"\n" + std::string(sand).substr(7), "scene.toml");
  written.output.folder = "results/scene";
  EXPECT_EQ(taken(""), written);
  EXPECT_EQ(parse_scene(to_toml(written), "resolved.toml"), written); // without the file
}

TEST_F(Sand, GivesWayToKeysOfTheScene)
{
  const Scene s = taken("[grading]\ngrains = 300\n[contact]\nrolling.stiffness = 0.7\nyoung = \"2 GPa\"\n"
                        "[specimen]\nrelative_density = 0.5\n");
  EXPECT_EQ(s.specimen.relative_density, 0.5);
  EXPECT_FALSE(s.specimen.preparation_friction);
  EXPECT_EQ(s.specimen.e_max, 0.8);
  EXPECT_EQ(s.grading.grains, 300u);
  EXPECT_EQ(s.contact->young, 2e9);
  const std::string law = to_toml(s);
  EXPECT_THAT(law, HasSubstr("rolling.stiffness = 0.7\nrolling.limit = 0.1\n"));
  EXPECT_FALSE(taken("[grading]\ncurve = \"karlsruhe-fine-sand\"\n").grading.curve.empty());
  write(file, std::string(sand) + "expansion = 0.02\n"); // its preparation, next to a packing that is prepared
  EXPECT_EQ(parse_scene("sand = \"my_sand.toml\"\n[specimen]\nfile = \"a.h5\"\n", scene).specimen.expansion, 0);
  write(scene, "[specimen]\nvoid_ratio = 0.6\n");
  EXPECT_EQ(read_scene(scene, {"sand=my_sand.toml"}).contact->young, 1e9);
}

TEST_F(Sand, ErrorsNameItsFileAndLine)
{
  const auto broken = [](const std::string &line, const std::string &with) {
    std::string text = sand;
    return text.replace(text.find(line), line.size(), with);
  };
  EXPECT_THAT(refusal("", broken("young = \"1 GPa\"", "young = \"1 mm\"")),
              StartsWith(file + ":11: contact.young = 1 mm;"));
  EXPECT_THAT(refusal("", broken("misfit = 0.2", "misfitt = 0.2")), StartsWith(file + ":3: sand.misfitt"));
  EXPECT_THAT(refusal("", broken("e_min = 0.5", "e_min = 0.9")), StartsWith(file + ":16: specimen.e_min"));
  EXPECT_THAT(refusal("", broken("= \"50 kPa\"", "= \"101 kPa\"")),
              StartsWith(file + ":4: sand.lowest_pressure = 101 kPa; must not be above sand.highest_pressure"));
  EXPECT_THAT(refusal("", std::string(sand) + "[motion]\n"), StartsWith(file + ":18: motion; a sand has the tables"));
  EXPECT_THAT(refusal("[contact]\nlaw = \"hertz-mindlin\"\nstiffness_ratio = 0.3\n"),
              StartsWith(scene + ":4: contact."));
  EXPECT_THAT(refusal("[motion]\ndamping = 2\n"), StartsWith(scene + ":3: motion.damping"));
  write(scene, "sand = \"karlsruhe\"\n");
  EXPECT_THROW(read_scene(scene), InputError);
  write(scene, "sand = \"nowhere.toml\"\n");
  EXPECT_THROW(read_scene(scene), InputError);
}

TEST_F(Sand, WarnsOutsideOfItsRangeAlone)
{
  const std::string stage = "[[stage]]\nkind = \"drained\"\nstrain = ";
  const auto warned = [&](const std::string &text) {
    const WarningsTaken taken_here; // read_scene() says it
    taken(text);
    return taken_here.lines;
  };
  EXPECT_THAT(warned("[specimen]\npressure = \"100 kPa\"\nvoid_ratio = 0.7\n" + stage + "0.05\n"), ElementsAre());
  EXPECT_THAT(
      warned("[specimen]\npressure = \"101 kPa\"\nvoid_ratio = 0.71\n" + stage + "0.06\n"),
      ElementsAre(
          HasSubstr("specimen.void_ratio = 0.71, but the sand my_sand was compared with tests at up to 0.7;"),
          HasSubstr("specimen.pressure = 101 kPa, but the sand my_sand was compared with tests at 50 to 100 kPa"),
          HasSubstr("stage.0.strain = 0.06, but")));
  EXPECT_THAT(warned("[specimen]\npressure = \"100 kPa\"\nrelative_density = 0.3\n"),
              ElementsAre(HasSubstr("specimen.relative_density = 0.3 is e = 0.71, but")));
  EXPECT_THAT(beyond_sand(parse_scene("[specimen]\nvoid_ratio = 2\n", "scene.toml")), ElementsAre());
}

TEST_F(Sand, GoesAlongWithPackings)
{
  const Scene s = taken("");
  EXPECT_EQ(sand_from(sand_text(s)), s.sand);
  EXPECT_EQ(sand_from(sand_text(Scene())), SandSpec());
}

TEST(Sands, InstalledOnesAreWholeAndSayWhatTheyAreWorth)
{
  int n_sands = 0;
  for (const auto &entry : std::filesystem::directory_iterator(ISOSTAT_SOURCE_DIR "/apps/scenes/sands"))
    {
      ++n_sands;
      const Scene s = parse_scene("sand = \"" + entry.path().stem().string() + "\"\n", "scene");
      EXPECT_EQ(s.sand.name, entry.path().stem().string());
      EXPECT_TRUE(!s.sand.source.empty() && !s.sand.tests.empty());
      EXPECT_TRUE(s.sand.lowest_pressure && s.sand.highest_void_ratio && s.sand.largest_strain);
      const bool to_curves = s.sand.name != "ottawa-f65"; // of which peak friction alone is known
      EXPECT_EQ(s.sand.misfit && s.sand.blind_misfit, to_curves);
      EXPECT_GT(s.contact->friction, 0);
    }
  EXPECT_EQ(n_sands, 2);
}
} // namespace
} // namespace isostat

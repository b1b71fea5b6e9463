// SPDX-License-Identifier: BSD-3-Clause
// The scenes of element tests that come with the programs, apps/scenes/*.toml.
#include "dem/scene/scene.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <set>

namespace isostat
{
namespace
{
/// What every scene of apps/scenes is held to.
void check_ready_scene(const std::filesystem::path &path)
{
  const Scene scene = read_scene(path.string());
  const std::string name = path.stem().string();
  const bool quick = name.starts_with("quick_"), in_cell = scene.specimen.domain == "periodic-cell";
  EXPECT_FALSE(scene.title.empty());
  const bool for_library = name.starts_with("rve_library"); // of many small specimens
  if (for_library || (quick && in_cell))                    // no walls, so fewer grains will do
    EXPECT_EQ(scene.grading.grains, 1000u);
  else
    EXPECT_EQ(scene.grading.grains, quick ? 2000u : 10000u);
  // the same size of grains: volume of the cloud per grain is that of 10,000 in 10 mm
  const double volume = std::pow(scene.grading.cloud_edge, 3) / static_cast<double>(scene.grading.grains);
  EXPECT_NEAR_BECAUSE(volume / 1e-10, 1, 1e-14, "round-off of a cube");
  const bool consolidated = name.ends_with("biased_cyclic_triaxial"); // by a stage of its own
  EXPECT_EQ(scene.stages.size(), for_library || name.ends_with("void_ratio_limits") ? 0u : consolidated ? 2u : 1u);
  EXPECT_EQ(parse_scene(to_toml(scene), "resolved.toml"), scene);
}

TEST(Scenes, AllParseAndSayWhatTheyShow)
{
  int n_scenes = 0;
  for (const auto &entry : std::filesystem::directory_iterator(ISOSTAT_SOURCE_DIR "/apps/scenes"))
    {
      if (entry.path().extension() != ".toml")
        continue;
      SCOPED_TRACE(entry.path().string());
      ++n_scenes;
      check_ready_scene(entry.path());
    }
  EXPECT_EQ(n_scenes, 25);
}

/// A scene of the cell for comparison with one of the box differs from it in words and in the domain only.
TEST(Scenes, PeriodicTwinsEqualThoseOfTheBox)
{
  const std::string folder = ISOSTAT_SOURCE_DIR "/apps/scenes/";
  for (const std::string name : {"cyclic_dr64", "monotonic_compression_dr64"})
    {
      const Scene in_cell = read_scene(folder + name + "_periodic.toml");
      EXPECT_EQ(in_cell.specimen.domain, "periodic-cell") << name;
      Scene in_box = read_scene(folder + name + ".toml", {"specimen.domain=periodic-cell"});
      in_box.title = in_cell.title;
      in_box.output.folder = in_cell.output.folder;
      EXPECT_EQ(in_cell, in_box) << name;
    }
}
} // namespace
} // namespace isostat

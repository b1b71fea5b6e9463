// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/in_situ/in_situ.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
const Mat3 target = Vec3(-1e3, -2e3, -1e3).asDiagonal();

std::string recipe(const MotionSpec &motion, const InSituSettings &settings = {})
{
  return in_situ_recipe({}, target, motion, settings);
}
} // namespace

// Caches of earlier runs are found by it: a change of the text needs another version.
TEST(InSituRecipe, ItsTextIsThatOfItsVersion)
{
  EXPECT_EQ(recipe({}),
            "in situ 2; specimen 3f64747dcade3880; stress -1000 -2000 -1000 0 0 0; path 0; tolerance 0.001; "
            "steps 500000; motion 0.050000000000000003 0.10000000000000001 0.10000000000000001 1 "
            "no 0.10000000000000001 no 0.80000000000000004 no");
}

TEST(InSituRecipe, AllThatTheResultDependsOnIsInIt)
{
  std::vector<InSituSettings> settings(3);
  settings[0].path = InSituPath::no_lateral_strain;
  settings[1].tolerance = 2e-3;
  settings[2].max_steps = 7;
  for (const InSituSettings &other : settings)
    EXPECT_NE(recipe({}, other), recipe({}));
  std::vector<MotionSpec> motions(3);
  motions[0].damping = 0.3;
  motions[1].time_step = 1e-6;
  motions[2].inertial_number = 1e-4;
  for (const MotionSpec &other : motions)
    EXPECT_NE(recipe(other), recipe({}));
  Snapshot softer;
  softer.law->young /= 2;
  EXPECT_NE(in_situ_recipe(softer, target, {}, {}), recipe({}));
  Snapshot sliding, plain;
  plain.cell = sliding.cell = PeriodicCell::with_edges(Vec3::Ones());
  sliding.cell->strain_step(0, 1) = 1e-6;
  EXPECT_NE(in_situ_recipe(sliding, target, {}, {}), in_situ_recipe(plain, target, {}, {}));
  EXPECT_NE(in_situ_recipe({}, 2 * target, {}, {}), recipe({}));
}
} // namespace isostat

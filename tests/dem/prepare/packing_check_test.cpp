// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/packing_check.hpp"

#include "base/error.hpp"
#include "dem/scene/scene.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <gmock/gmock.h>

namespace isostat
{
namespace
{
using testing::HasSubstr;

/// Two spheres of 0.1 and 0.2 mm radius, `gap` apart, in a box of 1 x 0.7 x 0.7 mm.
Snapshot two(double gap, double unit = 1e-3)
{
  Snapshot s;
  s.grains =
      make_packing({unit * Vec3(0.3, 0.5, 0.5), unit * Vec3(0.6 + gap, 0.5, 0.5)}, {0.1 * unit, 0.2 * unit}, 2650);
  s.box.upper = unit * Vec3(1, 0.7, 0.7);
  return s;
}

const ScalingRemedy scale = [](const std::string &unit) { return "scale it from " + unit; };

std::string refusal(const Snapshot &s)
{
  return message_of<InputError>([&] { check_packing(s, "p.txt", scale); });
}

TEST(PackingCheck, Figures)
{
  const PackingFigures f = packing_figures(two(-0.01));
  EXPECT_EQ(f.n_grains, 2u);
  EXPECT_NEAR_BECAUSE(f.overlap, 0.1, 1e-12, "round-off");
  EXPECT_NEAR_BECAUSE(f.void_ratio, 0.49e-9 / two(0).grains.solid_volume() - 1, 1e-12, "round-off");
  EXPECT_NEAR_BECAUSE(f.beyond_wall, 0, 1e-15, "it touches a wall: round-off");
  EXPECT_THAT(figures_text(f, two(-0.01)), HasSubstr("largest overlap  10 % of the radius, grains 0 and 1"));
}

TEST(PackingCheck, OverlapThroughAFaceOfTheCell)
{
  Snapshot s = two(0.1);
  s.grains.set_centre(0, 1e-3 * Vec3(-0.5, 0.5, 0.5)); // 1.2 mm before the second: its image is 0.2 mm away
  s.cell = PeriodicCell::with_edges(1e-3 * Vec3(1.4, 1, 1));
  EXPECT_NEAR_BECAUSE(packing_figures(s).overlap, 1, 1e-9, "round-off of millimetres");
  s.cell = PeriodicCell::with_edges(1e-3 * Vec3(1.4, 0.65, 1)); // radii of 0.2 and 0.1 mm
  EXPECT_TRUE(packing_figures(s).overlaps_known);
  s.cell = PeriodicCell::with_edges(1e-3 * Vec3(1.4, 0.55, 1));
  EXPECT_FALSE(packing_figures(s).overlaps_known);
}

TEST(PackingCheck, WhatIsNoSoilIsRefused)
{
  EXPECT_TRUE(check_packing(two(0), "p.txt", scale).empty());
  EXPECT_THAT(refusal(two(0, 1)), HasSubstr("p.txt: the largest radius is 0.2 m; expected at most 0.05 m"));
  EXPECT_THAT(refusal(two(0, 1)), HasSubstr("in mm? If so, scale it from mm"));
  EXPECT_THAT(refusal(two(0, 1000)), HasSubstr("in um? If so, scale it from um"));
  EXPECT_THAT(refusal(two(0, 1e-6)), HasSubstr("clay"));
  EXPECT_THAT(refusal(two(-0.05)), HasSubstr("overlap by 50 % of the smaller radius (1 pairs"));
  EXPECT_TRUE(check_packing(two(0, 0.5), "p.txt", scale, largest_radius).empty()); // its metres are meant
  EXPECT_THAT(message_of<InputError>([] { check_packing(two(0, 1), "p.txt", scale, largest_radius); }),
              HasSubstr("expected at most 0.15 m"));
  Snapshot light = two(0);
  for (const double density : {lightest_grains, heaviest_grains}) // what scenes allow
    {
      light.grains.density = density;
      EXPECT_TRUE(check_packing(light, "p.txt", scale).empty());
    }
  light.grains.density = 2.65;
  EXPECT_THAT(refusal(light), HasSubstr("p.txt: the grain density is 2.65 kg/m3; expected 30 to 1e+06 kg/m3"));
  Snapshot out = two(0.15);
  EXPECT_THAT(message_of<InputError>([&] {
                out.box.upper[0] = 0.85e-3;
                check_packing(out, "p.txt", scale);
              }),
              HasSubstr("grain 1 reaches beyond a wall of the box by 50 %"));
}

TEST(PackingCheck, WhatIsOddIsAWarning)
{
  const auto warnings = check_packing(two(-0.01), "p.txt", scale);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0], HasSubstr("10 %"));
  Snapshot wide = two(0);
  wide.box.upper[1] = 1.5e-3;
  ASSERT_EQ(check_packing(wide, "p.txt", scale).size(), 1u);
  EXPECT_THAT(check_packing(wide, "p.txt", scale)[0], HasSubstr("twice as wide"));
}
} // namespace
} // namespace isostat

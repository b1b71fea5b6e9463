// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/space_filling.hpp"

#include "dem/assembly/assembly.hpp"
#include "dem/measure/stress.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace isostat
{
namespace
{
std::vector<Vec3> random_points(std::size_t n)
{
  std::mt19937_64 engine(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vec3> points(n);
  for (Vec3 &x : points)
    for (int k = 0; k < 3; ++k)
      x[k] = uniform(engine);
  return points;
}

/// Touching grains in random order, with a history in every contact and contacts with walls.
Snapshot shuffled_lattice()
{
  const int edge = 5;
  std::vector<Vec3> centres;
  for (int a = 0; a < edge; ++a)
    for (int b = 0; b < edge; ++b)
      for (int c = 0; c < edge; ++c)
        centres.push_back(2.99e-4 * Vec3(a, b, c));
  std::shuffle(centres.begin(), centres.end(), std::mt19937_64(5));
  Snapshot s;
  s.grains = make_packing(centres, std::vector<double>(centres.size(), 1.5e-4), 2650);
  s.box = {Vec3::Constant(-1.499e-4), Vec3::Constant(4 * 2.99e-4 + 1.499e-4)};
  for (std::uint32_t i = 0; i < centres.size(); ++i)
    {
      s.grains.id[i] = 1000 + i;
      s.grains.set_linear_velocity(i, Vec3(i, 2.0 * i, 3.0 * i) * 1e-4);
      s.grains.set_angular_velocity(i, Vec3(1, i, 5));
    }
  Assembly assembly(s);
  assembly.settings.time_step = 5e-8;
  assembly.compute_forces();
  return assembly.snapshot();
}
} // namespace

TEST(MortonOrder, GoesThroughTheEightOctantsInTurn)
{
  // x is the fastest bit, z the slowest
  std::vector<Vec3> corners;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x)
        corners.emplace_back(x, y, z);
  const std::vector<std::uint32_t> expected{0, 1, 2, 3, 4, 5, 6, 7};
  EXPECT_EQ(morton_order(corners), expected);
  std::reverse(corners.begin(), corners.end());
  const std::vector<std::uint32_t> reversed{7, 6, 5, 4, 3, 2, 1, 0};
  EXPECT_EQ(morton_order(corners), reversed);
}

TEST(MortonOrder, IsAPermutationAndShortensTheWay)
{
  const std::vector<Vec3> points = random_points(4000);
  const std::vector<std::uint32_t> order = morton_order(points);
  std::vector<std::uint32_t> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  for (std::uint32_t i = 0; i < sorted.size(); ++i)
    ASSERT_EQ(sorted[i], i);
  double before = 0, after = 0;
  for (std::size_t i = 1; i < points.size(); ++i)
    {
      before += (points[i] - points[i - 1]).norm();
      after += (points[order[i]] - points[order[i - 1]]).norm();
    }
  EXPECT_BELOW_BECAUSE(after, 0.2 * before,
                       "spacing of 4,000 points, 0.06 edges, with jumps of the curve, against 0.66 edges for any two");
}

TEST(MortonOrder, NoneOneAndCoincidentPointsKeepTheirOrder)
{
  EXPECT_TRUE(morton_order({}).empty());
  EXPECT_EQ(morton_order({Vec3(1, 2, 3)}), std::vector<std::uint32_t>{0});
  const std::vector<std::uint32_t> as_they_are{0, 1, 2};
  EXPECT_EQ(morton_order({Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3)}), as_they_are);
}

TEST(SortedAlongCurve, IsTheSameStateInAnotherOrder)
{
  const Snapshot s = shuffled_lattice(), sorted = sorted_along_curve(s);
  ASSERT_EQ(sorted.grains.n_grains(), s.grains.n_grains());
  std::map<std::uint32_t, std::uint32_t> place;
  for (std::uint32_t i = 0; i < s.grains.n_grains(); ++i)
    place[sorted.grains.id[i]] = i;
  ASSERT_EQ(place.size(), s.grains.n_grains());
  for (std::uint32_t i = 0; i < s.grains.n_grains(); ++i)
    for (std::size_t c = 0; c < 4; ++c)
      {
        const std::uint32_t j = place.at(s.grains.id[i]);
        EXPECT_EQ(sorted.grains.position[4 * j + c], s.grains.position[4 * i + c]);
        EXPECT_EQ(sorted.grains.velocity[4 * j + c], s.grains.velocity[4 * i + c]);
        EXPECT_EQ(sorted.grains.spin[4 * j + c], s.grains.spin[4 * i + c]);
      }
  EXPECT_NE(sorted.grains.id, s.grains.id);
  EXPECT_EQ(sorted.grains.position.size(), s.grains.position.size()); // the padding is still there
  const Mat3 stress = contact_stress(s);
  EXPECT_BELOW_BECAUSE((contact_stress(sorted) - stress).norm(), 1e-13 * stress.norm(),
                       "round-off of a sum in another order");
  EXPECT_BELOW_BECAUSE((wall_stress(sorted) - wall_stress(s)).norm(), 1e-13 * stress.norm(),
                       "round-off of a sum in another order");
}

TEST(SortedAlongCurve, ContactsAreSeenFromTheirFirstGrain)
{
  const Snapshot s = shuffled_lattice(), sorted = sorted_along_curve(s);
  std::map<std::pair<std::uint32_t, std::uint32_t>, const Contact *> old;
  for (const Contact &c : s.contacts)
    old[{s.grains.id[c.first], s.grains.id[c.second]}] = &c;
  ASSERT_EQ(sorted.contacts.size(), s.contacts.size());
  std::size_t turned = 0;
  for (const Contact &c : sorted.contacts)
    {
      ASSERT_LT(c.first, c.second);
      const std::uint32_t a = sorted.grains.id[c.first], b = sorted.grains.id[c.second];
      const bool same_side = old.contains({a, b});
      turned += !same_side;
      const Contact &before = *old.at(same_side ? std::pair(a, b) : std::pair(b, a));
      const double sign = same_side ? 1 : -1;
      EXPECT_EQ(c.history.normal, Vec3(sign * before.history.normal));
      EXPECT_EQ(c.history.shear_force, Vec3(sign * before.history.shear_force));
      EXPECT_EQ(c.history.bending_moment, Vec3(sign * before.history.bending_moment));
      EXPECT_EQ(c.history.twisting_moment, Vec3(sign * before.history.twisting_moment));
      const Vec3 branch = sorted.grains.centre(c.second) - sorted.grains.centre(c.first);
      EXPECT_GT(c.history.normal.dot(branch), 0.999 * branch.norm());
    }
  EXPECT_GT(turned, 0u);
  EXPECT_TRUE(
      std::ranges::is_sorted(sorted.contacts, {}, [](const Contact &c) { return std::pair(c.first, c.second); }));
  EXPECT_TRUE(std::ranges::is_sorted(sorted.wall_contacts, {},
                                     [](const WallContact &c) { return std::pair(c.wall, c.grain); }));
}

TEST(SortedAlongCurve, ContinuesTheSameWay)
{
  // only the order of summation differs
  const Snapshot s = shuffled_lattice();
  Assembly a(s), b(sorted_along_curve(s));
  for (Assembly *assembly : {&a, &b})
    {
      assembly->settings.time_step = 5e-8;
      for (int step = 0; step < 20; ++step)
        {
          assembly->compute_forces();
          assembly->move(assembly->box());
        }
    }
  for (int wall = 0; wall < 6; ++wall)
    EXPECT_NEAR_BECAUSE(a.wall_forces()[wall], b.wall_forces()[wall], 1e-9 * a.wall_forces()[wall],
                        "round-off of sums in another order, 1e-13 of a force, grown in 20 steps");
}
} // namespace isostat

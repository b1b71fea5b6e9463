// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/prepare/pluviate.hpp"

#include "base/error.hpp"
#include "dem/assembly/assembly.hpp"
#include "dem/motion/critical_step.hpp"
#include "tests/support/near.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double g = 9.81;

/// Spheres of radius r that touch on a cubic lattice, n per edge, resting on the floor and at the sides of a box.
Snapshot cubic_lattice(int n, double r)
{
  std::vector<Vec3> centres;
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b)
      for (int c = 0; c < n; ++c)
        centres.push_back(Vec3(2 * a + 1, 2 * b + 1, 2 * c + 1) * r);
  Snapshot s;
  s.grains = make_packing(centres, std::vector<double>(centres.size(), r), 2650);
  s.box = {Vec3::Zero(), Vec3::Constant(2 * n * r)};
  return s;
}

Cloud single_grain(double radius, double height)
{
  Cloud cloud;
  const double edge = 20 * radius;
  cloud.packing = make_packing({Vec3(edge / 2, height, edge / 2)}, {radius}, 2650);
  cloud.box = {Vec3::Zero(), Vec3::Constant(edge)};
  return cloud;
}

/// Follows the grain that matters to a test.
struct Follower : test::Unobserved
{
  bool after_step(const Assembly &a, const DriveState &, const Observation &) override
  {
    const double overlap = a.packing().radius(0) - a.packing().centre(0)[1];
    maximum = std::max(maximum, overlap);
    if (overlap <= 0 && maximum == 0)
      {
        speed = -a.packing().linear_velocity(0)[1];
        fallen = a.time();
      }
    return true;
  }
  double maximum = 0, speed = 0, fallen = 0;
};

TEST(VoidRatioInside, IsThatOfACubicLattice)
{
  const Snapshot s = cubic_lattice(4, 0.1e-3);
  const RigidBox four_cells{Vec3::Constant(0.2e-3), Vec3::Constant(0.6e-3)}; // whole cells of the lattice
  EXPECT_NEAR_BECAUSE(void_ratio_inside(s.grains, four_cells), 6 / std::numbers::pi - 1, 0.01,
                      "lines a tenth of a diameter apart sample the spheres");
}

TEST(VoidRatioInside, IsZeroWithoutRoomOrGrains)
{
  const Snapshot s = cubic_lattice(2, 0.1e-3);
  EXPECT_EQ(void_ratio_inside(s.grains, {Vec3::Zero(), Vec3(1e-3, -1e-6, 1e-3)}), 0);
  EXPECT_EQ(void_ratio_inside(s.grains, {Vec3::Constant(1), Vec3::Constant(1.001)}), 0);
}

TEST(SurfaceHeight, OfALatticeIsItsTopLayerSeenFromAbove)
{
  const double r = 0.1e-3;
  const Snapshot s = cubic_lattice(3, r);
  // hemispheres over their squares: 5r - floor under the gaps (0) is seen nowhere but in the corners of the squares
  const double covered = std::numbers::pi / 4, mean_rise = 2.0 / 3 * r;
  EXPECT_NEAR_BECAUSE(
      surface_height(s.grains, s.box), covered * (5 * r + mean_rise), 0.05 * 5 * r,
      "lines a tenth of a diameter apart sample the hemispheres, and what is seen in the corners is left out");
}

TEST(DepositionModulus, GivesTheOverlapOfAFallingGrain)
{
  LinearRolling law = test::paper_law();
  const double radius = 0.2e-3, height = 20 * radius;
  const Cloud cloud = single_grain(radius, height);
  Pluviation how;
  how.fall = 1;
  how.soften = false;
  const double speed = std::sqrt(2 * g * (height - radius)), target = 1e-3 * 2 * radius;
  law.young = deposition_modulus(law, 2650, speed, 2 * radius, target);
  how.damping = 0;
  struct Once : Follower // the grain would bounce on: stop at its first return
  {
    bool after_step(const Assembly &a, const DriveState &s, const Observation &o) override
    {
      Follower::after_step(a, s, o);
      return maximum == 0 || a.packing().linear_velocity(0)[1] < 0;
    }
  } once;
  EXPECT_THROW(pluviate(cloud, law, how, once), Interrupted);
  EXPECT_NEAR_BECAUSE(once.speed / speed, 1, 1e-3, "the last step before contact: a step is 1e-3 of the fall at most");
  EXPECT_NEAR_BECAUSE(once.fallen / std::sqrt(2 * (height - radius) / g), 1, 1e-3,
                      "the last step before contact: a step is 1e-3 of the fall at most");
  EXPECT_NEAR_BECAUSE(once.maximum / target, 1, 0.06,
                      "the peak falls between two steps of w dt < 0.7: up to 1 - cos(0.35)");
}

/// 500 grains of the paper's sand: seconds.
const Deposit &deposit()
{
  static const Deposit made = [] {
    test::Unobserved nobody;
    return pluviate(make_cloud(test::small_grading(500)), test::paper_law(), {}, nobody);
  }();
  return made;
}

TEST(Pluviate, GrainsRestUnderTheirWeight)
{
  Assembly assembly(deposit().state); // where pluviation ends it still heaves, by a per cent or two of its weight
  assembly.settings.gravity = {0, -g, 0};
  assembly.settings.damping = 0.7;
  assembly.settings.time_step =
      0.5 * critical_step_bound(assembly.law(), assembly.packing(), assembly.walls(), assembly.contacts());
  for (int step = 0; step < 30'000; ++step)
    {
      assembly.compute_forces();
      assembly.move(assembly.box());
    }
  assembly.compute_forces();
  const Snapshot s = assembly.snapshot();
  double weight = 0, floor = 0;
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    weight += s.grains.mass(i) * g;
  for (const WallContact &c : s.wall_contacts)
    {
      if (c.wall == 2)
        floor += c.normal_force;
      EXPECT_NE(c.wall, 3) << "a grain touches the lid";
    }
  EXPECT_NEAR_BECAUSE(floor / weight, 1, 1e-4, "what 30,000 steps with a damping of 0.7 leave of the kinetic energy");
  EXPECT_GT(s.contacts.size(), s.grains.n_grains());
}

TEST(Pluviate, SoftContactsStayRigid)
{
  EXPECT_LT(deposit().young, test::paper_law().young);
  EXPECT_BELOW_BECAUSE(deposit().max_overlap, 1e-3, "what the softened modulus is chosen for");
  EXPECT_BELOW_BECAUSE(deposit().resting_overlap, 1e-4,
                       "the weight of the layer, far below the impact that the modulus is chosen for");
}

TEST(Pluviate, IsLooserThanCompressionWithoutFriction)
{
  // bounds for 500 grains; figures of a real size are in the results
  EXPECT_GT(deposit().void_ratio, 0.65);
  EXPECT_LT(deposit().void_ratio, 1.3);
  EXPECT_GT(deposit().height, 3 * deposit().state.grains.d50());
}

TEST(Pluviate, AStretchedCloudHasNoOverlaps)
{
  struct FirstStep : test::Unobserved
  {
    bool after_step(const Assembly &a, const DriveState &, const Observation &) override
    {
      contacts = a.checkpoint().contacts.size();
      return false;
    }
    std::size_t contacts = 99;
  } first;
  Pluviation how;
  how.fall = 5;
  EXPECT_THROW(pluviate(make_cloud(test::small_grading(2000)), test::paper_law(), how, first), Interrupted);
  EXPECT_EQ(first.contacts, 0u);
}

TEST(Pluviate, RefusesWhatCannotBe)
{
  test::Unobserved nobody;
  const Cloud cloud = single_grain(1e-4, 1e-3);
  EXPECT_THROW(pluviate(cloud, test::paper_law(), {.fall = 0.5}, nobody), InputError);
  EXPECT_THROW(pluviate(cloud, test::paper_law(), {.damping = 1}, nobody), InputError);
  EXPECT_THROW(pluviate(cloud, test::paper_law(), {.overlap_allowed = 0}, nobody), InputError);
}
} // namespace
} // namespace isostat

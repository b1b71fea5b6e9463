// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/stress.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>

namespace isostat
{
namespace
{
Contact pressed(const Snapshot &s, std::uint32_t i, std::uint32_t j, const Vec3 &normal, double force)
{
  const double kn = s.law->stiffness(s.grains.radius(i), s.grains.radius(j), 0).normal;
  Contact c{i, j, force / kn, force, {}};
  c.history.normal = normal;
  return c;
}

WallContact pressed_on_wall(const Snapshot &s, std::uint32_t grain, std::uint8_t wall, double force)
{
  return {grain, wall, force / s.law->wall(s.grains.radius(grain), 0).stiffness, force};
}

/// Unequal spheres in a row along an axis, squeezed by `force` between the two walls; the box is wide.
Snapshot row_between_walls(int axis, const std::vector<double> &radii, double force)
{
  Snapshot s;
  s.grains = make_packing(std::vector<Vec3>(radii.size(), Vec3::Zero()), radii, 2650);
  s.box.upper = Vec3(3e-3, 4e-3, 5e-3);
  const std::uint32_t last = radii.size() - 1;
  s.wall_contacts = {pressed_on_wall(s, 0, 2 * axis, force), pressed_on_wall(s, last, 2 * axis + 1, force)};
  double x = radii[0] - s.wall_contacts[0].overlap;
  for (std::uint32_t i = 0;; ++i)
    {
      Vec3 centre(1.5e-3, 2e-3, 2.5e-3);
      centre[axis] = x;
      s.grains.set_centre(i, centre);
      if (i == last)
        break;
      s.contacts.push_back(pressed(s, i, i + 1, Vec3::Unit(axis), force));
      x += radii[i] + radii[i + 1] - s.contacts.back().overlap;
    }
  s.box.upper[axis] = x + radii[last] - s.wall_contacts[1].overlap;
  return s;
}

/// Largest difference of two tensors against the size of the second.
double misfit(const Mat3 &a, const Mat3 &b) { return (a - b).norm() / b.norm(); }
} // namespace

TEST(Invariants, CompressionIsPositiveAndYIsAxial)
{
  const Vec3 stress(-100, -160, -130); // tension positive: compressed most along y
  EXPECT_DOUBLE_EQ(invariants(stress).p, 130);
  EXPECT_DOUBLE_EQ(invariants(stress).q, 160 - 115);
  Mat3 tensor = stress.asDiagonal();
  tensor(0, 1) = 7; // shear does not enter
  EXPECT_DOUBLE_EQ(invariants(tensor).p, 130);
  EXPECT_DOUBLE_EQ(invariants(tensor).q, 45);
  EXPECT_DOUBLE_EQ(invariants(2 * stress).q, 90);
}

TEST(ContactStress, TwoSpheresGiveTheDyadOfForceAndBranch)
{
  Snapshot s;
  s.grains = make_packing({Vec3::Zero(), Vec3::Zero()}, {2e-4, 1.5e-4}, 2650);
  s.box.upper = Vec3(1e-3, 2e-3, 3e-3);
  s.contacts = {pressed(s, 0, 1, Vec3(0, 1, 0), 3.0)};
  s.contacts[0].history.shear_force = Vec3(0.5, 0, -0.25);
  const Mat3 stress = contact_stress(s);
  const double branch = 3.5e-4 - s.contacts[0].overlap, volume = 6e-9;
  EXPECT_DOUBLE_EQ(stress(1, 1), -3.0 * branch / volume); // compression is negative
  EXPECT_DOUBLE_EQ(stress(0, 1), -0.5 * branch / volume); // force along x, branch along y
  EXPECT_DOUBLE_EQ(stress(2, 1), 0.25 * branch / volume);
  EXPECT_EQ(stress(1, 0), 0); // one frictional contact alone is not in balance: the skew part stays
}

constexpr test::Tolerance few{1e-14, "round-off of some ten operations"};

TEST(ContactStress, EqualsWallStressForRowsInBalance)
{
  for (int axis = 0; axis < 3; ++axis)
    for (const auto &radii : {std::vector<double>{2e-4}, {2e-4, 1.5e-4, 3e-4, 1.5e-4}})
      {
        const double force = 2.5;
        const Snapshot s = row_between_walls(axis, radii, force);
        Mat3 expected = Mat3::Zero();
        expected(axis, axis) = -force / s.box.area(axis);
        EXPECT_BELOW_BECAUSE(misfit(contact_stress(s), expected), few);
        EXPECT_BELOW_BECAUSE((wall_stress(s) - expected.diagonal()).norm(), expected.norm() * few);
      }
}

TEST(ContactStress, EqualsWallStressForAnObliquePairInBalance)
{
  // each sphere leans on three walls and on the other sphere: three axes at once, branch in no special direction
  Snapshot s;
  const std::vector<double> radii{2e-4, 1.3e-4};
  s.grains = make_packing({Vec3::Zero(), Vec3::Zero()}, radii, 2650);
  const double force = 1.7;
  const Vec3 n = Vec3(1, 2, -0.5).normalized();
  s.contacts = {pressed(s, 0, 1, n, force)};
  const Vec3 branch = (radii[0] + radii[1] - s.contacts[0].overlap) * n;
  for (int k = 0; k < 3; ++k)
    {
      const double push = force * std::abs(n[k]);
      const bool first_is_lower = n[k] > 0;
      const auto lower = pressed_on_wall(s, first_is_lower ? 0 : 1, 2 * k, push);
      const auto upper = pressed_on_wall(s, first_is_lower ? 1 : 0, 2 * k + 1, push);
      s.box.upper[k] = radii[0] + radii[1] - lower.overlap - upper.overlap + std::abs(branch[k]);
      s.wall_contacts.push_back(lower);
      s.wall_contacts.push_back(upper);
    }
  const Vec3 walls = wall_stress(s);
  for (int k = 0; k < 3; ++k)
    {
      EXPECT_NEAR_BECAUSE(contact_stress(s)(k, k), walls[k], walls.norm() * few);
      EXPECT_NEAR_BECAUSE(walls[k], -force * std::abs(n[k]) / s.box.area(k), walls.norm() * few);
    }
}

TEST(ContactStress, RotatesWithThePacking)
{
  Snapshot s, rotated;
  const std::vector<double> radii{2e-4, 1.5e-4, 1e-4};
  s.grains = make_packing(std::vector<Vec3>(3, Vec3::Zero()), radii, 2650);
  s.box.upper = Vec3(1e-3, 1e-3, 1e-3);
  s.contacts = {pressed(s, 0, 1, Vec3(1, 2, 3).normalized(), 3), pressed(s, 1, 2, Vec3(-1, 1, 0).normalized(), 1)};
  for (Contact &c : s.contacts)
    c.history.shear_force = 0.1 * c.history.normal.cross(Vec3(1, 0, 0));
  rotated = s;
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (Contact &c : rotated.contacts)
    {
      c.history.normal = turn * c.history.normal;
      c.history.shear_force = turn * c.history.shear_force;
    }
  EXPECT_BELOW_BECAUSE(misfit(contact_stress(rotated), turn * contact_stress(s) * turn.transpose()), few);
}

TEST(WallStress, IsTheMeanOfBothWalls)
{
  Snapshot s = row_between_walls(1, {2e-4}, 2.0);
  s.wall_contacts[1].normal_force = 3.0; // out of balance
  EXPECT_DOUBLE_EQ(wall_stress(s)[1], -2.5 / s.box.area(1));
  EXPECT_EQ(wall_stress(s)[0], 0);
}

TEST(KineticStress, TwoGrainsFlyingApart)
{
  Snapshot s;
  s.grains = make_packing({Vec3(1e-4, 0, 0), Vec3(9e-4, 0, 0)}, {1e-4, 1e-4}, 2650);
  s.box.upper = Vec3(1e-3, 1e-3, 1e-3);
  const Vec3 drift(5, 6, 7), w(0.3, 0, -0.1);
  s.grains.set_linear_velocity(0, drift + w);
  s.grains.set_linear_velocity(1, drift - w);
  const Mat3 expected = -2 * s.grains.mass(0) / s.box.volume() * w * w.transpose(); // the drift is not counted
  EXPECT_BELOW_BECAUSE(misfit(kinetic_stress(s), expected), 1e-12,
                       "a mean velocity of 5 to 7 m/s is taken off one of 0.3 m/s, squared");
}

TEST(KineticStress, AffineMotionIsNoFluctuation)
{
  Snapshot s;
  s.grains =
      make_packing({Vec3(1e-4, 3e-4, 0), Vec3(9e-4, 2e-4, 5e-4), Vec3(4e-4, 8e-4, 1e-4)}, {1e-4, 2e-4, 1.5e-4}, 2650);
  s.box.upper = Vec3(1e-3, 1e-3, 1e-3);
  Mat3 gradient;
  gradient << 1, 2, 0, -1, 3, 0.5, 0, 0, -4;
  for (std::size_t i = 0; i < 3; ++i)
    s.grains.set_linear_velocity(i, Vec3(1, 2, 3) + gradient * s.grains.centre(i));
  EXPECT_BELOW_BECAUSE(kinetic_stress(s, gradient).norm(), 1e-20 * s.grains.density,
                       "round-off of velocities of some m/s, 1e-16 each, squared: 1e-31 and room");
  EXPECT_LT(kinetic_stress(s).trace(), 0);
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/unbalanced.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace isostat
{
namespace
{
/// Three grains in a row along y between the walls y- and y+, and one that touches nothing.
Snapshot balanced_row()
{
  Snapshot s;
  s.grains = make_packing(std::vector<Vec3>(4, Vec3::Zero()), std::vector<double>(4, 1e-4), 2650);
  for (std::uint32_t i = 0; i < 2; ++i)
    {
      s.contacts.push_back({i, i + 1, 1e-8, 2.0, {}});
      s.contacts.back().history.normal = Vec3::UnitY();
    }
  s.wall_contacts = {{0, 2, 1e-8, 2.0}, {2, 3, 1e-8, 2.0}};
  return s;
}
} // namespace

TEST(UnbalancedForce, ZeroInBalance) { EXPECT_EQ(unbalanced_force(balanced_row()), 0); }

TEST(UnbalancedForce, MeanResultantOverMeanContactForce)
{
  Snapshot s = balanced_row();
  s.wall_contacts.pop_back(); // grain 2 is pushed by 2 N and held by nothing
  // grains in contact: 0, 1, 2 with |resultant| 0, 0, 2; contacts: three of 2 N. The rattler 3 does not count.
  EXPECT_DOUBLE_EQ(unbalanced_force(s), (2.0 / 3) / 2.0);
}

TEST(UnbalancedForce, CountsShearForces)
{
  Snapshot s;
  s.grains = make_packing(std::vector<Vec3>(2, Vec3::Zero()), {1e-4, 1e-4}, 2650);
  s.contacts = {Contact{0, 1, 1e-8, 3.0, {}}};
  s.contacts[0].history.normal = Vec3::UnitX();
  s.contacts[0].history.shear_force = Vec3(0, 0, 4);
  s.wall_contacts = {{0, 0, 1e-8, 3.0}, {1, 1, 1e-8, 3.0}}; // normal forces in balance, shear not
  EXPECT_DOUBLE_EQ(unbalanced_force(s), 4.0 / ((5.0 + 3 + 3) / 3));
}

TEST(UnbalancedForce, NoContactsIsZeroNotNaN)
{
  Snapshot s = balanced_row();
  s.contacts.clear();
  s.wall_contacts.clear();
  EXPECT_EQ(unbalanced_force(s), 0);
  EXPECT_EQ(unbalanced_force({}), 0);
}

TEST(InertialNumber, ClosedFormAndLimits)
{
  EXPECT_DOUBLE_EQ(inertial_number(5, 4e-4, 2500, 2.5e5), 2e-3 * 0.1);
  EXPECT_DOUBLE_EQ(inertial_number(-5, 4e-4, 2500, 2.5e5), 2e-3 * 0.1); // extension is as fast
  EXPECT_TRUE(std::isinf(inertial_number(5, 4e-4, 2500, 0)));
  EXPECT_EQ(inertial_number(0, 4e-4, 2500, 0), 0);
}
} // namespace isostat

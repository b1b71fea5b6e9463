// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/measure/energy.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
Snapshot touching_pair()
{
  Snapshot s;
  s.grains = make_packing({Vec3::Zero(), Vec3(3.5e-4, 0, 0)}, {2e-4, 1.5e-4}, 2650);
  s.contacts = {Contact{0, 1, 1e-8, 0, {}}};
  s.contacts[0].history.normal = Vec3::UnitX();
  return s;
}
} // namespace

TEST(StoredEnergy, MovingGrain)
{
  Snapshot s = touching_pair();
  s.grains.set_linear_velocity(0, Vec3(1, 2, 2));
  s.grains.set_angular_velocity(1, Vec3(0, 3, 4));
  const StoredEnergy e = stored_energy(s);
  EXPECT_DOUBLE_EQ(e.translation, 4.5 * s.grains.mass(0));
  EXPECT_DOUBLE_EQ(e.rotation, 12.5 * s.grains.inertia(1));
  EXPECT_DOUBLE_EQ(e.kinetic(), e.total());
}

TEST(StoredEnergy, EachSpringAlone)
{
  const Snapshot s = touching_pair();
  const ContactStiffness k = s.law->stiffness(2e-4, 1.5e-4, 0);

  Snapshot normal = s;
  normal.contacts[0].normal_force = k.normal * 1e-8;
  EXPECT_DOUBLE_EQ(stored_energy(normal).normal, 0.5 * k.normal * 1e-16); // 1/2 kn u^2
  EXPECT_DOUBLE_EQ(stored_energy(normal).total(), stored_energy(normal).normal);

  Snapshot shear = s;
  shear.contacts[0].history.shear_force = Vec3(0, 3, 4);
  EXPECT_DOUBLE_EQ(stored_energy(shear).shear, 12.5 / k.shear);
  EXPECT_DOUBLE_EQ(stored_energy(shear).total(), stored_energy(shear).shear);

  Snapshot rolling = s;
  rolling.contacts[0].history.bending_moment = Vec3(0, 3e-6, 4e-6);
  EXPECT_DOUBLE_EQ(stored_energy(rolling).rolling, 12.5e-12 / k.rolling);
  EXPECT_DOUBLE_EQ(stored_energy(rolling).total(), stored_energy(rolling).rolling);

  Snapshot twisting = s;
  twisting.contacts[0].history.twisting_moment = Vec3(5e-6, 0, 0);
  EXPECT_DOUBLE_EQ(stored_energy(twisting).twisting, 12.5e-12 / k.twisting);
  EXPECT_DOUBLE_EQ(stored_energy(twisting).total(), stored_energy(twisting).twisting);

  Snapshot wall = s;
  wall.wall_contacts = {{1, 3, 1e-8, s.law->wall(1.5e-4, 1e-8).force}};
  EXPECT_DOUBLE_EQ(stored_energy(wall).wall, 0.5 * s.law->young * 1.5e-4 * 1e-16);
  EXPECT_DOUBLE_EQ(stored_energy(wall).elastic(), stored_energy(wall).wall);
}

TEST(StoredEnergy, SpringsThatAreOffHoldNothing)
{
  Snapshot s = touching_pair();
  s.law = LinearRolling().with({false, false, false});
  EXPECT_EQ(stored_energy(s).total(), 0); // and not 0/0
  s.law = LinearRolling().with({true, false, false});
  s.contacts[0].history.shear_force = Vec3(0, 1, 0);
  EXPECT_EQ(stored_energy(s).total(), stored_energy(s).shear);
}

TEST(EnergyBalance, ResidualIsWhatIsNotAccountedFor)
{
  EnergyBalance balance;
  EXPECT_EQ(balance.residual(), 0);
  balance.boundary_work = 100;
  balance.kinetic = 1;
  balance.elastic = 40;
  balance.sliding = 30;
  balance.rolling = 10;
  balance.released = 4;
  balance.damping = 12;
  EXPECT_EQ(balance.dissipated(), 56);
  EXPECT_EQ(balance.residual(), 3);
}
} // namespace isostat

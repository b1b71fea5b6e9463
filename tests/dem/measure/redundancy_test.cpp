// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/hertz_mindlin/law.hpp"
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/measure/redundancy.hpp"
#include "dem/measure/summary.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

#include <random>

namespace isostat
{
namespace
{
constexpr double radius = 2e-4, force = 3.0;

Snapshot loose_grains(std::size_t n)
{
  Snapshot s;
  s.grains = make_packing(std::vector<Vec3>(n, Vec3::Zero()), std::vector<double>(n, radius), 2650);
  s.box.upper = Vec3(1e-3, 1e-3, 1e-3);
  return s;
}

/// A contact along x whose shear force and rolling moment are the given shares of their limits.
Contact contact(const Snapshot &s, std::uint32_t i, std::uint32_t j, double shear = 0, double roll = 0)
{
  Contact c{i, j, 1e-8, force, {}};
  c.history.normal = Vec3::UnitX();
  c.history.shear_force = shear * s.law->friction * force * Vec3(0, 0.6, 0.8);
  c.history.bending_moment =
      roll * s.law.as<LinearRolling>().rolling_length(radius, radius) * force * Vec3(0, 0.8, -0.6);
  return c;
}

/// A chain of four contacts, one of each class, and one grain apart.
Snapshot one_of_each_class()
{
  Snapshot s = loose_grains(6);
  s.contacts = {contact(s, 0, 1, 0.9, 0.9), contact(s, 1, 2, 1, 0.9), contact(s, 2, 3, 0.9, 1), contact(s, 3, 4, 1, 1)};
  return s;
}
} // namespace

TEST(Redundancy, HalfTheCoordinationNumberWhereNothingYields)
{
  Snapshot s = loose_grains(7); // grain 6 touches nothing
  for (std::uint32_t i = 0; i < 6; ++i)
    for (std::uint32_t j = i + 1; j < 6; ++j)
      s.contacts.push_back(contact(s, i, j, 0.5, 0.5));
  const ContactNetwork network = contact_network(s);
  EXPECT_EQ(network.classes.nsr, 15u);
  EXPECT_EQ(network.grains.without, 1u);
  const double z = network.coordination_number();
  EXPECT_EQ(z, 5.0); // 2 x 15 / 6
  EXPECT_EQ(network.redundancy_index(), z / 2);
  EXPECT_DOUBLE_EQ(network.redundancy_index_without_twist(), 5 * z / 12);
  EXPECT_DOUBLE_EQ(network.redundancy_index_sliding(), z / 4);
}

TEST(Redundancy, CountsContactsWithinAMarginOfTheirLimits)
{
  const Snapshot s = one_of_each_class(); // at 0.9 or 1 of their limits
  EXPECT_EQ(contact_network(s, 0.09).classes.nsr, 1u);
  EXPECT_EQ(contact_network(s, 0.11).classes.sr, 4u);
  EXPECT_DOUBLE_EQ(micromechanics(s, 0.11).network.redundancy_index(), 4 * 2 / 30.0);
}

TEST(Redundancy, HandMadeClasses)
{
  const ContactNetwork network = contact_network(one_of_each_class());
  EXPECT_EQ(network.classes.nsr, 1u);
  EXPECT_EQ(network.classes.s, 1u);
  EXPECT_EQ(network.classes.r, 1u);
  EXPECT_EQ(network.classes.sr, 1u);
  EXPECT_EQ(network.fraction(network.classes.sr), 0.25);
  EXPECT_DOUBLE_EQ(network.redundancy_index(), (6 + 4 + 4 + 2) / 30.0);
  EXPECT_DOUBLE_EQ(network.redundancy_index_eq2(), (6 + 4 + 4 + 2) / 30.0);
  EXPECT_DOUBLE_EQ(network.redundancy_index_without_twist(), (5 + 3 + 3 + 1) / 30.0);
  EXPECT_DOUBLE_EQ(network.redundancy_index_sliding(), (3 + 1 + 3 + 1) / 30.0);
}

TEST(Redundancy, IsThatOfTheLawInWhichOneIsIsostatic)
{
  struct Case
  {
    LawFeatures on;
    int constraints;
    double isostatic_at, nothing_yields; // Z; index of the ring below, Z = 2
    double one_of_each;                  // of one_of_each_class(), five grains
    const char *name;
  };
  const Case cases[] = {
      {{true, true, true}, 6, 2, 1, (6 + 4 + 4 + 2) / 30.0, "6 constraints a contact (Eq. 2), isostatic at Z = 2"},
      {{true, true, false}, 5, 2.4, 5 / 6.0, (5 + 3 + 3 + 1) / 30.0, "5 constraints a contact, isostatic at Z = 2.4"},
      {{true, false, true}, 4, 3, 4 / 6.0, (4 + 2 + 4 + 2) / 30.0, "4 constraints a contact, isostatic at Z = 3"},
      {{true, false, false}, 3, 4, 3 / 6.0, (3 + 1 + 3 + 1) / 30.0, "3 constraints a contact, isostatic at Z = 4"},
      {{false, false, false}, 1, 6, 1 / 3.0, 4 / 15.0, "1 constraint a contact, isostatic at Z = 6"},
  };
  Snapshot ring = loose_grains(5);
  for (std::uint32_t i = 0; i < 5; ++i)
    ring.contacts.push_back(contact(ring, i, (i + 1) % 5, 0.5, 0.5));
  for (const Case &c : cases)
    {
      ring.law = with_features(LinearRolling(), c.on);
      const ContactNetwork network = contact_network(ring);
      EXPECT_EQ(network.law.number(), c.constraints);
      EXPECT_DOUBLE_EQ(isostatic_coordination(c.constraints), c.isostatic_at);
      EXPECT_DOUBLE_EQ(network.redundancy_index(), c.nothing_yields);
      EXPECT_DOUBLE_EQ(network.redundancy_index(), network.coordination_number() / c.isostatic_at);
      EXPECT_DOUBLE_EQ(network.redundancy_index_eq2(), 1) << "whatever the law";
      EXPECT_EQ(index_name(c.constraints), c.name);
      Snapshot yielding = one_of_each_class();
      yielding.law = ring.law;
      EXPECT_DOUBLE_EQ(contact_network(yielding).redundancy_index(), c.one_of_each) << c.name;
    }
  ring.law = HertzMindlin(); // the springs of any law
  EXPECT_EQ(constraints_of(ring.law).number(), 6);
  ring.law->friction = 0;
  EXPECT_EQ(constraints_of(ring.law).number(), 1);
}

TEST(Redundancy, IsTheFormulaOfThePaperOnRecordedClasses)
{
  // classes of a recorded packing of 1,000 grains in compression, with the index computed from Eq. (2) alongside
  const ContactNetwork network{{747, 878, 15, 76}, {1000, 167, 0, 167}};
  EXPECT_NEAR_BECAUSE(network.redundancy_index(), 1.641856743, 1e-9, "the digits given");
  EXPECT_NEAR_BECAUSE(network.coordination_number(), 4.120048019, 1e-9, "the digits given");
}

TEST(Redundancy, NeverBelowOneSixth)
{
  std::mt19937 random(7);
  const double shares[] = {0.5, 1.0};
  for (int trial = 0; trial < 50; ++trial)
    {
      Snapshot s = loose_grains(20);
      for (std::uint32_t i = 0; i < 20; ++i)
        for (std::uint32_t j = i + 1; j < 20; ++j)
          if (random() % 20 == 0)
            s.contacts.push_back(contact(s, i, j, shares[random() % 2], shares[random() % 2]));
      if (s.contacts.empty())
        continue;
      EXPECT_GE(contact_network(s).redundancy_index(), 1.0 / 6 - 1e-15);
    }
  Snapshot worst = loose_grains(4); // pairs that slide and roll: the bound is reached
  worst.contacts = {contact(worst, 0, 1, 1, 1), contact(worst, 2, 3, 1, 1)};
  EXPECT_DOUBLE_EQ(contact_network(worst).redundancy_index(), 1.0 / 6);
}

TEST(Redundancy, WhatTheLawLeavesOutDoesNotYield)
{
  Snapshot s = one_of_each_class();
  s.law.as<LinearRolling>().rolling = false;
  EXPECT_EQ(contact_network(s).classes.r + contact_network(s).classes.sr, 0u);
  EXPECT_EQ(contact_network(s).classes.s, 2u);
  s.law->friction = 0;
  EXPECT_EQ(contact_network(s).classes.nsr, 4u);
}

TEST(Redundancy, NoContactsIsZeroNotNaN)
{
  for (std::size_t n : {0, 3})
    {
      Snapshot s = loose_grains(n);
      const ContactNetwork network = contact_network(s);
      EXPECT_EQ(network.grains.without, n);
      for (double value : {network.redundancy_index(), network.redundancy_index_without_twist(),
                           network.redundancy_index_sliding(), network.coordination_number(),
                           network.mechanical_coordination_number(), network.fraction(network.classes.nsr)})
        EXPECT_EQ(value, 0);
    }
}

TEST(Redundancy, RattlersLeaveTheMechanicalCoordinationNumber)
{
  Snapshot s = loose_grains(6); // a triangle, one grain touching it, two apart of which one touches a wall
  s.contacts = {contact(s, 0, 1), contact(s, 0, 2), contact(s, 1, 2), contact(s, 2, 3)};
  s.wall_contacts = {{4, 0, 1e-8, force}};
  const ContactNetwork network = contact_network(s);
  EXPECT_EQ(network.grains.without, 2u);
  EXPECT_EQ(network.grains.single, 1u);
  EXPECT_EQ(network.grains.without_walls, 1u);
  EXPECT_DOUBLE_EQ(network.coordination_number(), 2.0);                // 8 / 4
  EXPECT_DOUBLE_EQ(network.mechanical_coordination_number(), 7.0 / 3); // (8 - 1) / (6 - 2 - 1)

  s.contacts = {contact(s, 0, 1)}; // no grain has two contacts
  EXPECT_EQ(contact_network(s).mechanical_coordination_number(), 0);
}
} // namespace isostat

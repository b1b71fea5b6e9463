// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/summary.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

namespace isostat
{
namespace
{
constexpr double radius = 1e-4;
constexpr int side = 4;

/// Simple cubic lattice of side^3 equal grains in its box, each row along axis k squeezed by force[k]: in balance.
Snapshot cubic_lattice(const Vec3 &force)
{
  Snapshot s;
  const auto index = [](int i, int j, int k) { return static_cast<std::uint32_t>((i * side + j) * side + k); };
  const double stiffness = s.law->young * radius; // grain-grain and wall alike: equal radii
  const Vec3 overlap = force / stiffness;
  std::vector<Vec3> centres;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j)
      for (int k = 0; k < side; ++k)
        {
          const int place[3] = {i, j, k};
          Vec3 centre;
          for (int axis = 0; axis < 3; ++axis)
            {
              const std::uint32_t self = index(i, j, k);
              centre[axis] = (2 * place[axis] + 1) * radius - (place[axis] + 1) * overlap[axis];
              if (place[axis] == 0)
                s.wall_contacts.push_back({self, std::uint8_t(2 * axis), overlap[axis], force[axis]});
              if (place[axis] == side - 1)
                s.wall_contacts.push_back({self, std::uint8_t(2 * axis + 1), overlap[axis], force[axis]});
              else
                {
                  const std::uint32_t other = index(i + (axis == 0), j + (axis == 1), k + (axis == 2));
                  s.contacts.push_back({self, other, overlap[axis], force[axis], {}});
                  s.contacts.back().history.normal = Vec3::Unit(axis);
                }
            }
          centres.push_back(centre);
        }
  s.grains = make_packing(centres, std::vector<double>(centres.size(), radius), 2650);
  s.box.upper = Vec3::Constant(2 * side * radius) - (side + 1) * overlap;
  return s;
}
} // namespace

constexpr test::Tolerance sums{1e-13, "round-off of sums over some hundred contacts"};

TEST(Micromechanics, CubicLatticeInBalance)
{
  const Vec3 force(1, 3, 1);
  const Snapshot s = cubic_lattice(force);
  const Micromechanics m = micromechanics(s);
  Vec3 pressure;
  for (int k = 0; k < 3; ++k)
    pressure[k] = side * side * force[k] / s.box.area(k);
  const double p = pressure.mean(), q = pressure[1] - 0.5 * (pressure[0] + pressure[2]);
  EXPECT_NEAR_BECAUSE(m.wall.p, p, p * sums);
  EXPECT_NEAR_BECAUSE(m.wall.q, q, p * sums);
  EXPECT_NEAR_BECAUSE(m.contact.p, p, p * sums);
  EXPECT_NEAR_BECAUSE(m.contact.q, q, p * sums);
  // V/V_s = 6/pi for touching spheres, less what the five overlaps of a row shorten each edge
  const Vec3 shortening = (side + 1) * force / (s.law->young * radius) / (2 * side * radius);
  const double ratio = 6 / std::numbers::pi * (Vec3::Ones() - shortening).prod();
  EXPECT_NEAR_BECAUSE(m.void_ratio, ratio - 1, sums);
  EXPECT_DOUBLE_EQ(m.network.classes.total(), 3 * side * side * (side - 1));
  EXPECT_DOUBLE_EQ(m.network.coordination_number(), 6.0 * (side - 1) / side);
  EXPECT_DOUBLE_EQ(m.network.redundancy_index(), m.network.coordination_number() / 2);
  EXPECT_DOUBLE_EQ(m.network.mechanical_coordination_number(), m.network.coordination_number()); // no rattlers
  EXPECT_EQ(m.network.fraction(m.network.classes.nsr), 1);
  EXPECT_EQ(m.network.grains.without, 0);
  EXPECT_DOUBLE_EQ(m.n_wall_contacts, 6 * side * side);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR_BECAUSE(m.fabric(k, k), 1.0 / 3, 1e-15, "round-off of a mean of unit dyads");
  EXPECT_NEAR_BECAUSE(m.anisotropies.contact.along_y(), 0, 1e-14,
                      "round-off of a difference of equal terms, times 7.5");
  EXPECT_NEAR_BECAUSE(m.anisotropies.normal_force.along_y(), 7.5 * (0.6 - 0.2), sums); // X/f0 = diag(1, 3, 1)/5
  EXPECT_NEAR_BECAUSE(m.unbalanced, 0, 1e-15, "forces cancel to their last digit");
  EXPECT_EQ(m.energy.kinetic(), 0);
  const double springs = side * side * (side + 1) * 0.5 * force.squaredNorm() / (s.law->young * radius);
  EXPECT_NEAR_BECAUSE(m.energy.elastic(), springs, springs * sums);
}

TEST(Micromechanics, ColumnsAndRowsBelongTogether)
{
  const Micromechanics m = micromechanics(cubic_lattice(Vec3(1, 2, 3)));
  const auto &columns = Micromechanics::columns();
  const std::vector<double> row = m.row();
  ASSERT_EQ(row.size(), columns.size());
  std::set<std::string> names;
  for (std::size_t i = 0; i < row.size(); ++i)
    {
      EXPECT_TRUE(names.insert(columns[i].first).second) << columns[i].first << " appears twice";
      EXPECT_FALSE(columns[i].second.empty());
      const double expected = columns[i].first == "IR"     ? m.network.redundancy_index()
                              : columns[i].first == "q_LW" ? m.contact.q
                                                           : row[i];
      EXPECT_EQ(row[i], expected);
    }
  EXPECT_TRUE(names.contains("IR") && names.contains("q_LW"));
  EXPECT_EQ(columns.front(), (std::pair<std::string, std::string>{"p", "Pa"}));
}

TEST(Micromechanics, LooseGrainsGiveZerosNotNaN)
{
  Snapshot s = cubic_lattice(Vec3(1, 1, 1));
  s.contacts.clear();
  s.wall_contacts.clear();
  Micromechanics m = micromechanics(s);
  EXPECT_GT(m.void_ratio, 0);
  EXPECT_EQ(m.network.grains.without, side * side * side);
  m.void_ratio = 0;
  m.network.grains = {};
  m.wall.q = -0.0; // as of stresses that are sums of nothing, less themselves
  const std::vector<double> row = m.row();
  for (std::size_t i = 0; i < row.size(); ++i)
    {
      EXPECT_EQ(row[i], Micromechanics::columns()[i].first == "IR_constraints" ? 6 : 0) << "those of the law";
      EXPECT_FALSE(std::signbit(row[i])) << "a sum over ranks gives 0 for it";
    }
}
} // namespace isostat

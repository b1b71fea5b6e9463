// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/fabric.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <numbers>

namespace isostat
{
namespace
{
/// Contacts with given normals and unit normal force; the grains do not matter to the fabric.
Snapshot contacts_along(const std::vector<Vec3> &normals, double force = 1)
{
  Snapshot s;
  for (const Vec3 &n : normals)
    {
      Contact c{0, 1, 1e-8, force, {}};
      c.history.normal = n.normalized();
      s.contacts.push_back(c);
    }
  return s;
}

/// Axially symmetric deviator about y with along_y() = a.
Mat3 about_y(double a) { return Vec3(-a / 3, 2 * a / 3, -a / 3).asDiagonal(); }

/// Evenly spread directions with density (1 + a (3 y^2 - 1)/3)/4pi, that is a_c = about_y(a): stratified in y by
/// inverting the cumulative distribution, golden angle around y.
std::vector<Vec3> directions(std::size_t n, double a)
{
  std::vector<Vec3> result;
  for (std::size_t k = 0; k < n; ++k)
    {
      const double target = (k + 0.5) / n, angle = k * std::numbers::pi * (3 - std::sqrt(5.0));
      double low = -1, high = 1;
      for (int i = 0; i < 60; ++i)
        {
          const double y = 0.5 * (low + high);
          (0.5 * (y + 1 + a / 3 * (y * y * y - y)) < target ? low : high) = y;
        }
      const double y = 0.5 * (low + high), r = std::sqrt(1 - y * y);
      result.emplace_back(r * std::cos(angle), y, r * std::sin(angle));
    }
  return result;
}

/// Forces that follow the second-order expansions exactly.
Snapshot expanded_forces(double a_c, const Mat3 &a_n, const Mat3 &a_t, double f0)
{
  Snapshot s = contacts_along(directions(20000, a_c));
  for (Contact &c : s.contacts)
    {
      const Vec3 n = c.history.normal;
      c.normal_force = f0 * (1 + n.dot(a_n * n));
      c.history.shear_force = f0 * (a_t * n - n.dot(a_t * n) * n);
    }
  return s;
}

void turn(Snapshot &s, const Mat3 &rotation)
{
  for (Contact &c : s.contacts)
    {
      c.history.normal = rotation * c.history.normal;
      c.history.shear_force = rotation * c.history.shear_force;
    }
}

Mat3 some_rotation() { return Eigen::AngleAxisd(1.1, Vec3(2, -1, 0.5).normalized()).toRotationMatrix(); }
} // namespace

TEST(Fabric, CubicLatticeIsIsotropic)
{
  const Mat3 fabric = contact_fabric(contacts_along({Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}));
  EXPECT_BELOW_BECAUSE((fabric - Mat3::Identity() / 3).norm(), 1e-15, "round-off of a mean of three dyads");
  EXPECT_NEAR_BECAUSE(fabric_y_minus_x(fabric), 0, 1e-15, "round-off of a mean of three dyads");
  EXPECT_NEAR_BECAUSE(fabric_y_minus_z(fabric), 0, 1e-15, "round-off of a mean of three dyads");
}

TEST(Fabric, OneDirection)
{
  const Snapshot s = contacts_along({Vec3::UnitY(), -Vec3::UnitY()}); // the sense of a normal does not matter
  const Mat3 fabric = contact_fabric(s);
  EXPECT_EQ(fabric(1, 1), 1);
  EXPECT_EQ(fabric.norm(), 1);
  EXPECT_EQ(fabric_y_minus_x(fabric), 1);
  EXPECT_EQ(fabric_y_minus_z(fabric), 1);
  const Anisotropies a = anisotropies(s);
  EXPECT_DOUBLE_EQ(a.contact.along_y(), 7.5); // 15/2 (2/3 + 1/3)
  EXPECT_DOUBLE_EQ(a.contact.intensity(), 7.5);
}

constexpr test::Tolerance unit{1e-15, "round-off of a mean of four dyads of unit vectors"};

TEST(Fabric, TraceIsOneAndRotates)
{
  Snapshot s = contacts_along({Vec3(1, 2, 3), Vec3(-2, 1, 0), Vec3(0, 1, 5), Vec3(1, 1, -1)});
  const Mat3 before = contact_fabric(s);
  EXPECT_NEAR_BECAUSE(before.trace(), 1, unit);
  EXPECT_EQ(before, Mat3(before.transpose()));
  turn(s, some_rotation());
  EXPECT_BELOW_BECAUSE((contact_fabric(s) - some_rotation() * before * some_rotation().transpose()).norm(), unit);
}

TEST(Anisotropies, RecoverTheExpansionTheForcesCameFrom)
{
  const double a_c = 0.4, f0 = 2.5;
  Mat3 a_n;
  a_n << -0.3, 0.1, 0.05, 0.1, 0.5, 0, 0.05, 0, -0.2;
  const Mat3 a_t = about_y(0.25);
  const Anisotropies a = anisotropies(expanded_forces(a_c, a_n, a_t, f0));
  constexpr test::Tolerance directions{1e-3, "20,000 directions stand for all"};
  EXPECT_BELOW_BECAUSE((a.contact.tensor - about_y(a_c)).norm(), directions);
  EXPECT_BELOW_BECAUSE((a.normal_force.tensor - a_n).norm(), directions);
  EXPECT_BELOW_BECAUSE((a.tangential_force.tensor - a_t).norm(), directions);
  EXPECT_NEAR_BECAUSE(a.mean_normal_force, f0, f0 * directions);
  EXPECT_NEAR_BECAUSE(a.contact.along_y(), a_c, directions);
  EXPECT_NEAR_BECAUSE(a.contact.intensity(), a_c, directions);
  EXPECT_EQ(a.outside_expansion, 0u);
}

TEST(Anisotropies, SumToTheStressRatio)
{
  // equal branches: sigma ~ <F n>; q/p' = 2/5 (a_c + a_n + 3/2 a_t) up to products of anisotropies
  const double a_c = 0.03, a_n = 0.05, a_t = 0.02;
  const Snapshot s = expanded_forces(a_c, about_y(a_n), about_y(a_t), 1);
  Mat3 sum = Mat3::Zero();
  for (const Contact &c : s.contacts)
    sum += (c.normal_force * c.history.normal + c.history.shear_force) * c.history.normal.transpose();
  const double ratio = (sum(1, 1) - 0.5 * (sum(0, 0) + sum(2, 2))) / (sum.trace() / 3);
  EXPECT_NEAR_BECAUSE(ratio, 0.4 * (a_c + a_n + 1.5 * a_t), 0.02 * ratio,
                      "products of anisotropies, up to 0.05, are left out of the sum");
}

constexpr test::Tolerance rotated{1e-12, "round-off of 20,000 rotated vectors"};

TEST(Anisotropies, RotateAndChangeSign)
{
  Snapshot s = expanded_forces(0.3, about_y(0.4), about_y(0.1), 1);
  const Anisotropies before = anisotropies(s);
  const Mat3 q = some_rotation();
  turn(s, q);
  const Anisotropies after = anisotropies(s);
  for (auto part : {&Anisotropies::contact, &Anisotropies::normal_force, &Anisotropies::tangential_force})
    {
      EXPECT_BELOW_BECAUSE(((after.*part).tensor - q * (before.*part).tensor * q.transpose()).norm(), rotated);
      EXPECT_NEAR_BECAUSE((after.*part).tensor.trace(), 0, 1e-14, "round-off of a mean of 20,000 deviators");
      EXPECT_NEAR_BECAUSE((after.*part).intensity(), (before.*part).intensity(), rotated);
    }
  EXPECT_NEAR_BECAUSE(anisotropies(expanded_forces(-0.3, about_y(-0.4), about_y(0), 1)).normal_force.along_y(), -0.4,
                      1e-3, "20,000 directions stand for all");
}

TEST(Anisotropies, AlignedContactsStayFiniteAndAreCounted)
{
  std::vector<Vec3> normals(9, Vec3::UnitY());
  normals.push_back(Vec3::UnitX()); // 1 + a_c:nn = 1 + 7.5 (0.1 - 1/3) < 0
  const Anisotropies a = anisotropies(contacts_along(normals));
  EXPECT_EQ(a.outside_expansion, 1u);
  EXPECT_GT(a.mean_normal_force, 0);
  EXPECT_TRUE(a.normal_force.tensor.allFinite());
}

TEST(Fabric, NoContactsIsZeroNotNaN)
{
  EXPECT_EQ(contact_fabric({}).norm(), 0);
  EXPECT_EQ(anisotropies({}).contact.tensor.norm(), 0);
  EXPECT_EQ(force_chains({}).strong_fraction, 0);
  EXPECT_EQ(anisotropies(contacts_along({Vec3::UnitX()}, 0.0)).normal_force.tensor.norm(), 0);
}

TEST(ForceChains, StrongColumnsInAWeakNet)
{
  Snapshot s = contacts_along({Vec3::UnitY(), Vec3::UnitX(), Vec3::UnitZ(), Vec3::UnitX()});
  s.contacts[0].normal_force = 9; // mean 3
  const ForceChains chains = force_chains(s);
  EXPECT_EQ(chains.mean_normal_force, 3);
  EXPECT_EQ(chains.strong_fraction, 0.25);
  EXPECT_EQ(chains.strong(1, 1), 1);
  EXPECT_EQ(chains.weak(1, 1), 0);
  EXPECT_NEAR_BECAUSE(chains.weak.trace(), 1, unit);
  const Mat3 both = 0.25 * chains.strong + 0.75 * chains.weak;
  EXPECT_BELOW_BECAUSE((both - contact_fabric(s)).norm(), unit);
  EXPECT_EQ(force_chains(contacts_along({Vec3::UnitX()})).strong.norm(), 0); // all equal: none is above the mean
}
} // namespace isostat

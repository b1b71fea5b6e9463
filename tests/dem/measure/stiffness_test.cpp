// SPDX-License-Identifier: BSD-3-Clause
#include "dem/contact/linear_rolling/law.hpp"
#include "dem/measure/stiffness.hpp"

#include "base/error.hpp"
#include "tests/dem/measure/lattices.hpp"
#include "tests/support/near.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <limits>
#include <random>

namespace isostat
{
namespace
{
using namespace test;

double misfit(const Eigen::MatrixXd &a, const Eigen::MatrixXd &b) { return (a - b).norm() / b.norm(); }

double min_eigenvalue(const Mat6 &c)
{
  return Eigen::SelfAdjointEigenSolver<Mat6>(c, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

/// Adds a grain that touches nothing yet; returns its number.
std::uint32_t add_grain(Snapshot &s, double size)
{
  std::vector<double> radii;
  for (std::size_t i = 0; i < s.grains.n_grains(); ++i)
    radii.push_back(s.grains.radius(i));
  radii.push_back(size);
  s.grains = make_packing(std::vector<Vec3>(radii.size(), Vec3::Zero()), radii, 2650);
  return radii.size() - 1;
}

const ContactStiffness equal_spheres = LinearRolling{}.stiffness(radius, radius);
const double kn = equal_spheres.normal, ks = alpha * equal_spheres.shear; // N/m, of one contact
} // namespace

constexpr Tolerance summed{1e-13, "round-off of a sum over the contacts"};
constexpr Tolerance eliminated{1e-12, "round-off of an elimination of some hundred unknowns"};
constexpr Tolerance solved_twice{1e-8,
                                 "a pseudo-inverse of squared condition, which drops singular values below 1e-12"};
constexpr Tolerance held{1e-9, "what moves freely is held by 1e-10 of the largest stiffness"};
constexpr Tolerance differences{1e-5, "central differences of the return mapping"};

TEST(Stiffness, SimpleCubicLattice)
{
  // one contact per axis and cell; gamma_yz shears those along y and z by l gamma/2 each, and nothing turns
  const Mat6 expected = cubic(kn / branch, 0, ks / (2 * branch));
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(simple_cubic()), expected), eliminated);
  EXPECT_BELOW_BECAUSE(misfit(affine_stiffness(simple_cubic()), expected), summed);
}

TEST(Stiffness, OneGrainThatTouchesItsOwnImages)
{
  Snapshot s;
  s.grains = make_packing({Vec3::Zero()}, {radius}, 2650);
  set_volume(s, std::pow(branch, 3));
  for (int axis = 0; axis < 3; ++axis)
    s.contacts.push_back({0, 0, squeeze, 1.0, {Vec3::Unit(axis)}});
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(s), condensed_stiffness(simple_cubic())), eliminated);
  make_sliding(s, s.contacts[2]);
  EXPECT_BELOW_BECAUSE(condensed_stiffness(s, Sliding::plastic)(3, 3), kn / branch * held);
  s.law->friction = 0; // not one unknown
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(s), cubic(kn / branch, 0, 0)), eliminated);
}

TEST(Stiffness, FaceCentredLattice)
{
  // six directions per grain: sum nx^4 = 1, sum nx^2 ny^2 = 1/2, sum nx^2 = 2; l^2/V = sqrt(2)/l
  const Mat6 expected = std::sqrt(2) / branch * cubic(kn + ks, (kn - ks) / 2, (kn + ks) / 2);
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(face_centred()), expected), eliminated);
  EXPECT_BELOW_BECAUSE(misfit(affine_stiffness(face_centred()), expected), summed);
}

TEST(Stiffness, BodyCentredLattice)
{
  // four directions per grain: sum nx^4 = sum nx^2 ny^2 = 4/9, sum nx^2 = 4/3; l^2/V = 3 sqrt(3)/(4 l)
  const double scale = 3 * std::sqrt(3) / (4 * branch) / 9;
  const Mat6 expected = scale * cubic(4 * kn + 8 * ks, 4 * kn - 4 * ks, 4 * kn + 2 * ks);
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(body_centred()), expected), eliminated);
}

TEST(Stiffness, WithoutFrictionOnlyNormalsResist)
{
  Snapshot s = simple_cubic();
  s.law->friction = 0;
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(s), cubic(kn / branch, 0, 0)), eliminated);
  s = face_centred();
  s.law->friction = 0;
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(s), std::sqrt(2) / branch * cubic(kn, kn / 2, kn / 2)), eliminated);
}

TEST(Stiffness, LatticeWhoseContactsAlongZSlide)
{
  // grains turn by gamma/2 with the rows that still grip, and gamma_yz costs nothing; eps_zz moves the limit, -mu fn y
  Snapshot s = simple_cubic();
  for (Contact &c : s.contacts)
    if (std::abs(c.history.normal[2]) > 0.5)
      make_sliding(s, c);
  Mat6 expected = cubic(kn / branch, 0, ks / (2 * branch));
  expected(3, 3) = 0;
  expected(3, 2) = -s.law->friction * kn / branch;
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(s, Sliding::plastic), expected), held);
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(s), condensed_stiffness(simple_cubic())), 1e-15, "the same sums");
  expected(3, 3) = ks / (4 * branch); // no turning: half of the contacts are left
  expected(3, 2) /= 2;
  EXPECT_BELOW_BECAUSE(misfit(affine_stiffness(s, Sliding::plastic), expected), summed);
}

TEST(Stiffness, IsotropicDirectionsGiveTheVoigtBoundOfWalton)
{
  // the six axes of an icosahedron average products of four components as all directions do
  const double golden = (1 + std::sqrt(5)) / 2;
  Snapshot s;
  s.grains = make_packing({Vec3::Zero(), Vec3::Zero()}, {radius, radius}, 2650);
  set_volume(s, 1e-9);
  for (int axis = 0; axis < 3; ++axis)
    for (double sign : {1.0, -1.0})
      {
        Vec3 n = Vec3::Unit(axis);
        n[(axis + 1) % 3] = sign * golden;
        s.contacts.push_back(closed(0, 1, n.normalized(), squeeze));
      }
  const double scale = 6 * branch * branch / 1e-9 / 30;
  const Mat6 expected = scale * cubic(6 * kn + 4 * ks, 2 * kn - 2 * ks, 2 * kn + 3 * ks);
  EXPECT_BELOW_BECAUSE(misfit(affine_stiffness(s), expected), summed);
}

TEST(Stiffness, ShearForceIsThatOfTheContactLaw)
{
  Snapshot s;
  s.grains = make_packing({Vec3::Zero(), Vec3::Zero()}, {radius, radius / 2}, 2650);
  set_volume(s, 1e-9);
  s.contacts = {closed(0, 1, Vec3::UnitX(), squeeze)};
  const double l = 1.5 * radius - squeeze, gamma = 1e-6;
  ContactPair pair{Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), l * Vec3::UnitX(), l * gamma / 2 * Vec3::UnitY(),
                   Vec3::Zero(), radius,       radius / 2};
  ContactHistory history = s.contacts[0].history;
  contact_force(s.law.as<LinearRolling>(), pair, 1.0, history); // eps_xy = gamma/2
  const double stress = affine_stiffness(s)(5, 5) * gamma;
  EXPECT_NEAR_BECAUSE(stress, -history.shear_force[1] * l / 2 / s.box.volume(), 1e-12 * stress,
                      "round-off of some ten operations");
}

TEST(Stiffness, ColumnOfUnequalGrainsIsARowOfSprings)
{
  const std::vector<double> radii{2e-4, 1e-4, 3e-4, 1.5e-4};
  Snapshot s;
  s.grains = make_packing(std::vector<Vec3>(4, Vec3::Zero()), radii, 2650);
  double length = 0, compliance = 0;
  for (std::uint32_t i = 0; i < 4; ++i)
    {
      const std::uint32_t j = (i + 1) % 4;
      s.contacts.push_back(closed(i, j, Vec3::UnitZ(), (i + 1) * 1e-6));
      length += radii[i] + radii[j] - s.contacts.back().overlap;
      compliance += 1 / s.law->stiffness(radii[i], radii[j], 0).normal;
    }
  s.box.upper = Vec3(1e-3, 2e-3, length);
  Mat6 expected = Mat6::Zero(); // shear: the column turns as a whole
  expected(2, 2) = length * length / compliance / s.box.volume();
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(s), expected), eliminated);
  EXPECT_GT(affine_stiffness(s)(2, 2), 1.05 * expected(2, 2));
  EXPECT_GT(affine_stiffness(s)(3, 3), 0.01 * expected(2, 2));
}

TEST(Stiffness, EqualsADensePseudoInverse)
{
  const LawFeatures laws[] = {{true, true, true}, {true, true, false}, {true, false, false}, {false, false, false}};
  for (double swell : {1.06, 1.25})
    for (const LawFeatures &law : laws)
      for (Sliding sliding : {Sliding::elastic, Sliding::plastic})
        {
          Snapshot s = disordered(3, swell, 5);
          s.law = LinearRolling().with(law);
          const Mat6 expected = dense_stiffness(s, sliding);
          const Tolerance solved = sliding == Sliding::elastic ? solved_twice : differences;
          EXPECT_BELOW_BECAUSE((condensed_stiffness(s, sliding) - expected).norm(),
                               affine_stiffness(s).norm() * solved);
          if (law.rolling)
            {
              EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(s, sliding), expected), solved);
            }
        }
}

TEST(Stiffness, SymmetricAndBetweenZeroAndTheAffineBound)
{
  for (unsigned seed = 0; seed < 20; ++seed)
    {
      const Snapshot s = disordered(4, 1 + 0.015 * seed, seed);
      const Mat6 c = condensed_stiffness(s), bound = affine_stiffness(s);
      const double rounding = 1e-12 * bound.norm();
      EXPECT_EQ((c - c.transpose()).norm(), 0);
      EXPECT_GE(min_eigenvalue(c), -rounding);
      EXPECT_GE(min_eigenvalue(bound - c), -rounding);
      EXPECT_GT((bound - c).norm(), 0.01 * bound.norm());
    }
}

TEST(Stiffness, TurnsWithThePacking)
{
  const Snapshot s = disordered(4, 1.15, 11);
  const Mat3 q = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  Snapshot turned = s;
  for (Contact &c : turned.contacts)
    for (Vec3 *v : {&c.history.normal, &c.history.shear_force, &c.history.bending_moment})
      *v = q * *v;
  const Mat6 m = turned_strains(q);
  for (Sliding sliding : {Sliding::elastic, Sliding::plastic})
    {
      const Mat6 c = condensed_stiffness(turned, sliding);
      EXPECT_BELOW_BECAUSE(misfit(m.transpose() * c * m, condensed_stiffness(s, sliding)), 1e-10,
                           "round-off of an elimination of some hundred unknowns, grown by its condition");
      EXPECT_GT(misfit(c, condensed_stiffness(s, sliding)), 1e-3);
    }
}

TEST(Stiffness, GrainsWithoutLoadChangeNothing)
{
  Snapshot s = disordered(3, 1.2, 3);
  const Mat6 c = condensed_stiffness(s), bound = affine_stiffness(s);
  const std::uint32_t rattler = add_grain(s, radius);
  EXPECT_EQ((condensed_stiffness(s) - c).norm(), 0);
  EXPECT_EQ((affine_stiffness(s) - bound).norm(), 0);
  s.contacts.push_back(closed(4, rattler, Vec3(1, 2, 3).normalized(), squeeze));
  EXPECT_EQ((condensed_stiffness(s) - c).norm(), 0);
  const std::uint32_t last = add_grain(s, radius / 2); // a chain of two attached to grain 4
  s.contacts.push_back(closed(rattler, last, Vec3(1, -2, 1).normalized(), squeeze));
  EXPECT_EQ((condensed_stiffness(s) - c).norm(), 0);
  EXPECT_GT((affine_stiffness(s) - bound).norm(), 1e-3 * bound.norm());
}

TEST(Stiffness, ClustersAddUp)
{
  Snapshot s = disordered(3, 1.2, 3);
  const Mat6 c = condensed_stiffness(s);
  const std::uint32_t n = s.grains.n_grains();
  const std::vector<Contact> single = s.contacts;
  for (std::uint32_t i = 0; i < n; ++i)
    add_grain(s, s.grains.radius(i));
  for (Contact copy : single)
    {
      copy.first += n;
      copy.second += n;
      s.contacts.push_back(copy);
    }
  EXPECT_BELOW_BECAUSE(misfit(condensed_stiffness(s), 2 * c), eliminated);
}

TEST(Stiffness, AClusterThatEndsInsideTheCellBearsNothing)
{
  Snapshot s; // three mutually touching grains: strained, they move back as a whole, and are free to turn
  s.grains = make_packing(std::vector<Vec3>(3, Vec3::Zero()), std::vector<double>(3, radius), 2650);
  set_volume(s, 1e-9);
  const Mat3 q = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  const Vec3 b(0.5, std::sqrt(0.75), 0);
  s.contacts = {closed(0, 1, q * Vec3::UnitX(), squeeze), closed(0, 2, q * b, squeeze),
                closed(1, 2, q * (b - Vec3::UnitX()), squeeze)};
  for (bool friction : {true, false})
    {
      if (!friction)
        s.law->friction = 0;
      EXPECT_BELOW_BECAUSE(condensed_stiffness(s).norm(), affine_stiffness(s).norm() * eliminated);
    }
}

TEST(Stiffness, NothingTouchesIsZero)
{
  for (std::size_t n : {0, 3})
    {
      Snapshot s;
      s.grains = make_packing(std::vector<Vec3>(n, Vec3::Zero()), std::vector<double>(n, radius), 2650);
      EXPECT_EQ(condensed_stiffness(s), Mat6::Zero()); // not even a box
      EXPECT_EQ(affine_stiffness(s), Mat6::Zero());
      if (n > 0)
        s.contacts = {closed(0, 1, Vec3::UnitX(), squeeze)};
      EXPECT_EQ(condensed_stiffness(s), Mat6::Zero());
    }
}

TEST(Stiffness, RefusesWallsAndWhatIsNotANumber)
{
  Snapshot s = simple_cubic();
  s.contacts[5].overlap = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(condensed_stiffness(s), RunFailure);
  EXPECT_THROW(affine_stiffness(s), RunFailure);
  s = simple_cubic();
  s.wall_contacts = {{0, 1, squeeze, 1.0}};
  EXPECT_THROW(condensed_stiffness(s), RunFailure);
  EXPECT_THROW(affine_stiffness(s), RunFailure);
}
} // namespace isostat

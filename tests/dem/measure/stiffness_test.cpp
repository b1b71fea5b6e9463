// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/stiffness.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace isostat
{
namespace
{
constexpr double radius = 2e-4, squeeze = 4e-6;                              // u/l = 0.01: alpha cannot hide
constexpr double branch = 2 * radius - squeeze, alpha = 2 * radius / branch; // l, alpha of equal spheres

using Step = std::array<int, 3>;

Contact closed(std::uint32_t i, std::uint32_t j, const Vec3 &normal, double overlap)
{
  Contact c{std::min(i, j), std::max(i, j), overlap, 1.0, {}};
  c.history.normal = i < j ? normal : Vec3(-normal);
  return c;
}

void make_sliding(const Snapshot &s, Contact &c)
{
  c.history.shear_force = s.law.friction * c.normal_force * c.history.normal.unitOrthogonal();
}

void make_rolling(const Snapshot &s, Contact &c)
{
  const double limit = rolling_length(s.law, s.grains.radius(c.first), s.grains.radius(c.second)) * c.normal_force;
  c.history.bending_moment = limit * c.history.normal.unitOrthogonal();
}

void set_volume(Snapshot &s, double volume) { s.box.upper = Vec3::Constant(std::cbrt(volume)); }

/// 3 x 3 x 3 equal spheres at integer combinations of the columns of `cell` (in branch lengths), each touching those
/// one of the `steps` away.
Snapshot lattice(const Mat3 &cell, const std::vector<Step> &steps)
{
  constexpr int edge = 3;
  Snapshot s;
  s.grains = make_packing(std::vector<Vec3>(27, Vec3::Zero()), std::vector<double>(27, radius), 2650);
  set_volume(s, 27 * std::abs(cell.determinant()) * std::pow(branch, 3));
  const auto number = [&](int i, int j, int k) { return i % edge + edge * (j % edge) + edge * edge * (k % edge); };
  for (int i = 0; i < edge; ++i)
    for (int j = 0; j < edge; ++j)
      for (int k = 0; k < edge; ++k)
        for (const Step &d : steps)
          s.contacts.push_back(closed(number(i, j, k), number(i + d[0] + edge, j + d[1] + edge, k + d[2] + edge),
                                      cell * Vec3(d[0], d[1], d[2]), squeeze));
  return s;
}

Snapshot simple_cubic() { return lattice(Mat3::Identity(), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}); }

Snapshot face_centred()
{
  Mat3 cell;
  cell << 0, 1, 1, 1, 0, 1, 1, 1, 0;
  return lattice(cell / std::sqrt(2), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, -1, 0}, {0, 1, -1}, {-1, 0, 1}});
}

Snapshot body_centred()
{
  Mat3 cell;
  cell << -1, 1, 1, 1, -1, 1, 1, 1, -1;
  return lattice(cell / std::sqrt(3), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}});
}

Mat6 cubic(double c11, double c12, double c44)
{
  Mat6 c = Mat6::Zero();
  c.topLeftCorner<3, 3>().setConstant(c12);
  c.diagonal() << c11, c11, c11, c44, c44, c44;
  return c;
}

/// Grains of different sizes at a shaken cubic grid in a periodic cell, some contacts sliding, some rolling. The larger
/// `swell`, the more contacts.
Snapshot disordered(int edge, double swell, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double spacing = 2 * radius;
  std::vector<Vec3> centres;
  std::vector<double> radii;
  for (int i = 0; i < edge * edge * edge; ++i)
    {
      const Vec3 shake(uniform(random), uniform(random), uniform(random));
      centres.push_back(spacing * (Vec3(i % edge, i / edge % edge, i / edge / edge) + 0.15 * shake));
      radii.push_back(radius * swell * (1 + 0.15 * uniform(random)));
    }
  Snapshot s;
  s.grains = make_packing(centres, radii, 2650);
  s.box.upper = Vec3::Constant(edge * spacing);
  for (std::uint32_t i = 0; i < radii.size(); ++i)
    for (std::uint32_t j = i + 1; j < radii.size(); ++j)
      {
        Vec3 l = centres[j] - centres[i];
        l -= edge * spacing * (l / (edge * spacing)).array().round().matrix();
        if (l.norm() < radii[i] + radii[j])
          s.contacts.push_back(closed(i, j, l.normalized(), radii[i] + radii[j] - l.norm()));
      }
  for (std::size_t c = 0; c < s.contacts.size(); ++c)
    {
      if (c % 3 == 0)
        make_sliding(s, s.contacts[c]);
      if (c % 4 == 0)
        make_rolling(s, s.contacts[c]);
    }
  return s;
}

Mat3 strain_tensor(const Eigen::Matrix<double, 6, 1> &e)
{
  Mat3 eps;
  eps << e[0], e[5] / 2, e[4] / 2, e[5] / 2, e[1], e[3] / 2, e[4] / 2, e[3] / 2, e[2];
  return eps;
}

/// (strain in Voigt order) of the strain unit k turned by Q, as columns.
Mat6 turned_strains(const Mat3 &q)
{
  Mat6 m;
  for (int k = 0; k < 6; ++k)
    {
      const Mat3 e = q * strain_tensor(Eigen::Matrix<double, 6, 1>::Unit(k)) * q.transpose();
      m.col(k) << e(0, 0), e(1, 1), e(2, 2), 2 * e(1, 2), 2 * e(0, 2), 2 * e(0, 1);
    }
  return m;
}

/// The definition, dense: every grain with six unknowns, energy = |J q|^2 / 2, and a pseudo-inverse.
Mat6 dense_stiffness(const Snapshot &s, Sliding sliding)
{
  const int n = 6 * s.grains.n_grains();
  Eigen::MatrixXd j(10 * s.contacts.size(), n + 6);
  for (int column = 0; column < n + 6; ++column)
    {
      const Eigen::VectorXd q = Eigen::VectorXd::Unit(n + 6, column);
      const Mat3 eps = strain_tensor(q.tail<6>());
      for (std::size_t k = 0; k < s.contacts.size(); ++k)
        {
          const Contact &c = s.contacts[k];
          const Vec3 &m = c.history.normal;
          const double r1 = s.grains.radius(c.first), r2 = s.grains.radius(c.second), l = r1 + r2 - c.overlap;
          const double a = (r1 + r2) / l;
          // rotations in units of 1/radius, which leaves the pseudo-inverse better conditioned
          const Vec3 w1 = q.segment<3>(6 * c.first + 3) / radius, w2 = q.segment<3>(6 * c.second + 3) / radius;
          const Vec3 v = q.segment<3>(6 * c.second) - q.segment<3>(6 * c.first) + l * eps * m -
                         (r1 / a * w1 + r2 / a * w2).cross(m);
          const ContactStiffness stiff = contact_stiffness(s.law, r1, r2);
          const bool slides = is_sliding(c.history.shear_force.norm(), c.normal_force, s.law);
          const bool rolls =
              is_rolling(c.history.bending_moment.norm(), c.normal_force, rolling_length(s.law, r1, r2), s.law);
          const double ks = sliding == Sliding::released && slides ? 0 : a * stiff.shear;
          const double kr = sliding == Sliding::released && rolls ? 0 : stiff.rolling;
          auto rows = j.col(column).segment<10>(10 * k);
          rows[0] = std::sqrt(stiff.normal) * m.dot(v);
          rows.segment<3>(1) = std::sqrt(ks) * m.cross(v);
          rows.segment<3>(4) = std::sqrt(kr) * m.cross(w2 - w1);
          rows.segment<3>(7) = std::sqrt(stiff.twisting) * m.dot(w2 - w1) * m;
        }
    }
  const Eigen::MatrixXd k = j.transpose() * j;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse;
  inverse.setThreshold(1e-12);
  inverse.compute(k.topLeftCorner(n, n));
  const Eigen::MatrixXd relaxed = inverse.solve(k.topRightCorner(n, 6));
  return (k.bottomRightCorner<6, 6>() - k.bottomLeftCorner(6, n) * relaxed) / s.box.volume();
}

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

const ContactStiffness equal_spheres = contact_stiffness(LawParams{}, radius, radius);
const double kn = equal_spheres.normal, ks = alpha * equal_spheres.shear; // N/m, of one contact
} // namespace

TEST(Stiffness, SimpleCubicLattice)
{
  // one contact per axis and cell; gamma_yz shears those along y and z by l gamma/2 each, and nothing turns
  const Mat6 expected = cubic(kn / branch, 0, ks / (2 * branch));
  EXPECT_LT(misfit(condensed_stiffness(simple_cubic()), expected), 1e-12);
  EXPECT_LT(misfit(affine_stiffness(simple_cubic()), expected), 1e-13);
}

TEST(Stiffness, OneGrainThatTouchesItsOwnImages)
{
  Snapshot s;
  s.grains = make_packing({Vec3::Zero()}, {radius}, 2650);
  set_volume(s, std::pow(branch, 3));
  for (int axis = 0; axis < 3; ++axis)
    s.contacts.push_back({0, 0, squeeze, 1.0, {Vec3::Unit(axis)}});
  EXPECT_LT(misfit(condensed_stiffness(s), condensed_stiffness(simple_cubic())), 1e-12);
  make_sliding(s, s.contacts[2]);
  EXPECT_LT(condensed_stiffness(s, Sliding::released)(3, 3), 1e-12 * kn / branch);
  s.law.features.friction = false; // not one unknown
  EXPECT_LT(misfit(condensed_stiffness(s), cubic(kn / branch, 0, 0)), 1e-12);
}

TEST(Stiffness, FaceCentredLattice)
{
  // six directions per grain: sum nx^4 = 1, sum nx^2 ny^2 = 1/2, sum nx^2 = 2; l^2/V = sqrt(2)/l
  const Mat6 expected = std::sqrt(2) / branch * cubic(kn + ks, (kn - ks) / 2, (kn + ks) / 2);
  EXPECT_LT(misfit(condensed_stiffness(face_centred()), expected), 1e-12);
  EXPECT_LT(misfit(affine_stiffness(face_centred()), expected), 1e-13);
}

TEST(Stiffness, BodyCentredLattice)
{
  // four directions per grain: sum nx^4 = sum nx^2 ny^2 = 4/9, sum nx^2 = 4/3; l^2/V = 3 sqrt(3)/(4 l)
  const double scale = 3 * std::sqrt(3) / (4 * branch) / 9;
  const Mat6 expected = scale * cubic(4 * kn + 8 * ks, 4 * kn - 4 * ks, 4 * kn + 2 * ks);
  EXPECT_LT(misfit(condensed_stiffness(body_centred()), expected), 1e-12);
}

TEST(Stiffness, WithoutFrictionOnlyNormalsResist)
{
  Snapshot s = simple_cubic();
  s.law.features.friction = false;
  EXPECT_LT(misfit(condensed_stiffness(s), cubic(kn / branch, 0, 0)), 1e-12);
  s = face_centred();
  s.law.friction = 0;
  EXPECT_LT(misfit(condensed_stiffness(s), std::sqrt(2) / branch * cubic(kn, kn / 2, kn / 2)), 1e-12);
}

TEST(Stiffness, LatticeWhoseContactsAlongZSlide)
{
  // grains turn by gamma/2 with the rows that still grip, and gamma_yz and gamma_xz cost nothing
  Snapshot s = simple_cubic();
  for (Contact &c : s.contacts)
    if (std::abs(c.history.normal[2]) > 0.5)
      make_sliding(s, c);
  Mat6 expected = cubic(kn / branch, 0, 0);
  expected(5, 5) = ks / (2 * branch);
  EXPECT_LT(misfit(condensed_stiffness(s, Sliding::released), expected), 1e-12);
  EXPECT_LT(misfit(condensed_stiffness(s), condensed_stiffness(simple_cubic())), 1e-15);
  expected(3, 3) = expected(4, 4) = ks / (4 * branch); // no turning: half of the contacts are left
  EXPECT_LT(misfit(affine_stiffness(s, Sliding::released), expected), 1e-13);
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
  EXPECT_LT(misfit(affine_stiffness(s), expected), 1e-13);
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
  contact_force(s.law, pair, 1.0, history); // eps_xy = gamma/2
  const double stress = affine_stiffness(s)(5, 5) * gamma;
  EXPECT_NEAR(stress, -history.shear_force[1] * l / 2 / s.box.volume(), 1e-12 * stress);
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
      compliance += 1 / contact_stiffness(s.law, radii[i], radii[j]).normal;
    }
  s.box.upper = Vec3(1e-3, 2e-3, length);
  Mat6 expected = Mat6::Zero(); // shear: the column turns as a whole
  expected(2, 2) = length * length / compliance / s.box.volume();
  EXPECT_LT(misfit(condensed_stiffness(s), expected), 1e-12);
  EXPECT_GT(affine_stiffness(s)(2, 2), 1.05 * expected(2, 2));
  EXPECT_GT(affine_stiffness(s)(3, 3), 0.01 * expected(2, 2));
}

TEST(Stiffness, EqualsADensePseudoInverse)
{
  const LawFeatures laws[] = {{true, true, true}, {true, true, false}, {true, false, false}, {false, false, false}};
  for (double swell : {1.06, 1.25})
    for (const LawFeatures &law : laws)
      for (Sliding sliding : {Sliding::elastic, Sliding::released})
        {
          Snapshot s = disordered(3, swell, 5);
          s.law.features = law;
          const Mat6 expected = dense_stiffness(s, sliding);
          EXPECT_LT((condensed_stiffness(s, sliding) - expected).norm(), 1e-8 * affine_stiffness(s).norm());
          if (law.rolling)
            {
              EXPECT_LT(misfit(condensed_stiffness(s, sliding), expected), 1e-8);
            }
        }
}

TEST(Stiffness, SymmetricAndBetweenZeroAndTheAffineBound)
{
  for (unsigned seed = 0; seed < 20; ++seed)
    for (Sliding sliding : {Sliding::elastic, Sliding::released})
      {
        const Snapshot s = disordered(4, 1 + 0.015 * seed, seed);
        const Mat6 c = condensed_stiffness(s, sliding), bound = affine_stiffness(s, sliding);
        const double rounding = 1e-12 * bound.norm();
        EXPECT_EQ((c - c.transpose()).norm(), 0);
        EXPECT_GE(min_eigenvalue(c), -rounding);
        EXPECT_GE(min_eigenvalue(bound - c), -rounding);
        EXPECT_GT((bound - c).norm(), 0.01 * bound.norm());
        EXPECT_GE(min_eigenvalue(condensed_stiffness(s) - c), -rounding); // released is never stiffer
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
  for (Sliding sliding : {Sliding::elastic, Sliding::released})
    {
      const Mat6 c = condensed_stiffness(turned, sliding);
      EXPECT_LT(misfit(m.transpose() * c * m, condensed_stiffness(s, sliding)), 1e-10);
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
  const std::uint32_t last = add_grain(s, radius / 2); // a chain of two hanging on grain 4
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
  EXPECT_LT(misfit(condensed_stiffness(s), 2 * c), 1e-12);
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
      s.law.features.friction = friction;
      EXPECT_LT(condensed_stiffness(s).norm(), 1e-12 * affine_stiffness(s).norm());
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

TEST(ColumnStiffness, IsTheAcousticTensorOfTheAxis)
{
  const Mat6 c = condensed_stiffness(disordered(3, 1.2, 3));
  constexpr int voigt[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
  const int order[3][3] = {{0, 1, 2}, {1, 0, 2}, {2, 0, 1}}; // axis, then the lateral ones ascending
  for (int a = 0; a < 3; ++a)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_EQ(column_stiffness(c, a)(i, j), c(voigt[order[a][i]][a], voigt[order[a][j]][a]));
}

TEST(WaveSpeeds, IsotropicSolid)
{
  const double lambda = 30e6, mu = 12e6, density = 1900;
  for (int axis = 0; axis < 3; ++axis)
    {
      const WaveSpeeds c = wave_speeds(cubic(lambda + 2 * mu, lambda, mu), density, axis);
      EXPECT_NEAR(c.p, std::sqrt((lambda + 2 * mu) / density), 1e-10);
      EXPECT_NEAR(c.s1, std::sqrt(mu / density), 1e-10);
      EXPECT_NEAR(c.s2, std::sqrt(mu / density), 1e-10);
    }
}

TEST(WaveSpeeds, CoupledLengthwiseAndCrosswise)
{
  Mat6 c = cubic(50, 10, 20); // along z: zz and xz coupled, (50, 15; 15, 20) has 35 +- 15 sqrt(2); yz alone
  c(2, 4) = c(4, 2) = 15;
  const WaveSpeeds speeds = wave_speeds(c, 2.0, 2);
  EXPECT_NEAR(speeds.p, std::sqrt((35 + 15 * std::sqrt(2)) / 2), 1e-12);
  EXPECT_NEAR(speeds.s1, std::sqrt(20 / 2.0), 1e-12);
  EXPECT_NEAR(speeds.s2, std::sqrt((35 - 15 * std::sqrt(2)) / 2), 1e-12);
}

TEST(WaveSpeeds, RoundingBelowZeroIsNoWave) { EXPECT_EQ(wave_speeds(cubic(1e6, 0, -1e-9), 1900, 0).s2, 0); }
} // namespace isostat

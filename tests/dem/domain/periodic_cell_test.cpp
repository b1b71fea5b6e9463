// SPDX-License-Identifier: BSD-3-Clause
#include "dem/domain/periodic_cell.hpp"
#include "tests/support/near.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace isostat
{
namespace
{
struct RandomFrames : test::Random
{
  using test::Random::Random;
  Mat3 matrix()
  {
    Mat3 m;
    m << vector(), vector(), vector();
    return m;
  }
  Mat3 rotation() { return Eigen::AngleAxisd(M_PI * (*this)(), vector().normalized()).toRotationMatrix(); }
};

/// Deforms as the assembly does: a cell that leans too far is exchanged.
void deform(PeriodicCell &cell, const Mat3 &gradient)
{
  cell.deform(gradient);
  if (const auto upright = cell.upright_edges())
    {
      cell.edges = *upright;
      ++cell.flips;
    }
}

/// How far `edges` are from whole combinations of `lattice`; huge if they span a part of it only.
double misfit_of_lattices(const Mat3 &lattice, const Mat3 &edges)
{
  const Mat3 combination = lattice.inverse() * edges, whole = combination.array().round();
  return std::abs(std::abs(whole.determinant()) - 1) > 0.5 ? 1e9 : (combination - whole).cwiseAbs().maxCoeff();
}

/// Length of the shortest vector of a lattice whose basis is not too skew.
double shortest(const Mat3 &edges)
{
  double minimum = INFINITY;
  for (int a = -3; a <= 3; ++a)
    for (int b = -3; b <= 3; ++b)
      for (int c = -3; c <= 3; ++c)
        if (a || b || c)
          minimum = std::min(minimum, (edges * Vec3(a, b, c)).norm());
  return minimum;
}

double max_lean(const Mat3 &edges)
{
  double lean = 0;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 3; ++j)
      if (j != k)
        lean = std::max(lean, std::abs(edges.col(k).dot(edges.col(j))) / edges.col(j).squaredNorm());
  return lean;
}
} // namespace

TEST(ImageCode, GivesTheShiftBack)
{
  for (const int k : {-511, -1, 0, 1, 511})
    for (const int j : {-511, -1, 0, 1, 511})
      for (const int i : {-511, -1, 0, 1, 511})
        EXPECT_EQ(image_shift(image_code({i, j, k})), Eigen::Vector3i(i, j, k));
  RandomFrames random(1);
  for (int n = 0; n < 10000; ++n)
    {
      const Eigen::Vector3i a = (511 * random.vector()).cast<int>(), b = (511 * random.vector()).cast<int>();
      EXPECT_EQ(image_shift(image_code(a)), a);
      EXPECT_EQ(image_code(a) == image_code(b), a == b);
    }
}

TEST(PeriodicCell, IsARightAngledOneAtFirst)
{
  const PeriodicCell cell = PeriodicCell::with_edges({1, 2, 0.5});
  EXPECT_DOUBLE_EQ(cell.volume(), 1);
  EXPECT_BELOW_BECAUSE((cell.widths() - Vec3(1, 2, 0.5)).norm(), 1e-15, "round-off of an inverse");
  EXPECT_FALSE(cell.upright_edges());
}

TEST(PeriodicCell, VolumeFollowsTheSumOfTheTracesThroughAMillionRandomSteps)
{
  RandomFrames random(2);
  PeriodicCell cell = PeriodicCell::with_edges({1e-3, 2e-3, 1.5e-3});
  const double volume = cell.volume();
  long double sum = 0;
  double worst = 0;
  for (int step = 0; step < 1'000'000; ++step)
    {
      const Mat3 gradient = 1e-3 * random.matrix();
      sum += static_cast<long double>(gradient(0, 0)) + gradient(1, 1) + gradient(2, 2);
      deform(cell, gradient);
      worst = std::max(worst, std::abs(cell.volume() / (volume * std::exp(static_cast<double>(sum))) - 1));
    }
  EXPECT_GT(cell.flips, 1u);
  EXPECT_BELOW_BECAUSE(
      worst, 1e-12, "the volume is set from its logarithm, a sum of 1e6 terms whose round-off is 1e-16 each at random");
}

TEST(PeriodicCell, VolumeStaysThroughCyclesOfConstantVolume)
{
  PeriodicCell cell = PeriodicCell::with_edges({1e-3, 1e-3, 1e-3});
  const double volume = cell.volume();
  double worst = 0;
  for (int step = 0; step < 1'000'000; ++step)
    {
      const double rate = 1e-4 * std::cos(2 * M_PI * step / 2e4); // amplitude 0.32
      Mat3 gradient = Vec3(0.5 * rate, -rate, 0.5 * rate).asDiagonal();
      gradient(0, 2) = 2 * rate;
      deform(cell, gradient);
      worst = std::max(worst, std::abs(cell.volume() / volume - 1));
    }
  EXPECT_BELOW_BECAUSE(
      worst, 1e-12, "the volume is set from its logarithm, a sum of 1e6 terms whose round-off is 1e-16 each at random");
}

TEST(PeriodicCell, SimpleShearGivesItsDeformationAndCarriesTheLatticeAlong)
{
  const int steps = 100'000;
  for (const auto &[row, column] : {std::pair(0, 1), std::pair(2, 0), std::pair(1, 2)})
    {
      Mat3 gradient = Mat3::Zero();
      gradient(row, column) = 1.0 / steps;
      PeriodicCell cell = PeriodicCell::with_edges({1, 1.3, 0.8});
      const Mat3 start = cell.edges;
      double worst = 0, worst_lattice = 0;
      for (int step = 1; step <= steps; ++step)
        {
          deform(cell, gradient);
          if (step % 1000 != 0)
            continue;
          const Mat3 expected = Mat3::Identity() + step * gradient;
          worst = std::max(worst, (cell.rotation * cell.deformation - expected).cwiseAbs().maxCoeff());
          worst_lattice = std::max(worst_lattice, misfit_of_lattices(expected * start, cell.rotation * cell.edges));
        }
      EXPECT_GE(cell.flips, 1u);
      EXPECT_BELOW_BECAUSE(
          worst, 1e-9,
          "second order in steps of 1e-5: errors of 1e-15 in each of 1e5 steps, at most 1e-10, and the lattice alike");
      EXPECT_BELOW_BECAUSE(worst_lattice, 1e-9, "second order in steps of 1e-5, as the deformation");
    }
}

TEST(PeriodicCell, ErrorsOfShearAreOfSecondOrderInTheStep)
{
  double error[2] = {};
  for (const int k : {0, 1})
    {
      const int steps = k ? 2000 : 1000;
      Mat3 gradient = Mat3::Zero();
      gradient(0, 1) = 1.0 / steps;
      PeriodicCell cell;
      for (int step = 0; step < steps; ++step)
        cell.deform(gradient);
      error[k] = (cell.rotation * cell.deformation - Mat3::Identity() - steps * gradient).norm();
    }
  EXPECT_NEAR_BECAUSE(error[0] / error[1], 4, 0.1, "the next order in the step, 1e-3, and the scatter of round-off");
}

TEST(PeriodicCell, ARigidRotationChangesNoBitOfEdgesAndDeformation)
{
  RandomFrames random(3);
  for (int run = 0; run < 6; ++run)
    {
      PeriodicCell cell = PeriodicCell::with_edges({1e-3, 1.1e-3, 0.7e-3});
      if (run > 1)
        for (int step = 0; step < 1000; ++step)
          deform(cell, 1e-3 * random.matrix());
      const PeriodicCell before = cell;
      const Vec3 axis = run == 0 ? Vec3::UnitZ() : random.vector().normalized();
      const int steps = 100'000;
      const double angle = 1.5 * M_PI;
      Mat3 spin;
      spin << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
      double growth = 0;
      for (int step = 0; step < steps; ++step)
        growth = std::max(growth, cell.deform(angle / steps * spin).norm());
      const Mat3 expected = Eigen::AngleAxisd(angle, axis).toRotationMatrix() * before.rotation;
      EXPECT_EQ(cell.edges, before.edges) << "run " << run;
      EXPECT_EQ(cell.deformation, before.deformation) << "run " << run;
      EXPECT_EQ(growth, 0) << "run " << run;
      EXPECT_EQ(cell.volume_strain, before.volume_strain);
      EXPECT_BELOW_BECAUSE((cell.rotation - expected).norm(), 1e-12,
                           "round-off of 1e5 products of rotations, 1e-16 each at random, that are made orthogonal")
          << "run " << run;
    }
}

constexpr test::Tolerance drift{1e-11, "round-off of 20,000 steps, which the shear of the cell carries on"};

TEST(PeriodicCell, TheFrameDoesNotMatterToStretch)
{
  // the same motion seen in a laboratory that is turned by q: edges of its own frame are the same
  RandomFrames random(4);
  const Mat3 q = random.rotation();
  PeriodicCell cell = PeriodicCell::with_edges({1, 1.2, 0.9}), turned = cell;
  turned.rotation = q;
  for (int step = 0; step < 20'000; ++step)
    {
      const Mat3 gradient = 1e-3 * random.matrix();
      deform(cell, gradient);
      deform(turned, q * gradient * q.transpose());
    }
  EXPECT_BELOW_BECAUSE((cell.edges - turned.edges).norm(), drift);
  EXPECT_BELOW_BECAUSE((q * cell.rotation - turned.rotation).norm(), drift);
  EXPECT_BELOW_BECAUSE((turned.rotation.transpose() * turned.rotation - Mat3::Identity()).norm(), 1e-14,
                       "round-off of one orthogonalisation");
}

TEST(UprightEdges, SpanTheSameLatticeAndLeanLess)
{
  const char *threshold = "round-off of the quotient that the threshold is compared with";
  RandomFrames random(5);
  int changed = 0;
  for (int run = 0; run < 10'000; ++run)
    {
      PeriodicCell cell;
      cell.edges = Mat3::Identity() + 2 * random.matrix();
      if (std::abs(cell.volume()) < 1e-2)
        continue;
      const auto upright = cell.upright_edges();
      if (!upright)
        {
          EXPECT_BELOW_BECAUSE(max_lean(cell.edges), 0.6 * (1 + 1e-12), threshold);
          continue;
        }
      ++changed;
      EXPECT_NEAR_BECAUSE(upright->determinant() / cell.volume(), 1, 1e-11,
                          "round-off of a determinant that may be 1e-2 of its terms, of combinations of edges");
      EXPECT_BELOW_BECAUSE(misfit_of_lattices(cell.edges, *upright), 1e-9,
                           "round-off of an inverse whose condition is up to 1e4");
      EXPECT_BELOW_BECAUSE(max_lean(*upright), 0.6 * (1 + 1e-12), threshold);
      PeriodicCell again;
      again.edges = *upright;
      EXPECT_FALSE(again.upright_edges()) << "what is upright stays";
    }
  EXPECT_GT(changed, 1000);
}

TEST(UprightEdges, KeepTheCellWideThroughShearOfTenIn3D)
{
  // edges that lean by at most 0.6 of each other: a cube sheared along its edges keeps 1/sqrt(1 + 0.6^2) of its width;
  // in any direction, a cell stays at least 0.6 times as wide as the shortest vector of its lattice
  RandomFrames random(6);
  double min_of_cube = 1, min_of_shortest = INFINITY;
  for (int run = 0; run < 12; ++run)
    {
      PeriodicCell cell = PeriodicCell::with_edges(Vec3::Ones());
      const Mat3 q = run < 2 ? Mat3::Identity().eval() : random.rotation();
      if (run >= 8)
        cell = PeriodicCell::with_edges({1, 3, 0.7});
      Mat3 gradient = Mat3::Zero();
      gradient(run % 2, 1 - run % 2) = 1e-3;
      for (int step = 0; step < 10'000; ++step)
        {
          deform(cell, q * gradient * q.transpose());
          const double width = cell.widths().minCoeff();
          if (run < 2)
            min_of_cube = std::min(min_of_cube, width);
          if (step % 10 == 0)
            min_of_shortest = std::min(min_of_shortest, width / shortest(cell.edges));
        }
      EXPECT_GE(cell.flips, 5u);
    }
  EXPECT_GE(min_of_cube, 1 / std::sqrt(1.36) - 1e-2);
  EXPECT_GE(min_of_shortest, 0.6);
}

TEST(UprightEdges, SmallCyclesAboutTheThresholdFlipOnceOnly)
{
  RandomFrames random(7);
  for (int run = 0; run < 20; ++run)
    {
      PeriodicCell cell = PeriodicCell::with_edges(Vec3::Ones() + 0.3 * random.vector());
      const Mat3 q = run == 0 ? Mat3::Identity().eval() : random.rotation();
      Mat3 gradient = Mat3::Zero();
      gradient(0, 1) = 1e-3;
      gradient = (q * gradient * q.transpose()).eval();
      while (cell.flips == 0)
        deform(cell, gradient);
      for (int cycle = 0; cycle < 20; ++cycle)
        for (int step = 0; step < 80; ++step)
          deform(cell, step < 20 || step >= 60 ? gradient : -gradient); // +-0.02
      EXPECT_LE(cell.flips, 2u) << "run " << run; // a second pair of edges may be about its threshold, too
      EXPECT_TRUE(run > 0 || cell.flips == 1);
    }
}
} // namespace isostat

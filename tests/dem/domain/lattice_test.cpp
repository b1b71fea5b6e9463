// SPDX-License-Identifier: BSD-3-Clause
// The most compact periods of lattices: whole numbers, shortest by enumeration, widths, cells that lean by anything.
#include "dem/domain/lattice.hpp"

#include "dem/domain/periodic_cell.hpp"
#include "tests/support/near.hpp"
#include "tests/support/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace isostat
{
namespace
{
using test::Random;

Vec3 widths(const Mat3 &edges)
{
  PeriodicCell cell;
  cell.edges = edges;
  return cell.widths();
}

Mat3 random_matrix(Random &random)
{
  Mat3 m;
  m << random.vector(), random.vector(), random.vector();
  return m;
}

Mat3 random_rotation(Random &random)
{
  return Eigen::AngleAxisd(M_PI * random(), random.vector().normalized()).toRotationMatrix();
}

/// A product of shears by whole numbers up to `lean`.
Mat3 random_periods(Random &random, int shears, double lean)
{
  Mat3 u = Mat3::Identity();
  for (int k = 0; k < shears; ++k)
    {
      const int to = k % 3, from = (to + 1 + (random() > 0)) % 3;
      u.col(to) += std::round(lean * random()) * u.col(from).eval();
    }
  return u;
}

/// The shortest period by looking at all that may be as short as `bound`: a period s has |H s| >= |s_k| width_k.
double shortest_by_enumeration(const Mat3 &edges, double bound)
{
  const Eigen::Vector3i range = (bound / widths(edges).array() * (1 + 1e-9)).floor().cast<int>();
  double minimum = bound;
  for (int a = -range[0]; a <= range[0]; ++a)
    for (int b = -range[1]; b <= range[1]; ++b)
      for (int c = -range[2]; c <= range[2]; ++c)
        if (a || b || c)
          minimum = std::min(minimum, (edges * Vec3(a, b, c)).norm());
  return minimum;
}

/// How much shorter a period gets, at most, by whole combinations of those before it; 0 where they are reduced.
double can_be_shortened_by(const Mat3 &p)
{
  double gain = 0;
  for (int x = -4; x <= 4; ++x)
    {
      gain = std::max(gain, 1 - (p.col(1) + x * p.col(0)).norm() / p.col(1).norm());
      for (int y = -4; y <= 4; ++y)
        gain = std::max(gain, 1 - (p.col(2) + x * p.col(0) + y * p.col(1)).norm() / p.col(2).norm());
    }
  return gain;
}

constexpr double round_off = 1e-11;
const char *tie = "periods that differ by less than 1e-12 count as equally long";
} // namespace

TEST(CompactPeriods, AreTheShortestOfRandomLattices)
{
  Random random(1);
  int lattices = 0;
  double narrowest = 1, leaning = 1;
  while (lattices < 2000)
    {
      const Mat3 compact = Mat3::Identity() + random_matrix(random);
      if (std::abs(compact.determinant()) < 0.02)
        continue;
      const Mat3 edges = compact * random_periods(random, 3, 2);
      const Eigen::Matrix3i u = compact_periods(edges);
      ASSERT_EQ(std::lround(u.cast<double>().determinant()), 1);
      const Mat3 p = edges * u.cast<double>();
      const double a = p.col(0).norm();
      EXPECT_EQ(shortest_period(edges), p.colwise().norm().minCoeff());
      EXPECT_BELOW_BECAUSE(a, p.col(1).norm() * (1 + round_off), tie);
      EXPECT_BELOW_BECAUSE(p.col(1).norm(), p.col(2).norm() * (1 + round_off), tie);
      EXPECT_BELOW_BECAUSE(can_be_shortened_by(p), round_off, tie);
      ASSERT_NEAR_BECAUSE(shortest_by_enumeration(edges, a) / a, 1, round_off, tie);
      narrowest = std::min(narrowest, widths(p).minCoeff() / a);
      leaning = std::min(leaning, widths(edges).minCoeff() / a);
      ++lattices;
    }
  EXPECT_GE(narrowest, std::sqrt(0.5));
  EXPECT_BELOW_BECAUSE(leaning, 0.3, "cells that lean by twice their edges: else nothing was to be found");
}

TEST(CompactPeriods, OfKnownLattices)
{
  Random random(2);
  Mat3 fcc, bcc, hexagonal;
  fcc << 0, 1, 1, 1, 0, 1, 1, 1, 0;
  bcc << -1, 1, 1, 1, -1, 1, 1, 1, -1;
  hexagonal << 1, -0.5, 0, 0, std::sqrt(0.75), 0, 0, 0, 1.2;
  const struct
  {
    Mat3 edges;
    double shortest;
  } known[] = {{Mat3::Identity(), 1},
               {Vec3(3, 0.7, 2).asDiagonal(), 0.7},
               {fcc, std::sqrt(2)},
               {bcc, std::sqrt(3)},
               {hexagonal, 1}};
  for (const auto &lattice : known)
    for (int run = 0; run < 200; ++run)
      {
        const Mat3 turned = random_rotation(random) * lattice.edges * random_periods(random, run % 12, 3);
        EXPECT_NEAR_BECAUSE(shortest_period(turned), lattice.shortest, 1e-9,
                            "round-off of edges that are up to 1e5 times as long");
      }
}

TEST(CompactPeriods, LeaveACompactCellAlone)
{
  EXPECT_EQ(compact_periods(Mat3::Identity()), Eigen::Matrix3i::Identity());
  EXPECT_EQ(compact_periods(Vec3(1, 2, 3).asDiagonal()), Eigen::Matrix3i::Identity());
  Random random(3);
  for (int run = 0; run < 1000; ++run)
    {
      const Mat3 p = compact_edges(Mat3::Identity() + 0.9 * random_matrix(random));
      EXPECT_EQ(compact_periods(p), Eigen::Matrix3i::Identity());
    }
}

TEST(CompactPeriods, OfALargerCellAreTheSame)
{
  Random random(4);
  for (int run = 0; run < 1000; ++run)
    {
      const Mat3 edges = random_matrix(random);
      EXPECT_EQ(compact_periods(edges), compact_periods(std::ldexp(1, 20) * edges));
      EXPECT_EQ(compact_periods(edges), compact_periods(std::ldexp(1, -30) * edges));
    }
}

TEST(CompactPeriods, OfCellsThatLeanByThousands)
{
  for (const double lean : {1e3, 1e4, 3.14159e4})
    {
      Mat3 edges = Mat3::Identity();
      edges.col(1) += lean * edges.col(0);
      edges.col(2) += 0.3 * edges.col(0) - std::round(lean / 7) * edges.col(1);
      const Mat3 p = compact_edges(edges);
      EXPECT_NEAR_BECAUSE(p.determinant(), 1, 1e-3, "round-off of edges that are up to 1e8 long");
      EXPECT_BELOW_BECAUSE(p.col(2).norm(), 2, "one of the shortest three, whatever else there is");
    }
}

TEST(CompactPeriods, OfWhatIsNoCellAreTheEdgesThemselves)
{
  Mat3 flat = Mat3::Identity(), no_number = flat, far = flat;
  flat.col(2) = flat.col(0) + flat.col(1);
  no_number(1, 2) = std::numeric_limits<double>::quiet_NaN();
  far(0, 1) = 1e12;
  for (const Mat3 &edges : {flat, Mat3(Mat3::Zero()), no_number, far})
    EXPECT_EQ(compact_periods(edges), Eigen::Matrix3i::Identity());
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/domain/lattice.hpp"

#include <array>
#include <cmath>

namespace isostat
{
namespace
{
constexpr double shorter = 1 - 1e-12; ///< of squares; what differs by less is round-off
constexpr double max_whole = 1e9;     ///< fits an int

/// A period of the lattice: its vector, and the whole numbers of the given edges in it.
struct Period
{
  Vec3 vector, whole;
  double squared() const { return vector.squaredNorm(); }
};
using Periods = std::array<Period, 3>;

/// p less x times q.
Period less(const Mat3 &edges, const Period &p, double x, const Period &q)
{
  const Vec3 whole = p.whole - x * q.whole;
  return {edges * whole, whole}; // not from vectors: round-off would add up
}

void sort(Periods &p)
{
  const auto order = [&](int i, int j) {
    if (p[j].squared() < shorter * p[i].squared())
      std::swap(p[i], p[j]);
  };
  order(0, 1), order(1, 2), order(0, 1);
}

/// Lagrange and Gauss: a and b become the two shortest periods of their plane.
void reduce_pair(const Mat3 &edges, Period &a, Period &b)
{
  while (true) // ends: the pair gets shorter in each round
    {
      if (b.squared() < shorter * a.squared())
        std::swap(a, b);
      const Period next = less(edges, b, std::round(a.vector.dot(b.vector) / a.squared()), a);
      if (!(next.squared() < shorter * b.squared()))
        return;
      b = next;
    }
}

/// The shortest of c less whole combinations of a and b, a reduced pair.
Period nearest(const Mat3 &edges, const Period &a, const Period &b, const Period &c)
{
  const double aa = a.squared(), bb = b.squared(), ab = a.vector.dot(b.vector), ac = a.vector.dot(c.vector),
               bc = b.vector.dot(c.vector), area2 = aa * bb - ab * ab;
  const double x = std::round((bb * ac - ab * bc) / area2), y = std::round((aa * bc - ab * ac) / area2);
  Period best = c;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      if (const Period other = less(edges, less(edges, c, x + i, a), y + j, b);
          other.squared() < shorter * best.squared())
        best = other;
  return best;
}
} // namespace

Eigen::Matrix3i compact_periods(const Mat3 &edges)
{
  Eigen::Matrix3i as_given = Eigen::Matrix3i::Identity();
  if (!edges.allFinite() || edges.determinant() == 0)
    return as_given;
  Periods p;
  for (int k = 0; k < 3; ++k)
    p[k] = {edges.col(k), Vec3::Unit(k)};
  for (bool again = true; again;) // ends: the third period gets shorter in each round
    {
      sort(p);
      reduce_pair(edges, p[0], p[1]);
      sort(p); // the third may have become the second
      const Period next = nearest(edges, p[0], p[1], p[2]);
      again = next.squared() < shorter * p[2].squared();
      p[2] = next;
    }
  Mat3 whole;
  whole << p[0].whole, p[1].whole, p[2].whole;
  if (!(whole.cwiseAbs().maxCoeff() < max_whole)) // leans by a billion: no cell of grains
    return as_given;
  if (whole.determinant() < 0)
    whole = -whole;
  return whole.cast<int>();
}
} // namespace isostat

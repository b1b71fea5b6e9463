// SPDX-License-Identifier: BSD-3-Clause
// A packing has many sets of periods. None of what it does depends on the one that its cell is described by, and a
// small cell is sheared on and on as long as its packing repeats itself only beyond two grains.
#include "dem/domain/lattice.hpp"
#include "dem/drive/programme.hpp"
#include "dem/measure/energy.hpp"
#include "dem/measure/redundancy.hpp"
#include "dem/measure/stiffness.hpp"
#include "tests/support/cells.hpp"
#include "tests/support/near.hpp"
#include "tests/support/random.hpp"

namespace isostat
{
namespace
{
using namespace test;
constexpr double dt = 2.5e-8;

/// A product of shears by whole numbers, determinant 1.
Mat3 random_periods(Random &random, int shears)
{
  Mat3 u = Mat3::Identity();
  for (int k = 0; k < shears; ++k)
    {
      const int to = k % 3, from = (to + 1 + (random() > 0)) % 3;
      u.col(to) += std::round(2.4 * random()) * u.col(from).eval();
    }
  return u;
}

Snapshot in_periods(Snapshot s, const Mat3 &u)
{
  s.cell->edges = (s.cell->edges * u).eval();
  return s;
}

/// Overlaps are 1e-4 of a diameter, and an image is elsewhere in its last digit.
constexpr Tolerance last_digit{1e-9, "round-off of coordinates, 1e-16, over overlaps of 1e-4, times the edges' length"};

double stress_apart(const Assembly &a, const Assembly &b)
{
  return (a.stress() - b.stress()).norm() / a.stress().norm();
}

void expect_same_histories(const std::vector<Contact> &a, const std::vector<Contact> &b)
{
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t c = 0; c < a.size(); ++c)
    {
      ASSERT_EQ(std::pair(a[c].first, a[c].second), std::pair(b[c].first, b[c].second));
      for (const HistoryVector &v : history_vectors)
        ASSERT_EQ(a[c].history.*v.place, b[c].history.*v.place);
    }
}

/// Few grains: 70, whose cell is a little more than two of the largest wide.
const Snapshot &small() { return periodic_specimen(70, 10); }

double periods_over_diameter(const Assembly &a)
{
  return shortest_period(a.cell()->edges) / (2 * a.packing().max_radius());
}

double width_over_diameter(const Assembly &a) { return a.cell()->widths().minCoeff() / (2 * a.packing().max_radius()); }
} // namespace

TEST(Periods, OfAnyChoiceGiveTheSameForcesAndMeasures)
{
  const Snapshot start = before_flip(5e-5); // sheared: contacts have a past
  Random random(1);
  for (int run = 0; run < 6; ++run)
    {
      const Mat3 u = random_periods(random, run + 2);
      Assembly a(start), b(in_periods(start, u));
      a.settings.time_step = b.settings.time_step = dt;
      expect_same_histories(a.checkpoint().contacts, b.checkpoint().contacts);
      a.compute_forces(), b.compute_forces();
      const Snapshot one = a.snapshot(), two = b.snapshot();
      const ForceMisfit misfit = misfit_of_forces(one, two);
      const Mat6 c = condensed_stiffness(one);
      const double stiffness = (condensed_stiffness(two) - c).norm() / c.norm();
      EXPECT_GT(misfit.contacts, 500u);
      EXPECT_BELOW_BECAUSE(misfit.force, last_digit);
      EXPECT_BELOW_BECAUSE(misfit.moment, last_digit);
      EXPECT_BELOW_BECAUSE(stress_apart(a, b), last_digit);
      EXPECT_BELOW_BECAUSE(stiffness, last_digit);
      EXPECT_CLOSE_BECAUSE(stored_energy(two).elastic(), stored_energy(one).elastic(), last_digit.value,
                           last_digit.reason);
      EXPECT_EQ(contact_network(two).redundancy_index(), contact_network(one).redundancy_index());
      EXPECT_CLOSE_BECAUSE(two.volume(), one.volume(), 1e-12,
                           "round-off of a determinant of edges up to 100 times as "
                           "long");
    }
}

TEST(Periods, OfAnyChoiceGiveTheSameMotion)
{
  // the first step exchanges the cell for an upright one
  const Snapshot start = before_flip(5e-5);
  Random random(2);
  for (int run = 0; run < 3; ++run)
    {
      Assembly a(start), b(in_periods(start, random_periods(random, 4)));
      for (Assembly *each : {&a, &b})
        {
          each->settings.time_step = dt;
          strain(*each, simple_shear(5e-5), 300); // through the flip of the upright one
        }
      EXPECT_EQ(a.cell()->flips, 1u);
      EXPECT_GE(b.cell()->flips, 1u);
      const ForceMisfit misfit = misfit_of_forces(a.snapshot(), b.snapshot());
      EXPECT_BELOW_BECAUSE(misfit.force, 1e-6, "round-off of coordinates over overlaps, grown in 300 steps of sliding");
      EXPECT_BELOW_BECAUSE(stress_apart(a, b), 1e-6, "that of forces");
    }
}

TEST(NarrowCell, GoesTheSameWayAsOneThatIsTwiceAsLong)
{
  // one period leans until the cell is narrower than two grains; two periods in one cell never are
  Assembly first(small());
  while (width_over_diameter(first) > 1.995)
    {
      review_time_step(first);
      strain(first, simple_shear(2e-5), 100);
    }
  ASSERT_EQ(first.cell()->flips, 0u);
  Assembly one(row_of_periods(first.snapshot(), 1)), two(row_of_periods(first.snapshot(), 2));
  for (Assembly *each : {&one, &two})
    {
      each->settings.time_step = first.settings.time_step;
      strain(*each, simple_shear(2e-5), 100);
    }
  double apart = 0;
  const Mat3 to_fraction = one.cell()->edges.inverse();
  for (std::size_t i = 0; i < 70; ++i)
    for (std::size_t period : {std::size_t{0}, std::size_t{70}})
      {
        const Vec3 between = to_fraction * (two.packing().centre(i + period) - one.packing().centre(i));
        apart = std::max(apart, (between - Vec3(between.array().round())).norm());
      }
  EXPECT_LT(width_over_diameter(one), 2);
  EXPECT_GT(periods_over_diameter(one), 2);
  EXPECT_GT(width_over_diameter(two), 2);
  EXPECT_BELOW_BECAUSE(apart, 1e-9, "round-off, 1e-16, grown in 100 steps of sliding and colliding grains");
  EXPECT_BELOW_BECAUSE(stress_apart(one, two), 1e-6, "overlaps are 1e-4 of an edge");
}
} // namespace isostat

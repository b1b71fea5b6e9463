// SPDX-License-Identifier: BSD-3-Clause
// The search on functions whose smallest value is known.
#include "apps/calibrate/search.hpp"

#include "tests/support/near.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>

namespace isostat
{
namespace
{
using Points = std::vector<std::vector<double>>;

/// A long valley between (0, 0.3) and (1, 0.7), lowest at (0.6, 0.54).
double valley(const std::vector<double> &x)
{
  return std::pow(x[0] - 0.6, 2) + 25 * std::pow(x[1] - 0.3 - 0.4 * x[0], 2);
}

Points asked(SearchMethod method, double tolerance)
{
  SearchSettings settings;
  settings.method = method;
  settings.tolerance = tolerance;
  Points points;
  search(settings, {0.2, 0.8}, [&](const std::vector<double> &x) {
    if (points.size() == 3000)
      throw BudgetUsed{"3000"};
    points.push_back(x);
    return valley(x);
  });
  return points;
}

std::vector<double> best_of(const Points &points)
{
  return *std::min_element(points.begin(), points.end(),
                           [](const auto &a, const auto &b) { return valley(a) < valley(b); });
}

TEST(CalibrationSearch, FindsTheLowestPointOfAValley)
{
  for (const SearchMethod method : {SearchMethod::bobyqa, SearchMethod::sbplx, SearchMethod::crs2})
    {
      const Points points = asked(method, 1e-3);
      const std::vector<double> best = best_of(points);
      EXPECT_NEAR_BECAUSE(best[0], 0.6, 5e-3, "some of the last steps of 1e-3, along the valley");
      EXPECT_NEAR_BECAUSE(best[1], 0.54, 5e-3, "some of the last steps of 1e-3, along the valley");
      for (const std::vector<double> &x : points)
        EXPECT_TRUE(x[0] >= 0 && x[0] <= 1 && x[1] >= 0 && x[1] <= 1);
    }
  const std::size_t n_bobyqa = asked(SearchMethod::bobyqa, 1e-3).size();
  EXPECT_LT(n_bobyqa, 60u); // it builds a parabola, and finds one soon
}

TEST(CalibrationSearch, AsksTheSamePointsAgain)
{
  for (const SearchMethod method : {SearchMethod::bobyqa, SearchMethod::sbplx, SearchMethod::crs2})
    EXPECT_EQ(asked(method, 1e-2), asked(method, 1e-2));
}

TEST(CalibrationSearch, EndsWithItsBudgetAndPassesOnWhatIsThrown)
{
  int n = 0;
  const auto until = [&](const std::vector<double> &) -> double {
    if (++n > 4)
      throw BudgetUsed{"four"};
    return n;
  };
  EXPECT_EQ(search({}, {0.5, 0.5}, until), "four");
  EXPECT_EQ(n, 5);
  const auto failing = [](const std::vector<double> &) -> double { throw std::out_of_range("nothing is left"); };
  EXPECT_THROW(search({}, {0.5, 0.5}, failing), std::out_of_range);
}

TEST(CalibrationSearch, DesignFillsTheBounds)
{
  const Points points = sobol_design(2, 16);
  ASSERT_EQ(points.size(), 16u);
  int quadrants[4] = {};
  for (const std::vector<double> &x : points)
    {
      EXPECT_TRUE(x[0] > 0 && x[0] < 1 && x[1] > 0 && x[1] < 1);
      ++quadrants[(x[0] < 0.5 ? 0 : 1) + (x[1] < 0.5 ? 0 : 2)];
    }
  for (const int n : quadrants)
    EXPECT_GE(n, 3);
}
} // namespace
} // namespace isostat

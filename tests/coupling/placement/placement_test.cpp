// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/placement/placement.hpp"

#include "tests/support/near.hpp"

#include <algorithm>
#include <numeric>

namespace isostat
{
namespace
{
using testing::ElementsAre;

/// Costs without a pattern, in [1, 10).
std::vector<double> costs_of(std::size_t n, unsigned seed)
{
  std::vector<double> costs(n);
  std::uint64_t x = seed + 1;
  for (double &c : costs)
    {
      x = x * 6364136223846793005ull + 1442695040888963407ull;
      c = 1 + 9 * static_cast<double>(x >> 40) / static_cast<double>(1 << 24);
    }
  return costs;
}

double max_load(const std::vector<double> &costs, const Owners &owners, int n_ranks)
{
  return imbalance(costs, owners, n_ranks) * std::accumulate(costs.begin(), costs.end(), 0.0) / n_ranks;
}

/// The minimax load of all placements, by trying them.
double best_load(const std::vector<double> &costs, int n_ranks)
{
  Owners owners(costs.size(), 0);
  double best = max_load(costs, owners, n_ranks);
  for (;;)
    {
      std::size_t k = 0;
      while (k < owners.size() && ++owners[k] == n_ranks)
        owners[k++] = 0;
      if (k == owners.size())
        return best;
      best = std::min(best, max_load(costs, owners, n_ranks));
    }
}
} // namespace

TEST(Placement, KnownCasesAreOptimal)
{
  EXPECT_THAT(longest_first(std::vector{7.0, 5.0, 4.0, 3.0, 1.0}, 2), ElementsAre(0, 1, 1, 0, 1));
  EXPECT_THAT(longest_first(std::vector{1.0, 1.0, 1.0, 1.0}, 2), ElementsAre(0, 1, 0, 1));
  EXPECT_THAT(longest_first(std::vector{1.0, 9.0, 1.0, 1.0}, 2), ElementsAre(1, 0, 1, 1));
  EXPECT_THAT(longest_first(std::vector{3.0, 2.0}, 4), ElementsAre(0, 1));
  EXPECT_TRUE(longest_first({}, 3).empty());
}

TEST(Placement, TwentyEqualElementsAreSharedEvenly)
{
  const std::vector<double> costs(20, 2.5);
  for (int ranks : {1, 2, 4, 5, 10, 20})
    EXPECT_EQ(imbalance(costs, longest_first(costs, ranks), ranks), 1.0) << ranks;
  EXPECT_DOUBLE_EQ(imbalance(costs, longest_first(costs, 3), 3), 21.0 / 20);
}

TEST(Placement, KeepsGrahamsBound)
{
  for (unsigned seed = 0; seed < 20; ++seed)
    for (int ranks : {2, 3})
      {
        const std::vector<double> costs = costs_of(8, seed);
        const double ratio = max_load(costs, longest_first(costs, ranks), ranks) / best_load(costs, ranks);
        EXPECT_BELOW_BECAUSE(ratio, 4.0 / 3 - 1.0 / (3 * ranks) + 1e-12, "round-off of sums of 8 costs");
      }
}

TEST(Placement, ImbalanceCountsTheLargestLoad)
{
  EXPECT_EQ(imbalance(std::vector{1.0, 1.0, 2.0}, {0, 0, 1}, 2), 1.0);
  EXPECT_EQ(imbalance(std::vector{1.0, 1.0, 2.0}, {0, 0, 0}, 2), 2.0);
  EXPECT_EQ(imbalance(std::vector{0.0, 0.0}, {0, 0}, 2), 1.0);
}

TEST(Placement, RenamingKeepsElementsWhereTheyAre)
{
  const Owners present = {0, 0, 1, 1, 2, 2};
  EXPECT_EQ(renamed_to_stay({2, 2, 0, 0, 1, 1}, present, 3), present);
  EXPECT_THAT(renamed_to_stay({1, 1, 1, 0, 2, 2}, present, 3), ElementsAre(0, 0, 0, 1, 2, 2));
  EXPECT_THAT(renamed_to_stay({1, 1, 1, 1, 1, 1}, present, 3), ElementsAre(0, 0, 0, 0, 0, 0));
}

TEST(Placement, MovesOnlyAboveTheThresholdAndForAGain)
{
  const std::vector<double> costs = {4, 1, 1, 1, 1};
  const Owners balanced = {0, 1, 1, 1, 1}, lopsided = {0, 0, 0, 1, 1};
  EXPECT_EQ(rebalanced(costs, balanced, 2, {}), balanced);
  EXPECT_THAT(rebalanced(costs, lopsided, 2, {}), ElementsAre(1, 0, 0, 0, 0));
  EXPECT_EQ(rebalanced(costs, lopsided, 2, {1.6, 0.05}), lopsided);
  EXPECT_EQ(rebalanced(costs, lopsided, 2, {1.1, 0.5}), lopsided);
  const std::vector<double> giant = {100, 1}; // unbalanced, but nothing helps
  EXPECT_EQ(rebalanced(giant, {1, 0}, 2, {}), (Owners{1, 0}));
}

TEST(Placement, ThreadsTakeTheCostliestFirst)
{
  EXPECT_THAT(by_falling_cost(std::vector{1.0, 3.0, 2.0, 3.0, 9.0}, {0, 0, 0, 0, 1}, 0), ElementsAre(1, 3, 2, 0));
}

TEST(CostMeter, IsARunningMeanThatBeginsWithTheFirstTrial)
{
  CostMeter meter(2);
  EXPECT_THAT(meter.means(), testing::ElementsAre(1, 1));
  meter.add_trial(std::vector{4.0, 2.0});
  EXPECT_THAT(meter.means(), testing::ElementsAre(4, 2));
  meter.add_trial(std::vector{4.0, 12.0});
  EXPECT_THAT(meter.means(), testing::ElementsAre(4, 3));
  for (int k = 0; k < 50; ++k)
    meter.add_trial(std::vector{1.0, 1.0});
  EXPECT_NEAR_BECAUSE(meter.means()[0], 1, 0.02, "3 * 0.9^50 = 0.015 of the start are left");
}
} // namespace isostat

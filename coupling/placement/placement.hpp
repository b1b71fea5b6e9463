// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isostat
{
/// Which rank computes what. Costs are numbers of any unit, one per element, >= 0 and finite; a rank's load is the sum
/// of its elements' costs. Everything here is a function of its arguments alone, so that ranks that know the same costs
/// come to the same placement without a message.
/// tested: tests/coupling/placement/placement_test.cpp
using Owners = std::vector<int>; ///< rank of each element

/// Longest processing time first (Graham 1969, SIAM J. Appl. Math. 17, doi:10.1137/0117039): elements in order of
/// falling cost, the lower number first where costs are equal, each to the rank with the smallest load so far, the
/// lower one where loads are equal. The largest load is at most 4/3 - 1/(3 n_ranks) of the best possible one.
/// @param n_ranks  > 0     cost O(n log n + n log n_ranks)
Owners longest_first(std::span<const double> costs, int n_ranks);

/// Load of each rank.
std::vector<double> loads_of(std::span<const double> costs, const Owners &owners, int n_ranks);

/// Largest load over mean load [-]: 1 is balanced, n_ranks is one rank alone. 1 if there is no cost at all.
double imbalance(std::span<const double> costs, const Owners &owners, int n_ranks);

/// The same parts with their ranks renamed, so that few elements leave the rank where they are: parts and ranks that
/// share most elements come together first, the lower numbers where they share equally many (greedy: not always the
/// fewest moves).
Owners renamed_to_stay(const Owners &parts, const Owners &present, int n_ranks);

/// When elements may move.
struct BalanceRule
{
  double threshold = 1.1;       ///< imbalance above which elements are placed again [-]
  double min_gain = 0.05;       ///< ... if the largest load falls by at least this part [-]
  std::uint64_t interval = 100; ///< commits between two checks
  void check() const;           ///< @throws InputError

  bool operator==(const BalanceRule &) const = default;
};

/// Where elements should be from now on: `present` unless the imbalance is above the threshold and longest_first lowers
/// it enough.
Owners rebalanced(std::span<const double> costs, const Owners &present, int n_ranks, const BalanceRule &rule);

/// Elements of one rank by falling cost: the order in which its threads take them.
std::vector<std::size_t> by_falling_cost(std::span<const double> costs, const Owners &owners, int rank);

/// Running mean of what each element costs in a trial: the first trial counts whole, then each with a weight of 0.1,
///     mean <- 0.9 mean + 0.1 seconds.
/// Before the first trial all cost the same.
/// tested: tests/coupling/placement/placement_test.cpp
class CostMeter
{
public:
  explicit CostMeter(std::size_t n_elements) : means_(n_elements, 1.0) {}

  /// @param seconds  of each element
  void add_trial(std::span<const double> seconds)
  {
    constexpr double weight = 0.1;
    for (std::size_t id = 0; id < means_.size(); ++id)
      means_[id] = empty_ ? seconds[id] : (1 - weight) * means_[id] + weight * seconds[id];
    empty_ = false;
  }
  const std::vector<double> &means() const { return means_; }

private:
  std::vector<double> means_;
  bool empty_ = true;
};
} // namespace isostat

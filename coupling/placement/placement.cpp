// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/placement/placement.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <queue>
#include <tuple>
#include <utility>

namespace isostat
{
namespace
{
std::vector<std::size_t> by_falling_cost(std::span<const double> costs)
{
  std::vector<std::size_t> order(costs.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return costs[a] > costs[b]; });
  return order;
}
} // namespace

Owners longest_first(std::span<const double> costs, int n_ranks)
{
  using Rank = std::pair<double, int>; // load, number: the smallest pair comes first
  std::priority_queue<Rank, std::vector<Rank>, std::greater<>> ranks;
  for (int r = 0; r < n_ranks; ++r)
    ranks.emplace(0.0, r);
  Owners owners(costs.size());
  for (std::size_t i : by_falling_cost(costs))
    {
      const auto [load, rank] = ranks.top();
      ranks.pop();
      owners[i] = rank;
      ranks.emplace(load + costs[i], rank);
    }
  return owners;
}

std::vector<double> loads_of(std::span<const double> costs, const Owners &owners, int n_ranks)
{
  std::vector<double> loads(n_ranks, 0.0);
  for (std::size_t i = 0; i < costs.size(); ++i)
    loads[owners[i]] += costs[i];
  return loads;
}
double imbalance(std::span<const double> costs, const Owners &owners, int n_ranks)
{
  const std::vector<double> loads = loads_of(costs, owners, n_ranks);
  const double sum = std::accumulate(loads.begin(), loads.end(), 0.0);
  return sum > 0 ? *std::max_element(loads.begin(), loads.end()) * n_ranks / sum : 1;
}

Owners renamed_to_stay(const Owners &parts, const Owners &present, int n_ranks)
{
  std::map<std::pair<int, int>, std::size_t> shared; // (part, rank) -> elements
  for (std::size_t i = 0; i < parts.size(); ++i)
    ++shared[{parts[i], present[i]}];
  std::vector<std::tuple<std::size_t, int, int>> pairs;
  for (const auto &[pair, n] : shared)
    pairs.emplace_back(n, pair.first, pair.second);
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const auto &a, const auto &b) { return std::get<0>(a) > std::get<0>(b); });
  constexpr int nobody = -1;
  std::vector<int> rank_of(n_ranks, nobody);
  std::vector<bool> taken(n_ranks, false);
  for (const auto &[n, part, rank] : pairs)
    if (rank_of[part] == nobody && !taken[rank])
      {
        rank_of[part] = rank;
        taken[rank] = true;
      }
  for (int part = 0, free = 0; part < n_ranks; ++part)
    if (rank_of[part] == nobody)
      {
        while (taken[free])
          ++free;
        rank_of[part] = free;
        taken[free] = true;
      }
  Owners renamed(parts.size());
  std::transform(parts.begin(), parts.end(), renamed.begin(), [&](int part) { return rank_of[part]; });
  return renamed;
}

void BalanceRule::check() const
{
  if (!(threshold >= 1 && min_gain >= 0) || interval == 0)
    throw InputError("rve: the threshold of balance must be >= 1, the smallest gain >= 0, the interval > 0");
}

Owners rebalanced(std::span<const double> costs, const Owners &present, int n_ranks, const BalanceRule &rule)
{
  const double now = imbalance(costs, present, n_ranks);
  if (!(now > rule.threshold))
    return present;
  const Owners parts = longest_first(costs, n_ranks);
  if (!(imbalance(costs, parts, n_ranks) <= (1 - rule.min_gain) * now))
    return present;
  return renamed_to_stay(parts, present, n_ranks);
}

std::vector<std::size_t> by_falling_cost(std::span<const double> costs, const Owners &owners, int rank)
{
  std::vector<std::size_t> order = by_falling_cost(costs);
  std::erase_if(order, [&](std::size_t i) { return owners[i] != rank; });
  return order;
}
} // namespace isostat

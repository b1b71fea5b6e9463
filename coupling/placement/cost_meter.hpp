// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <span>
#include <vector>

namespace isostat
{
/// Running mean of what each element costs in a trial: the first trial counts whole, then each with a weight of 0.1,
///     mean <- 0.9 mean + 0.1 seconds.
/// Before the first trial all cost the same.
/// tested: tests/coupling/placement/cost_meter_test.cpp
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

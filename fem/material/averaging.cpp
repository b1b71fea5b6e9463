// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/averaging.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace isostat
{
namespace
{
double distance2(const std::array<double, 3> &a, const std::array<double, 3> &b)
{
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}
} // namespace

Averaging::Averaging(double length, std::span<const std::array<double, 3>> positions, std::span<const double> volumes)
{
  if (!(length >= 0) || !std::isfinite(length))
    throw InputError(fmt::format("averaging: the length is {} m; it must be 0 or above", length));
  if (positions.size() != volumes.size())
    throw InputError(fmt::format("averaging: {} places but {} volumes", positions.size(), volumes.size()));
  for (std::size_t q = 0; q < volumes.size(); ++q)
    if (!(volumes[q] > 0))
      throw InputError(fmt::format("averaging: the volume of point {} is {}; it must be above 0", q, volumes[q]));
  constexpr double reach = 4; // exp(-8) = 3e-4 is left out
  find_pairs(reach * length, positions, length);
  balance(volumes);
}

/// weight_ = k, of all pairs within `reach`; points with themselves included.
void Averaging::find_pairs(double reach, std::span<const std::array<double, 3>> positions, double length)
{
  std::vector<unsigned> by_height(positions.size()), rank(positions.size());
  std::iota(by_height.begin(), by_height.end(), 0u);
  std::stable_sort(by_height.begin(), by_height.end(),
                   [&](unsigned a, unsigned b) { return positions[a][2] < positions[b][2]; });
  for (std::size_t k = 0; k < by_height.size(); ++k)
    rank[by_height[k]] = static_cast<unsigned>(k);
  first_ = {0};
  for (std::size_t q = 0; q < positions.size(); ++q)
    {
      std::size_t low = rank[q], high = rank[q] + 1;
      while (low > 0 && positions[q][2] - positions[by_height[low - 1]][2] < reach)
        --low;
      while (high < by_height.size() && positions[by_height[high]][2] - positions[q][2] < reach)
        ++high;
      for (std::size_t k = low; k < high; ++k)
        if (by_height[k] == q || distance2(positions[q], positions[by_height[k]]) < reach * reach)
          other_.push_back(by_height[k]);
      std::sort(other_.begin() + static_cast<std::ptrdiff_t>(first_.back()), other_.end());
      for (std::size_t k = first_.back(); k < other_.size(); ++k)
        weight_.push_back(
            other_[k] == q ? 1 : std::exp(-distance2(positions[q], positions[other_[k]]) / (2 * length * length)));
      first_.push_back(other_.size());
    }
}

/// k to W. The iteration s <- sqrt(s / sum k w s) converges fast for weights that are smooth; what remains of a row
/// goes to its diagonal, since apply() sums differences.
void Averaging::balance(std::span<const double> volumes)
{
  constexpr int max_rounds = 1000;
  constexpr double near_enough = 1e-13;
  std::vector<double> factor(n_points()), next(n_points());
  for (std::size_t q = 0; q < n_points(); ++q)
    factor[q] = 1 / std::sqrt(volumes[q]);
  double change = 1;
  for (int round = 0; round < max_rounds && change > near_enough; ++round)
    {
      change = 0;
      for (std::size_t q = 0; q < n_points(); ++q)
        {
          double sum = 0;
          for (std::size_t k = first_[q]; k < first_[q + 1]; ++k)
            sum += weight_[k] * volumes[other_[k]] * factor[other_[k]];
          next[q] = std::sqrt(factor[q] / sum);
          change = std::max(change, std::abs(factor[q] * sum - 1));
        }
      factor.swap(next);
    }
  for (std::size_t q = 0; q < n_points(); ++q)
    for (std::size_t k = first_[q]; k < first_[q + 1]; ++k)
      weight_[k] *= factor[q] * factor[other_[k]] * volumes[other_[k]];
}

void Averaging::apply(std::span<const double> in, std::span<double> out, std::size_t width) const
{
  for (std::size_t q = 0; q < n_points(); ++q)
    {
      const double *own = &in[q * width];
      double *mean = &out[q * width];
      std::fill_n(mean, width, 0);
      for (std::size_t k = first_[q]; k < first_[q + 1]; ++k)
        for (std::size_t c = 0; c < width; ++c)
          mean[c] += weight_[k] * (in[other_[k] * width + c] - own[c]);
      for (std::size_t c = 0; c < width; ++c)
        mean[c] += own[c];
    }
}
} // namespace isostat

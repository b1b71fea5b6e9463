// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/decimation_filter.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace isostat
{
namespace
{
constexpr std::size_t rows_to_a_side = 6;
constexpr std::size_t most_steps = 1'000'000;   ///< between rows
constexpr double kaiser = 4.53, middle = 0.375; ///< b; frequency of half the amplitude, per row
} // namespace

DecimationFilter::DecimationFilter(std::size_t n_channels, std::size_t stride)
    : n_channels_(n_channels), half_(stride > 1 ? rows_to_a_side * stride : 0)
{
  if (stride > most_steps)
    throw InputError("output.history_interval is " + std::to_string(stride) + " time steps; must be at most " +
                     std::to_string(most_steps) + ". Shorten it, or take a longer analysis.time_step.");
  double sum = 0;
  for (std::size_t k = 0; k <= half_; ++k)
    {
      const double at = static_cast<double>(k), part = at / static_cast<double>(half_ + 1),
                   turn = 2 * std::numbers::pi * middle * at / static_cast<double>(stride);
      weights_.push_back((k == 0 ? 1 : std::sin(turn) / turn) *
                         std::cyl_bessel_i(0.0, kaiser * std::sqrt(1 - part * part)));
      sum += (k == 0 ? 1 : 2) * weights_.back();
    }
  for (double &w : weights_)
    w /= sum;
  samples_.assign((2 * half_ + 1) * n_channels, 0.0);
}

void DecimationFilter::follow(std::span<const double> sample)
{
  const std::size_t place = n_samples_ % (2 * half_ + 1);
  std::ranges::copy(sample, samples_.begin() + static_cast<std::ptrdiff_t>(place * n_channels_));
  ++n_samples_;
}

std::vector<double> DecimationFilter::at(std::uint64_t sample) const
{
  std::vector<double> mean(n_channels_, 0.0);
  double sum = 0; // of the weights, with those of the rest before the first sample
  const std::uint64_t last = std::min<std::uint64_t>(sample + half_, n_samples_ - 1);
  const std::uint64_t first = sample < half_ ? 0 : sample - half_;
  std::size_t place = first % (2 * half_ + 1);
  for (std::uint64_t n = first; n <= last; ++n, place = place < 2 * half_ ? place + 1 : 0)
    {
      const double w = weights_[n < sample ? sample - n : n - sample];
      const double *values = &samples_[place * n_channels_];
      for (std::size_t c = 0; c < n_channels_; ++c)
        mean[c] += w * values[c];
      sum += w;
    }
  for (std::uint64_t k = sample + 1; k <= half_; ++k)
    sum += weights_[k];
  for (double &value : mean)
    value /= sum;
  return mean;
}

void DecimationFilter::restore(const std::vector<double> &samples, std::uint64_t n_samples)
{
  if (samples.size() != samples_.size())
    throw InputError("checkpoint: the filter of the history has " + std::to_string(samples.size()) +
                     " values, this run's " + std::to_string(samples_.size()) +
                     "; resume with the scene of the first run");
  samples_ = samples;
  n_samples_ = n_samples;
}
} // namespace isostat

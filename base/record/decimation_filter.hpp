// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <span>
#include <vector>

namespace isostat
{
/// Takes off samples, before only every `stride`-th of them is written, what those few cannot show and would show as
/// something slower (aliasing). Symmetric, so that nothing is delayed: a weighted mean over six rows to either side,
///
///     y_n = sum_{|k| <= 6 stride} w_k x_{n+k}, w_k = sin(2 pi f_6 k)/(pi k) I_0(b sqrt(1 - (k/K)^2)) / I_0(b); sum 1
///
/// a sinc of Kaiser's window (Kaiser 1974; b = 4.53 for 50 dB; f_6 = 0.375/stride a sample, K = 6 stride + 1). Of the
/// frequencies in 1/row: below 0.25 all pass (within 0.6 %), above 0.5, which rows cannot hold, none (0.3 %). Samples
/// before the first are 0 (rest); after the last the mean is of what there is.
/// Keeps 12 stride + 1 samples of each channel.   tested: tests/base/record/decimation_filter_test.cpp
class DecimationFilter
{
public:
  /// @param stride  samples in a row; 1: nothing is filtered
  DecimationFilter(std::size_t n_channels, std::size_t stride);

  bool filters() const { return half_ > 0; }
  /// The next sample, a value for each channel.   Cost: in the loop.
  void follow(std::span<const double> sample);
  std::uint64_t n_samples() const { return n_samples_; }
  /// Whether all samples are there that the mean at a sample needs.
  bool has(std::uint64_t sample) const { return sample + half_ < n_samples_; }
  /// The mean of each channel at a sample.   @pre sample < n_samples() <= sample + 12 stride + 1
  std::vector<double> at(std::uint64_t sample) const;

  /// The samples that are kept, in the order in which they lie; another filter of this size continues from them.
  const std::vector<double> &samples() const { return samples_; }
  /// @throws InputError  another number of values
  void restore(const std::vector<double> &samples, std::uint64_t n_samples);

private:
  std::size_t n_channels_, half_; ///< half_: samples to either side
  std::vector<double> weights_;   ///< w_0 ... w_half
  std::vector<double> samples_;   ///< [number % (2 half + 1)][channel]
  std::uint64_t n_samples_ = 0;
};
} // namespace isostat

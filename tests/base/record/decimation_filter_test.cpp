// SPDX-License-Identifier: BSD-3-Clause
#include "base/record/decimation_filter.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double pi = std::numbers::pi;

/// What a sine of unit amplitude becomes, and the size of the rest when the same sine is subtracted.   @param
/// frequency  per row
std::pair<double, double> gain(std::size_t stride, double frequency)
{
  DecimationFilter filter(2, stride);
  const double turn = 2 * pi * frequency / static_cast<double>(stride);
  const int end = static_cast<int>(40 * stride), middle = end / 2;
  double along = 0, largest = 0;
  for (int n = 0; n < end; ++n)
    {
      const double x[2] = {std::sin(turn * (n - middle)), std::cos(turn * (n - middle))};
      filter.follow(x);
      if (filter.has(static_cast<std::uint64_t>(middle)) && along == 0)
        {
          const std::vector<double> y = filter.at(static_cast<std::uint64_t>(middle));
          along = y[1];             // of the cosine: the gain
          largest = std::abs(y[0]); // of the sine: a delay
        }
    }
  return {along, largest};
}
} // namespace

TEST(DecimationFilter, PassesWhatRowsCanShowAndNothingElse)
{
  for (const std::size_t stride : {2, 12, 200})
    {
      double pass = 0, stop = 0, delay = 0;
      for (double f = 0; f <= 0.2501; f += 0.01)
        pass = std::max(pass, std::abs(gain(stride, f).first - 1));
      for (double f = 0.5; f <= static_cast<double>(stride) / 2; f *= 1.05)
        stop = std::max(stop, std::abs(gain(stride, f).first));
      for (double f : {0.05, 0.2, 0.375, 0.7})
        delay = std::max(delay, gain(stride, f).second);
      EXPECT_BELOW_BECAUSE(pass, 0.006, "Kaiser's window of 50 dB");
      EXPECT_BELOW_BECAUSE(stop, 0.003, "Kaiser's window of 50 dB");
      EXPECT_BELOW_BECAUSE(delay, 1e-12, "symmetric weights: round-off");
      EXPECT_NEAR_BECAUSE(gain(stride, 0.375).first, 0.5, 0.01, "where a sinc of Kaiser's window passes half");
    }
}

TEST(DecimationFilter, RowsAMillionStepsApartAreTheLast)
{
  EXPECT_THAT(message_of<InputError>([] { DecimationFilter(1, 1'000'001); }),
              testing::HasSubstr("output.history_interval is 1000001 time steps; must be at most 1000000"));
}

TEST(DecimationFilter, EveryStepIsLeftAlone)
{
  DecimationFilter filter(1, 1);
  EXPECT_FALSE(filter.filters());
  for (const double x : {3.0, -7.0})
    {
      filter.follow({&x, 1});
      EXPECT_EQ(filter.at(filter.n_samples() - 1)[0], x);
    }
}

TEST(DecimationFilter, RestBeforeTheFirstSampleAndTheMeanOfWhatIsThereAfterTheLast)
{
  DecimationFilter filter(1, 2);
  const double one = 1;
  for (int n = 0; n < 20; ++n)
    filter.follow({&one, 1});
  EXPECT_NEAR_BECAUSE(filter.at(19)[0], 1, 1e-14, "round-off of a mean");
  EXPECT_TRUE(filter.has(7));
  EXPECT_FALSE(filter.has(8));
  DecimationFilter started(1, 2);
  for (int n = 0; n < 13; ++n)
    started.follow({&one, 1});
  const double w0 = 2 * started.at(0)[0] - 1; // half of the weights lie before the start
  EXPECT_NEAR_BECAUSE(w0, 2 * 0.375 / 2, 0.01, "the weight in the middle of a sinc, except for its window");
}

TEST(DecimationFilter, ContinuesFromItsSamplesBitForBit)
{
  DecimationFilter whole(2, 3), resumed(2, 3);
  const auto sample = [](int n) { return std::array{std::sin(0.7 * n), std::cos(0.3 * n)}; };
  for (int n = 0; n < 50; ++n)
    whole.follow(sample(n));
  resumed.restore(whole.samples(), whole.n_samples());
  for (int n = 50; n < 90; ++n)
    {
      whole.follow(sample(n));
      resumed.follow(sample(n));
    }
  EXPECT_EQ(whole.at(70), resumed.at(70));
  EXPECT_THROW(DecimationFilter(2, 4).restore(whole.samples(), 90), InputError);
}
} // namespace isostat

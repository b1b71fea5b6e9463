// SPDX-License-Identifier: BSD-3-Clause
#include "fem/motion/response_spectrum.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <numbers>

namespace isostat
{
TEST(ResponseSpectrum, StepIsThatOfTheClosedForm)
{
  // of a constant a0 from rest: w^2 u = -a0 (1 - exp(-xi w t) (cos + xi w/w_d sin))
  for (const double xi : {0.0, 0.05, 0.2})
    for (const double dt : {0.05, 0.01, 0.001})
      {
        ResponseSpectrum spectrum({1.0}, xi, dt);
        for (double t = 0; t < 1.5; t += dt)
          spectrum.follow(2);
        const double w = 2 * std::numbers::pi, wd = w * std::sqrt(1 - xi * xi);
        double largest = 0, farthest = 0;
        for (double t = 0; t < 1; t += 1e-5)
          {
            const double decay = std::exp(-xi * w * t),
                         u = 1 - decay * (std::cos(wd * t) + xi * w / wd * std::sin(wd * t)),
                         v = decay * w * w / wd * std::sin(wd * t);
            largest = std::max(largest, std::abs(2 * (u + 2 * xi / w * v)));
            farthest = std::max(farthest, std::abs(2 * u));
          }
        const auto [absolute, pseudo] = spectrum.peaks();
        EXPECT_NEAR_BECAUSE(absolute[0], largest, 2e-3 * largest, "the crest between two steps of T/64: 0.12 %")
            << xi << " " << dt;
        EXPECT_NEAR_BECAUSE(pseudo[0], farthest, 2e-3 * farthest, "likewise") << xi << " " << dt;
      }
}

TEST(ResponseSpectrum, EndsOfTheSpectrumArePeakAccelerationAndResonance)
{
  const Motion sine = harmonic_motion(3, 2, 40, 2, 0.01);
  const auto [spectrum, pseudo] = response_spectrum(sine, {0.01, 0.5, 1000}, 0.05, 100);
  EXPECT_NEAR_BECAUSE(spectrum[0], 3, 0.03,
                      "a stiff oscillator goes with the base, and feels the kinks of samples as far apart as T");
  EXPECT_NEAR_BECAUSE(spectrum[1], 3 * std::sqrt(1 + 1 / (4 * 0.05 * 0.05)), 0.15,
                      "steady resonance: sqrt(1 + (2 xi)^2)/(2 xi), sampled and reached within 1 %");
  EXPECT_NEAR_BECAUSE(pseudo[1], 3 / (2 * 0.05), 0.15, "steady resonance of w^2 u: 1/(2 xi), sampled and reached");
  EXPECT_BELOW_BECAUSE(spectrum[2], 0.2, "a soft oscillator stays where it is");
}

TEST(ResponseSpectrum, HalvingTheIntervalOfALinearMotionChangesNothing)
{
  const std::vector<double> periods = {0.02, 0.3, 2};
  ResponseSpectrum coarse(periods, 0.05, 0.02), fine(periods, 0.05, 0.01);
  double last = 0;
  for (int k = 0; k < 300; ++k)
    {
      const double a = std::sin(0.3 * k) * std::exp(-0.01 * k);
      coarse.follow(a);
      if (k > 0)
        fine.follow((last + a) / 2);
      fine.follow(a);
      last = a;
    }
  for (std::size_t i = 0; i < periods.size(); ++i)
    EXPECT_NEAR_BECAUSE(fine.peaks().absolute[i], coarse.peaks().absolute[i], 2e-3 * coarse.peaks().absolute[i],
                        "exact steps, of which the peaks are taken at others");
}

TEST(ResponseSpectrum, FreeVibrationAfterTheMotionCounts)
{
  ResponseSpectrum kick({1.0}, 0, 1e-3);
  kick.follow(0);
  kick.follow(1);
  EXPECT_NEAR_BECAUSE(kick.peaks().absolute[0], 2 * std::numbers::pi * 1e-3, 1e-5, "an impulse of 1e-3 m/s, then w v");
}

TEST(ResponseSpectrum, ContinuesFromItsStateBitForBit)
{
  const std::vector<double> periods = spectrum_periods();
  EXPECT_EQ(periods.size(), 160u);
  EXPECT_NEAR_BECAUSE(periods.back(), 5, 1e-12, "round-off of a power");
  ResponseSpectrum whole(periods, 0.05, 1e-3), resumed(periods, 0.05, 1e-3);
  for (int k = 0; k < 100; ++k)
    whole.follow(std::sin(0.1 * k));
  resumed.restore(whole.save());
  for (int k = 100; k < 200; ++k)
    {
      whole.follow(std::sin(0.1 * k));
      resumed.follow(std::sin(0.1 * k));
    }
  EXPECT_EQ(whole.peaks().absolute, resumed.peaks().absolute);
  EXPECT_EQ(whole.peaks().pseudo, resumed.peaks().pseudo);
  EXPECT_THROW(ResponseSpectrum({1}, 0.05, 1e-3).restore(whole.save()), InputError);
  EXPECT_THROW(ResponseSpectrum({2, 1}, 0.05, 1e-3), InputError);
  EXPECT_THROW(ResponseSpectrum({0}, 0.05, 1e-3), InputError);
}
} // namespace isostat

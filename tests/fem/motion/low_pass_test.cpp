// SPDX-License-Identifier: BSD-3-Clause
#include "fem/motion/low_pass.hpp"

#include "tests/support/near.hpp"

#include <cmath>
#include <complex>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

namespace isostat
{
TEST(LowPass, GainOfASineIsButterworths)
{
  const double corner = 25, dt = 1e-3;
  for (const double f : {1.0, 10.0, 25.0, 40.0, 100.0, 300.0})
    {
      LowPass filter(corner, dt);
      const double omega = 2 * std::numbers::pi * f;
      std::complex<double> found = 0;
      for (int k = 0; k < 3000; ++k)
        {
          const double y = filter(std::cos(omega * dt * k));
          if (k >= 2000) // whole periods, after the start has died away
            found += y * std::exp(std::complex<double>(0, -omega * dt * k)) / 500.0;
        }
      const double warped = std::tan(omega * dt / 2) / std::tan(std::numbers::pi * corner * dt);
      EXPECT_NEAR_BECAUSE(std::abs(found), 1 / std::sqrt(1 + std::pow(warped, 8)), 1e-9, "round-off of 1,000 terms")
          << f;
    }
}

TEST(LowPass, PassesAllWithoutACornerAndAboveAQuarterOfTheSamples)
{
  for (LowPass filter : {LowPass(), LowPass(250, 1e-3)})
    for (double x : {1.0, -3.0, 0.5})
      EXPECT_EQ(filter(x), x);
}

TEST(LowPass, ContinuesFromItsState)
{
  LowPass one(25, 1e-3), other(25, 1e-3);
  for (int k = 0; k < 50; ++k)
    one(std::sin(0.1 * k));
  std::vector<double> state;
  LowPass::for_each_field(one, [&](double x) { state.push_back(x); });
  std::size_t next = 0;
  LowPass::for_each_field(other, [&](double &x) { x = state[next++]; });
  EXPECT_EQ(next, 4u);
  for (int k = 50; k < 60; ++k)
    EXPECT_EQ(one(std::sin(0.1 * k)), other(std::sin(0.1 * k)));
}
} // namespace isostat

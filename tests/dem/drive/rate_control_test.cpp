// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/rate_control.hpp"

#include "dem/measure/unbalanced.hpp"
#include "tests/support/near.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

namespace isostat
{
namespace
{
constexpr double dt = 5e-8, ramp_time = 200 * dt;

TEST(NextRate, RampsToTheRateInTheRampTime)
{
  const double rate = 2;
  Loading loading;
  int steps = 0;
  while (loading.signed_rate < 2 && steps < 1000)
    {
      const double before = loading.signed_rate;
      loading.signed_rate = next_rate(loading, rate, 0, 60e3, ramp_time, dt);
      EXPECT_NEAR_BECAUSE(loading.signed_rate - before, 2.0 / 200, 1e-12, "round-off of 200 additions");
      ++steps;
    }
  EXPECT_EQ(steps, 200);
  EXPECT_DOUBLE_EQ(next_rate(loading, rate, 0, 60e3, ramp_time, dt), 2);
}

TEST(NextRate, ArrivesAtTheLimitAtATenthOfTheRate)
{
  // a linear spring of 1 GPa: q follows the strain, the walls brake and cross q_amp slowly
  const double modulus = 1e9, limit = 60e3, rate = 2;
  for (const LoadDirection direction : {LoadDirection::compression, LoadDirection::extension})
    {
      Loading loading;
      loading.direction = direction;
      double q = 0;
      for (std::uint64_t k = 0; sign(direction) * q < limit && k < 100000; ++k)
        {
          update_slope(loading, q, k);
          loading.signed_rate = next_rate(loading, rate, q, limit, ramp_time, dt);
          loading.strain += loading.signed_rate * dt;
          q = modulus * loading.strain;
        }
      EXPECT_GE(sign(direction) * q, limit);
      EXPECT_LT(sign(direction) * q - limit, 50); // Pa
      EXPECT_BELOW_BECAUSE(std::abs(loading.signed_rate), 0.25 * rate,
                           "a tenth of the rate is aimed at; the slope is known as a mean of 20 steps");
    }
}

TEST(RateControl, FixedRateStays)
{
  Assembly assembly(test::specimen(500, 10));
  assembly.settings.time_step = dt;
  assembly.compute_forces();
  MotionSpec motion;
  motion.strain_rate = 0.7;
  Pace pace;
  pace.rate = initial_rate(motion);
  EXPECT_EQ(pace.rate, 0.7);
  update_rate(motion, {}, assembly, 200e3, 200e3, pace);
  EXPECT_EQ(pace.rate, 0.7);
  EXPECT_GT(pace.indicator, 0);
  EXPECT_EQ(initial_rate(motion, 0.3), 0.3); // the stage's own rate goes before
}

TEST(RateControl, FollowsTheToleranceWithinFloorAndCeiling)
{
  Assembly assembly(test::specimen(500, 10));
  assembly.settings.time_step = dt;
  assembly.compute_forces(); // at rest: the indicator is far below any tolerance
  MotionSpec motion;
  motion.rate_floor = 0.1;
  motion.rate_ceiling = 1.0;
  Pace pace;
  pace.rate = initial_rate(motion);
  EXPECT_EQ(pace.rate, 0.1);
  for (int k = 0; k < 50; ++k)
    update_rate(motion, {}, assembly, 200e3, 200e3, pace);
  EXPECT_EQ(pace.rate, 1.0);
  motion.quasi_static_tolerance = 1e-9;
  for (int k = 0; k < 50; ++k)
    update_rate(motion, {}, assembly, 200e3, 200e3, pace);
  EXPECT_EQ(pace.rate, 0.1);
}

TEST(RateControl, KeepsAnInertialNumberAtAnyStress)
{
  Assembly assembly(test::specimen(500, 10));
  assembly.settings.time_step = dt;
  assembly.compute_forces();
  const double d50 = assembly.d50(), density = assembly.packing().density, p0 = 200e3;
  MotionSpec motion;
  motion.inertial_number = 1e-4;
  Pace pace;
  pace.rate = initial_rate(motion);
  for (const double p : {200e3, 350e3, 20e3, 10e3, 200e3}) // up and down, at once: no memory, no floor or ceiling
    {
      update_rate(motion, {}, assembly, p, p0, pace);
      EXPECT_NEAR_BECAUSE(inertial_number(pace.rate, d50, density, p), 1e-4, 1e-16,
                          "round-off of a root and its square");
      EXPECT_GT(pace.indicator, 0);
    }
  for (const double p : {5e3, 100.0, 0.0, -1e3}) // below 5 % of p0 the rate is that of 5 %
    {
      update_rate(motion, {}, assembly, p, p0, pace);
      EXPECT_NEAR_BECAUSE(inertial_number(pace.rate, d50, density, 0.05 * p0), 1e-4, 1e-16,
                          "round-off of a root and its square");
    }
  motion.inertial_number = 1e-2;
  update_rate(motion, {}, assembly, p0, p0, pace);
  EXPECT_GT(pace.rate, motion.rate_ceiling);
  EXPECT_CLOSE_BECAUSE(pace.rate, 1e-2 * std::sqrt(p0 / density) / d50, 1e-9, "round-off of a root");
  update_rate(motion, 0.3, assembly, p0, p0, pace);
  EXPECT_EQ(pace.rate, 0.3);
}

TEST(QuasiStaticIndicator, IsContinuousInThePressure)
{
  Assembly assembly(test::specimen(500, 10));
  assembly.settings.time_step = dt;
  assembly.compute_forces();
  for (const double p : {0.01 * 200e3, 0.05 * 200e3})
    {
      const double below = quasi_static_indicator(assembly, p * (1 - 1e-9), 200e3, 2),
                   above = quasi_static_indicator(assembly, p * (1 + 1e-9), 200e3, 2);
      EXPECT_NEAR_BECAUSE(below / above, 1.0, 1e-6, "a slope times a change of pressure of 2e-9");
    }
}
} // namespace
} // namespace isostat

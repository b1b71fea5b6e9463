// SPDX-License-Identifier: BSD-3-Clause
#include "dem/drive/rate_control.hpp"

#include "base/error.hpp"
#include "dem/measure/unbalanced.hpp"
#include "tests/support/near.hpp"
#include "tests/support/specimens.hpp"

#include <gtest/gtest.h>

#include <array>

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
      start_loading(loading, 0, 0.5 * modulus);
      double q = 0;
      for (int k = 0; sign(direction) * q < limit && k < 100000; ++k)
        {
          update_slope(loading, q, 20);
          loading.signed_rate = next_rate(loading, rate, q, sign(direction) * limit, ramp_time, dt);
          loading.strain += loading.signed_rate * dt;
          q = modulus * loading.strain;
        }
      EXPECT_GE(sign(direction) * q, limit);
      EXPECT_LT(sign(direction) * q - limit, 50); // Pa
      EXPECT_BELOW_BECAUSE(std::abs(loading.signed_rate), 0.25 * rate,
                           "a tenth of the rate is aimed at; the slope is known as a mean of 20 steps");
    }
}

TEST(NextRate, BrakesBeforeATurningLoadOnTheOtherSideOfZero)
{
  // unloading from 90 to 30 kPa, as under a static bias
  const double modulus = 1e9, rate = 2;
  Loading loading{.direction = LoadDirection::extension};
  start_loading(loading, 90e3, 0.5 * modulus);
  double q = 90e3;
  for (int k = 0; q > 30e3 && k < 100000; ++k)
    {
      update_slope(loading, q, 20);
      loading.signed_rate = next_rate(loading, rate, q, 30e3, ramp_time, dt);
      loading.strain += loading.signed_rate * dt;
      q = 90e3 + modulus * loading.strain;
    }
  EXPECT_LT(30e3 - q, 50); // Pa
  EXPECT_BELOW_BECAUSE(-loading.signed_rate, 0.25 * rate,
                       "a tenth of the rate is aimed at; the slope is known as a mean of 20 steps");
}

TEST(NextRate, SlowsDownAsFastAsItIs)
{
  // the packing has become stiff: the bound is a hundredth of the rate that it has
  Loading loading{.signed_rate = 10};
  EXPECT_DOUBLE_EQ(next_rate(loading, 0.1, 0, 0, ramp_time, dt), 10 - 10.0 / 200);
}

TEST(Slope, IsExpectedUntilTheFirstWindowIsFull)
{
  Loading loading{.strain = 0.5, .signed_rate = 3};
  start_loading(loading, 1e3, 7e8);
  EXPECT_EQ(loading.signed_rate, 0);
  constexpr int window = 8;
  const std::array<double, 3> slopes{7e8, 4e8, 9e8}; // expected; of the path in the first window, in the second
  double load = 1e3;
  for (int step = 0; step < 3 * window; ++step)
    {
      update_slope(loading, load, window);
      const int full = step / window;
      EXPECT_NEAR_BECAUSE(loading.slope, slopes[full], 1e3, "round-off of strains of 1e-6 on 0.5");
      load -= slopes[std::min(full + 1, 2)] * 1e-6;
      loading.strain += 1e-6;
    }
}

TEST(StrainRate, IsThatOfTheStageOfTheMotionOrOfTheInertialNumber)
{
  const Assembly assembly(test::specimen(500, 10));
  MotionSpec motion;
  UndrainedCyclic stage;
  const auto rate = [&](double p0) { return strain_rate(stage.motion_in_force(motion), assembly, p0); };
  const auto number = [&](double p0) {
    return inertial_number(rate(p0), assembly.d50(), assembly.packing().density, p0);
  };
  EXPECT_CLOSE_BECAUSE(number(200e3), cyclic_inertial_number, 1e-14, "round-off of a root and its square");
  EXPECT_EQ(*UndrainedMonotonic().motion_in_force(motion).inertial_number, one_way_inertial_number);
  for (const double wanted : {5e-4, 1e-6})
    for (const double p0 : {200e3, 5e3})
      {
        motion.inertial_number = wanted;
        EXPECT_CLOSE_BECAUSE(number(p0), wanted, 1e-14, "round-off of a root and its square");
      }
  EXPECT_THROW(rate(0), RunFailure);
  motion.strain_rate = 0.7;
  EXPECT_EQ(rate(0), 0.7);
  EXPECT_EQ(rate(200e3), 0.7);
  stage.strain_rate = 0.3;
  EXPECT_EQ(rate(200e3), 0.3);
}

TEST(LoadRate, IsTheShareOfP0ThatAWaveTimeAllows)
{
  const Assembly assembly(test::specimen(500, 10));
  const auto load_rate = [&](const MotionSpec &motion) {
    Pace pace;
    set_bounds(motion, assembly, 200e3, pace);
    EXPECT_EQ(pace.rate, strain_rate(motion, assembly, 200e3));
    return pace.load_rate;
  };
  const double edge = assembly.box().edges().maxCoeff(), density = assembly.packing().density;
  const double wave = wave_time(assembly, 200e3);
  EXPECT_CLOSE_BECAUSE(wave, edge * std::sqrt(density / assembly.law()->young), 1e-14, "round-off");
  const MotionSpec motion{.load_per_wave = 0.05};
  EXPECT_CLOSE_BECAUSE(load_rate(motion) * wave, 0.05 * 200e3, 1e-14, "round-off");
  EXPECT_EQ(load_rate({.load_per_wave = 0}), 0);
  EXPECT_EQ(load_rate({.strain_rate = 0.7}), 0) << "a fixed rate stays what it is";
}

TEST(BoundedRate, IsLowWhereThePackingIsStiff)
{
  Pace pace{.rate = 10, .load_rate = 2e9};
  Loading loading;
  EXPECT_EQ(bounded_rate(pace, loading), 10) << "no contacts, no slope";
  loading.slope = 1e8;
  EXPECT_EQ(bounded_rate(pace, loading), 10);
  loading.slope = 5e8;
  EXPECT_DOUBLE_EQ(bounded_rate(pace, loading), 4);
  loading.slope = 1e30;
  EXPECT_DOUBLE_EQ(bounded_rate(pace, loading), 0.1);
  pace.load_rate = 0;
  EXPECT_EQ(bounded_rate(pace, loading), 10);
}

TEST(QuasiStaticIndicator, IsTheLargestOfItsParts)
{
  Assembly assembly(test::specimen(500, 10));
  assembly.settings.time_step = dt;
  assembly.compute_forces();
  const double p = 150e3, fast = 1e4;
  const double inertia = 10 * inertial_number(fast, assembly.d50(), assembly.packing().density, p),
               imbalance = assembly.unbalanced_force_ratio(),
               walls = (assembly.wall_stress() - assembly.contact_stress()).cwiseAbs().maxCoeff() / p;
  EXPECT_GT(inertia, std::max(imbalance, walls));
  EXPECT_GT(std::min(imbalance, walls), 0);
  EXPECT_DOUBLE_EQ(quasi_static_indicator(assembly, p, 200e3, fast), inertia);
  EXPECT_DOUBLE_EQ(quasi_static_indicator(assembly, p, 200e3, 0), std::max(imbalance, walls));
  EXPECT_DOUBLE_EQ(quasi_static_indicator(assembly, 1e3, 200e3, fast),
                   10 * inertial_number(fast, assembly.d50(), assembly.packing().density, 0.05 * 200e3));
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

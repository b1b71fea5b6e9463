// SPDX-License-Identifier: BSD-3-Clause
#include "fem/motion/motion_input.hpp"

#include "base/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <array>
#include <cmath>
#include <gmock/gmock.h>
#include <limits>
#include <numbers>

namespace isostat
{
namespace
{
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;

template <typename Action>
std::string refusal(const Action &action)
{
  return message_of<InputError>(action);
}

/// Samples of a function of time.
template <typename Function>
Motion sampled(const Function &f, std::size_t n, double dt)
{
  std::vector<double> a(n);
  for (std::size_t i = 0; i < n; ++i)
    a[i] = f(i * dt);
  return Motion(std::move(a), dt);
}

/// Largest |f - g| at times that are no samples, over [0, end].
template <typename F, typename G>
double largest_difference(const F &f, const G &g, double end)
{
  double largest = 0;
  for (double t = 0; t <= end; t += end / 9973)
    largest = std::max(largest, std::abs(f(t) - g(t)));
  return largest;
}

/// A record with many frequencies that starts and ends quietly: 40 s, 0.01 s.
double record(double t)
{
  double sum = 0;
  for (int k = 1; k <= 12; ++k)
    sum += std::sin(2 * pi * 0.37 * k * t + k * k) / k;
  return sum * std::exp(-0.02 * (t - 12) * (t - 12));
}
constexpr std::size_t record_samples = 4001;

TEST(Motion, LinearAccelerationIsIntegratedExactly)
{
  const double c = 0.7, s = -0.3;
  const Motion m = sampled([&](double t) { return c + s * t; }, 11, 0.3);
  const double a = largest_difference([&](double t) { return m.acceleration(t); }, [&](double t) { return c + s * t; },
                                      3.0 * (1 - 1e-12));
  const double v =
      largest_difference([&](double t) { return m.velocity(t); }, [&](double t) { return c * t + s * t * t / 2; }, 3);
  const double d = largest_difference([&](double t) { return m.displacement(t); },
                                      [&](double t) { return c * t * t / 2 + s * t * t * t / 6; }, 3);
  EXPECT_BELOW_BECAUSE(std::max({a, v, d}), 1e-14, "round-off: the integrals of a straight line are exact");
  EXPECT_EQ(m.peak(), 0.7);
  EXPECT_DOUBLE_EQ(m.duration(), 3);
}

TEST(Motion, ABrokenLineIsIntegratedExactly)
{
  const Motion m({0, 2, -1, -1}, 0.5); // by hand: areas 0.5, 0.25, -0.5
  EXPECT_DOUBLE_EQ(m.velocity(0.5), 0.5);
  EXPECT_DOUBLE_EQ(m.velocity(1), 0.75);
  EXPECT_DOUBLE_EQ(m.velocity(1.5), 0.25);
  EXPECT_DOUBLE_EQ(m.displacement(0.5), 4 * 0.125 / 6);
  EXPECT_DOUBLE_EQ(m.displacement(1), 0.5 / 6 + 0.25 + 2 * 0.125 - 6 * 0.125 / 6);
  EXPECT_DOUBLE_EQ(m.acceleration(0.75), 0.5);
}

TEST(Motion, BeforeAndAfterTheRecord)
{
  const Motion m({3, 3}, 2);
  EXPECT_EQ(m.acceleration(-1e-9), 0);
  EXPECT_EQ(m.acceleration(0), 3);
  EXPECT_EQ(m.acceleration(2), 3);
  EXPECT_EQ(m.acceleration(2.1), 0);
  EXPECT_EQ(m.velocity(-1), 0);
  EXPECT_EQ(m.displacement(-1), 0);
  EXPECT_EQ(m.velocity(10), 6);             // it keeps its velocity
  EXPECT_EQ(m.displacement(10), 6 + 6 * 8); // and runs away
  const Motion rest;
  EXPECT_TRUE(rest.at_rest());
  EXPECT_EQ(rest.acceleration(1) + rest.velocity(1) + rest.displacement(1) + rest.peak() + rest.duration(), 0);
}

TEST(Motion, DelayedByNoWholeInterval)
{
  const Motion m({1, -2, 3}, 0.5), later = m.delayed(2.3, -1);
  EXPECT_EQ(later.duration(), 3.3);
  EXPECT_EQ(later.delay(), 2.3);
  EXPECT_EQ(later.origin(), -1);
  EXPECT_EQ(later.acceleration(2.29), 0);
  EXPECT_EQ(later.displacement(2.3), 0);
  for (const double t : {0.0, 0.2, 0.5, 0.9, 1.0, 1.5})
    {
      EXPECT_NEAR_BECAUSE(later.velocity(2.3 + t), m.velocity(t), 1e-14, "round-off of times of 3 s");
      EXPECT_NEAR_BECAUSE(later.displacement(2.3 + t), m.displacement(t), 1e-14, "round-off of times of 3 s");
    }
}

TEST(Motion, BadSamples)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal([] { Motion({1}, 0.1); }), HasSubstr("1 samples; needs two"));
  EXPECT_THAT(refusal([] { Motion({1, 2}, 0); }), HasSubstr("interval = 0 s; must be in [1e-05, 10] s"));
  EXPECT_THAT(refusal([&] { Motion({1, nan, 2}, 0.1); }), HasSubstr("acceleration 2 of 3 is nan"));
}

/// Errors of acceleration, velocity and displacement against the closed form of a sine that starts at once.
std::array<double, 3> sine_errors(double dt)
{
  const double amplitude = 2, f = 1.25, w = 2 * pi * f, end = 4;
  const Motion m = harmonic_motion(amplitude, f, end, 0, dt);
  return {largest_difference([&](double t) { return m.acceleration(t); },
                             [&](double t) { return amplitude * std::sin(w * t); }, end),
          largest_difference([&](double t) { return m.velocity(t); },
                             [&](double t) { return amplitude / w * (1 - std::cos(w * t)); }, end),
          largest_difference([&](double t) { return m.displacement(t); },
                             [&](double t) { return amplitude / w * (t - std::sin(w * t) / w); }, end)};
}

TEST(Harmonic, ConvergesToTheClosedFormWithTheSquareOfTheInterval)
{
  const auto coarse = sine_errors(0.02), fine = sine_errors(0.01);
  for (int k = 0; k < 3; ++k)
    {
      const double order = std::log2(coarse[k] / fine[k]);
      EXPECT_NEAR_BECAUSE(order, 2, 0.1, "terms of the fourth order");
    }
  EXPECT_BELOW_BECAUSE(fine[0], 2 * std::pow(2 * pi * 1.25 * 0.01, 2) / 8 * 1.01,
                       "A (w dt)^2/8, error of the straight line, and 1 % for the terms of higher order");
}

constexpr test::Tolerance crest{1e-12, "round-off of a sine of some hundred radians at its crest"};

TEST(Harmonic, RampIsSmoothAndEndsTheDrift)
{
  const double f = 2, dt = 0.005;
  const Motion m = harmonic_motion(3, f, 20, 4, dt), sudden = harmonic_motion(3, f, 20, 0, dt);
  EXPECT_EQ(m.accelerations().size(), 4001u);
  EXPECT_NEAR_BECAUSE(m.peak(), 3, crest);
  for (const double t : {1.0625, 17.5625})
    {
      const double w = (1 - std::cos(pi * std::min(t, 20 - t) / 4)) / 2;
      EXPECT_NEAR_BECAUSE(
          m.acceleration(t), 3 * w * std::sin(2 * pi * f * t), 2e-3,
          "a straight line between samples: 3 (w dt)^2/8 of where it is curved, at samples none but that of the ramp");
    }
  EXPECT_NEAR_BECAUSE(m.acceleration(10.125), 3, crest);
  EXPECT_NEAR_BECAUSE(m.velocity(20), 0, 1e-12, "the motion is odd about 10 s: round-off of a sum of 4,000 samples");
  EXPECT_BELOW_BECAUSE(std::abs(m.displacement(20)), 0.01 * sudden.displacement(20),
                       "with a ramp the motion comes back: the straight lines between samples leave parts of (w dt)^2");
}

TEST(Harmonic, DurationThatIsNoMultipleOfTheInterval)
{
  const Motion m = harmonic_motion(1, 1, 1.26, 0, 0.05);
  EXPECT_EQ(m.accelerations().size(), 27u);
  EXPECT_EQ(m.accelerations().back(), 0);
  EXPECT_NEAR_BECAUSE(m.accelerations()[25], 1, crest);
}

/// 812 x (1/(500 4.06)) s is 0.4 s and a last bit: without a ramp, the envelope there is 1, not 0/0.
TEST(Harmonic, LastSampleARoundOffBehindTheEnd)
{
  int behind = 0;
  for (int hundredths = 100; hundredths <= 2000; ++hundredths)
    {
      const double frequency = hundredths / 100.0, interval = 1 / (500 * frequency);
      for (const double duration : {0.3, 0.4, 0.7, 1.0})
        {
          const Motion m = harmonic_motion(1, frequency, duration, 0, interval);
          const double last = (m.accelerations().size() - 1) * interval;
          behind += last > duration && last < duration * (1 + 1e-12);
          const double wave = last < duration * (1 + 1e-9) ? std::sin(2 * pi * frequency * last) : 0;
          EXPECT_EQ(m.accelerations().back(), wave) << frequency << " Hz for " << duration << " s";
        }
    }
  EXPECT_GT(behind, 10);
}

std::array<double, 3> ricker_errors(double dt)
{
  const double amplitude = 2, f = 2, t0 = 1; // exp(-(pi f t0)^2) = 7e-18 is cut off
  const auto gauss = [&](double t) { return std::exp(-std::pow(pi * f * (t - t0), 2)); };
  const Motion m = ricker_motion(amplitude, f, t0, dt);
  return {largest_difference([&](double t) { return m.acceleration(t); },
                             [&](double t) { return amplitude * (1 - 2 * std::pow(pi * f * (t - t0), 2)) * gauss(t); },
                             2 * t0),
          largest_difference([&](double t) { return m.velocity(t); },
                             [&](double t) { return amplitude * (t - t0) * gauss(t); }, 2 * t0),
          largest_difference([&](double t) { return m.displacement(t); },
                             [&](double t) { return -amplitude / (2 * pi * pi * f * f) * gauss(t); }, 2 * t0)};
}

TEST(Ricker, ConvergesToTheClosedFormWithTheSquareOfTheInterval)
{
  const auto coarse = ricker_errors(0.01), fine = ricker_errors(0.005);
  for (int k = 0; k < 3; ++k)
    {
      const double order = std::log2(coarse[k] / fine[k]);
      EXPECT_NEAR_BECAUSE(order, 2, 0.1, "terms of the fourth order");
    }
  const Motion m = ricker_motion(2, 2, 1, 0.005);
  EXPECT_NEAR_BECAUSE(m.peak(), 2, crest);
  EXPECT_NEAR_BECAUSE(m.velocity(5), 0, 1e-14, "what remains of the pulse and round-off");
  EXPECT_NEAR_BECAUSE(m.displacement(5), 0, 1e-14, "what remains of the pulse and round-off");
}

TEST(AnalyticMotions, BadArguments)
{
  EXPECT_THAT(refusal([] { harmonic_motion(1, 0, 1, 0, 0.01); }), HasSubstr("frequency = 0 Hz; must be > 0"));
  EXPECT_THAT(refusal([] { harmonic_motion(1, 5, 1, 0, 0.05); }), HasSubstr("interval = 0.05 s; must be in (0, 0.02]"));
  EXPECT_THAT(refusal([] { harmonic_motion(1, 5, 1, 0.6, 0.01); }), HasSubstr("ramp = 0.6 s; must be in [0, 0.5]"));
  EXPECT_THAT(refusal([] { harmonic_motion(1, 5, -1, 0, 0.01); }), HasSubstr("duration = -1 s"));
  EXPECT_THAT(refusal([] { harmonic_motion(NAN, 5, 1, 0, 0.01); }), HasSubstr("amplitude = nan"));
  EXPECT_THAT(refusal([] { ricker_motion(1, 2, 0.4, 0.01); }), HasSubstr("t0 = 0.4 s; must be 0.5 s"));
  EXPECT_THAT(refusal([] { ricker_motion(1, 2, 1, 0); }), HasSubstr("interval = 0 s"));
  EXPECT_THAT(refusal([] { harmonic_motion(1, 5, 1e4, 0, 1e-5); }), HasSubstr("1000000000 samples; must be at most"));
  EXPECT_THAT(refusal([] { Motion({0, 1, 0}, 1e-9); }), HasSubstr("interval = 1e-09 s; must be in [1e-05, 10] s"));
  EXPECT_THAT(refusal([] { Motion({0, 1, 0}, 1e7); }), HasSubstr("interval = 10000000 s; must be in [1e-05, 10] s"));
  EXPECT_THAT(refusal([] { Motion({0, 1e29, 0}, 0.01); }), HasSubstr("acceleration 2 of 3 is 1e+29 m/s2; must be"));
}

TEST(Baseline, BothEndWithoutVelocity)
{
  const Motion m =
      sampled([](double t) { return record(t) + 0.05 + 0.004 * t - 0.0002 * t * t; }, record_samples, 0.01);
  EXPECT_GT(std::abs(m.velocity(40)), 0.5);
  EXPECT_EQ(corrected(m, Baseline::none).accelerations(), m.accelerations());
  for (const Baseline b : {Baseline::mean, Baseline::quadratic})
    {
      const Motion c = corrected(m, b);
      EXPECT_BELOW_BECAUSE(std::abs(c.velocity(40)), 1e-12, "round-off of a sum of 4,000 samples");
      EXPECT_EQ(c.displacement(50), c.displacement(40) + c.velocity(40) * 10);
    }
  EXPECT_TRUE(corrected(Motion(), Baseline::quadratic).at_rest());
}

TEST(Baseline, QuadraticTakesAParabolaOffWhole)
{
  const Motion clean = corrected(sampled(record, record_samples, 0.01), Baseline::quadratic);
  const Motion drifted =
      corrected(sampled([](double t) { return record(t) + 0.05 + 0.004 * t - 0.0002 * t * t; }, record_samples, 0.01),
                Baseline::quadratic);
  const Motion twice = corrected(drifted, Baseline::quadratic);
  const Motion only =
      corrected(sampled([](double t) { return 0.2 - 0.03 * t + 0.001 * t * t; }, 4001, 0.01), Baseline::quadratic);
  const auto difference = [&](const Motion &a, const Motion &b) {
    return largest_difference([&](double t) { return a.displacement(t); }, [&](double t) { return b.displacement(t); },
                              40);
  };
  EXPECT_BELOW_BECAUSE(difference(clean, drifted), 1e-10,
                       "round-off of sums of 4,000 samples, integrated twice over 40 s");
  EXPECT_BELOW_BECAUSE(difference(twice, drifted), 1e-10,
                       "round-off of sums of 4,000 samples, integrated twice over 40 s");
  EXPECT_BELOW_BECAUSE(only.peak(), 1e-12, "round-off of a linear system of three unknowns");
  // A clean record stays what it was, except for its own slow part.
  const double change = largest_difference([&](double t) { return clean.acceleration(t); }, record, 40);
  EXPECT_BELOW_BECAUSE(change, 0.02 * clean.peak(), "the slow part of the record itself, 2 % of its peak at most");
}

TEST(Baseline, QuadraticHasTheSmallestVelocities)
{
  const double dt = 0.01;
  const Motion m = sampled([](double t) { return record(t) + 0.05; }, record_samples, dt);
  const auto sum_of_squares = [&](const Motion &motion) {
    double sum = 0;
    for (std::size_t i = 0; i < record_samples; ++i)
      sum += std::pow(motion.velocity(i * dt), 2);
    return sum;
  };
  const Motion best = corrected(m, Baseline::quadratic);
  const double minimum = sum_of_squares(best);
  EXPECT_LT(minimum, sum_of_squares(corrected(m, Baseline::mean)));
  for (const int power : {1, 2})
    for (const double by : {-1e-4, 1e-4})
      {
        const Motion step =
            corrected(sampled([&](double t) { return std::pow(t / 40, power); }, record_samples, dt), Baseline::mean);
        std::vector<double> a = best.accelerations();
        for (std::size_t i = 0; i < a.size(); ++i)
          a[i] += by * step.accelerations()[i];
        EXPECT_GT(sum_of_squares(Motion(a, dt)), minimum) << power << ' ' << by;
      }
}

TEST(Baseline, TwoSamplesAreEnough)
{
  const Motion c = corrected(Motion({1, 3}, 0.5), Baseline::quadratic);
  EXPECT_NEAR_BECAUSE(c.velocity(0.5), 0, 1e-15, "round-off of a sum of two");
  EXPECT_NEAR_BECAUSE(c.accelerations()[0], -1, 1e-12, "round-off of a linear system of three unknowns");
}

TEST(Scaling, FactorAndPeak)
{
  const Motion m({0.5, -2, 1}, 0.1);
  EXPECT_EQ(scaled(m, -2).accelerations(), (std::vector<double>{-1, 4, -2}));
  EXPECT_EQ(scaled_to_peak(m, 3).peak(), 3);
  EXPECT_DOUBLE_EQ(scaled_to_peak(m, 3).velocity(0.2), 1.5 * m.velocity(0.2));
  EXPECT_TRUE(scaled(Motion(), 2).at_rest());
  EXPECT_THAT(refusal([] { scaled_to_peak(Motion({0, 0, 0}, 0.1), 3); }), HasSubstr("all zero"));
  EXPECT_THAT(refusal([] { scaled_to_peak(Motion(), 3); }), HasSubstr("scaled to a peak of 3 m/s2"));
  EXPECT_THAT(refusal([&] { scaled_to_peak(m, 0); }), HasSubstr("peak acceleration = 0 m/s2; must be > 0"));
  EXPECT_THAT(refusal([&] { scaled(m, NAN); }), HasSubstr("scale factor = nan"));
}

TEST(Repeated, SecondTimeAfterAPauseAndOverlapping)
{
  const Motion m({0, 2, -1}, 0.5);
  EXPECT_EQ(repeated(m, 1.8).accelerations(), (std::vector<double>{0, 2, -1, 0, 0, 2, -1}));
  EXPECT_EQ(repeated(m, 0.5).accelerations(), (std::vector<double>{0, 2, 1, -1}));
  EXPECT_EQ(repeated(m, 2).duration(), 3);
  EXPECT_TRUE(repeated(Motion(), 1).at_rest());
  EXPECT_THAT(refusal([&] { repeated(m, 0); }), HasSubstr("must be > 0"));
}
} // namespace
} // namespace isostat

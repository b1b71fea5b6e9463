// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "fem/motion/motion_input.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temporary_folder.hpp"

#include <cmath>
#include <complex>
#include <gmock/gmock.h>
#include <numbers>

namespace isostat
{
namespace
{
using testing::HasSubstr;

constexpr double pi = std::numbers::pi;
const std::vector<double> periods{0.05, 0.2, 0.5, 1, 3, 10};

/// Largest absolute acceleration y under a ground acceleration of 1 that starts at once and lasts, from the closed form
/// y = 1 - exp(-xi w t) (cos wd t - (xi w/wd) sin wd t) at the first zero of its slope.
double step_peak(double period, double damping)
{
  const double w = 2 * pi / period, wd = w * std::sqrt(1 - damping * damping);
  // y' = 0: 2 xi cos(x) + (1 - 2 xi^2)/sqrt(1 - xi^2) sin(x) = 0, x = wd t in (0, pi]
  const double x = pi - std::atan2(2 * damping * std::sqrt(1 - damping * damping), 1 - 2 * damping * damping);
  return 1 - std::exp(-damping * w * x / wd) * (std::cos(x) - damping * w / wd * std::sin(x));
}

TEST(ResponseSpectrum, SuddenConstantAcceleration)
{
  for (const double damping : {0.0, 0.05, 0.2})
    {
      const Motion m(std::vector<double>(3001, 2.0), 0.01); // 30 s
      const std::vector<double> s = response_spectrum(m, periods, damping);
      for (std::size_t k = 0; k < periods.size(); ++k)
        {
          const double exact = 2 * step_peak(periods[k], damping);
          printf("step, T %5.2f s, damping %.2f: %.6f, exact %.6f, error %.1e\n", periods[k], damping, s[k], exact,
                 s[k] / exact - 1);
          EXPECT_BELOW_BECAUSE(s[k], exact * (1 + 1e-11), "round-off of 30 s in steps of T/64, some 1e5");
          EXPECT_GT(s[k], exact * (1 - 1.3e-3)); // 1 - cos(pi/64)
        }
    }
}

/// Largest absolute acceleration of an oscillator at rest under sin(w t) from t = 0 to `end`, by the closed form
/// u = Im(H e^{iwt}) + free vibration, H = -1/(w0^2 - w^2 + 2 i xi w0 w), looked at 2e6 times.
double sine_peak(double w, double w0, double damping, double end)
{
  const std::complex<double> i(0, 1), h = -1.0 / (w0 * w0 - w * w + 2.0 * i * damping * w0 * w);
  const double wd = w0 * std::sqrt(1 - damping * damping);
  const double b = -h.imag(), c = (-(w * h.real()) + damping * w0 * b) / wd; // u(0) = u'(0) = 0
  double largest = 0;
  const int n = 2000000;
  for (int k = 0; k <= n; ++k)
    {
      const double t = end * k / n, e = std::exp(-damping * w0 * t), cs = std::cos(wd * t), sn = std::sin(wd * t);
      const std::complex<double> z = h * std::exp(i * w * t);
      const double u = z.imag() + e * (b * cs + c * sn);
      const double v = (i * w * z).imag() + e * ((wd * c - damping * w0 * b) * cs - (wd * b + damping * w0 * c) * sn);
      largest = std::max(largest, std::abs(2 * damping * w0 * v + w0 * w0 * u));
    }
  return largest;
}

TEST(ResponseSpectrum, HarmonicMotion)
{
  const double f = 1, damping = 0.05, end = 20, dt = 0.002;
  const Motion m = harmonic_motion(1, f, end, 0, dt);
  for (const double period : {0.3, 0.8, 1.0, 1.7, 4.0})
    {
      const double s = response_spectrum(m, {period}, damping)[0];
      const double exact = sine_peak(2 * pi * f, 2 * pi / period, damping, end);
      printf("harmonic 1 Hz, T %.1f s: %.6f, exact %.6f, error %.1e\n", period, s, exact, s / exact - 1);
      EXPECT_NEAR_BECAUSE(s, exact, 5e-4 * exact, "samples 0.002 s apart miss little of a crest");
    }
}

TEST(ResponseSpectrum, SteadyStateAtResonance)
{
  const double damping = 0.05;
  const double s = response_spectrum(harmonic_motion(1, 1, 60, 0, 0.002), {1}, damping)[0];
  const double exact = std::sqrt(1 + 4 * damping * damping) / (2 * damping); // transmissibility, transient exp(-18.8)
  printf("resonance: %.6f, exact %.6f, error %.1e\n", s, exact, s / exact - 1);
  EXPECT_NEAR_BECAUSE(s, exact, 2e-4 * exact,
                      "a crest between samples 0.002 s apart, and the straight line between them");
}

TEST(ResponseSpectrum, ConvergesWithTheSquareOfTheInterval)
{
  const double exact = sine_peak(2 * pi, 2 * pi / 1.7, 0.05, 10);
  const auto error = [&](double dt) {
    return exact - response_spectrum(harmonic_motion(1, 1, 10, 0, dt), {1.7}, 0.05)[0];
  };
  const double coarse = error(0.04), fine = error(0.01), order = std::log2(coarse / fine) / 2;
  printf("harmonic, T 1.7 s: error %.2e at 0.04 s, %.2e at 0.01 s, order %.2f\n", coarse, fine, order);
  EXPECT_NEAR_BECAUSE(order, 2, 0.5, "the crest falls anywhere between two samples");
  EXPECT_BELOW_BECAUSE(fine, 1e-3 * exact,
                       "second order: (w dt)^2/12 of the record and the crest between two samples of 0.01 s");
}

TEST(ResponseSpectrum, ExactOnABrokenLineHoweverItIsSampled)
{
  const Motion coarse({0, 1, -2, 0.5, 0}, 0.4);
  std::vector<double> a;
  for (int i = 0; i <= 64; ++i)
    a.push_back(coarse.acceleration(i * 0.025));
  // Periods whose steps of T/64 or less are the same for both: 0.025 s holds one step if T >= 1.6 s.
  const double one = response_spectrum(coarse, {1.6}, 0.05)[0];
  const double other = response_spectrum(Motion(a, 0.025), {1.6}, 0.05)[0];
  printf("broken line: relative difference %.1e\n", one / other - 1);
  EXPECT_NEAR_BECAUSE(one, other, 1e-12 * other, "round-off of the same steps from other samples");
}

TEST(ResponseSpectrum, LimitsOfStiffAndSoftAndWhatFollowsTheRecord)
{
  const Motion m = ricker_motion(2, 1, 2, 0.005);
  EXPECT_EQ(response_spectrum(m, {0}, 0.05)[0], m.peak());
  EXPECT_NEAR_BECAUSE(response_spectrum(m, {0.01}, 0.05)[0], 2, 0.01, "stiff: moves with the ground, but for (T f)^2");
  // A short pulse of velocity V on a soft oscillator: w V, reached a quarter of a period after the pulse.
  const Motion pulse({0, 1, 0}, 0.01);
  const double soft = response_spectrum(pulse, {5}, 0)[0], exact = 2 * pi / 5 * 0.01;
  printf("pulse on a soft oscillator: %.6e, exact %.6e\n", soft, exact);
  EXPECT_NEAR_BECAUSE(soft, exact, 1.3e-3 * exact, "1 - cos(pi/64): the crest between two steps of T/64");
}

TEST(ResponseSpectrum, BadArguments)
{
  const Motion m({0, 1}, 1);
  EXPECT_THAT(message_of<InputError>([&] { response_spectrum(m, {1}, 5); }),
              HasSubstr("damping = 5; must be in [0, 1), a fraction of the critical one: 0.05 is 5 %"));
  EXPECT_THAT(message_of<InputError>([&] { response_spectrum(m, {-1}, 0.05); }), HasSubstr("period = -1 s"));
  EXPECT_EQ(response_spectrum(Motion(), {1}, 0.05), std::vector<double>{0});
}
} // namespace
} // namespace isostat

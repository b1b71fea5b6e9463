// SPDX-License-Identifier: BSD-3-Clause
#include "base/error.hpp"
#include "fem/motion/motion_input.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double steps_per_period = 64, most_steps_per_sample = 1000;

/// A damped oscillator, displacement relative to the ground, and its exact step of a fixed length.
class Oscillator
{
public:
  Oscillator(double period, double damping) : omega_(2 * std::numbers::pi / period), damping_(damping) {}

  void set_step(double step)
  {
    const double damped = omega_ * std::sqrt(1 - damping_ * damping_), decay = std::exp(-damping_ * omega_ * step);
    const double c = decay * std::cos(damped * step), s = decay * std::sin(damped * step) / damped;
    step_ = step;
    uu_ = c + damping_ * omega_ * s;
    uv_ = s;
    vu_ = -omega_ * omega_ * s;
    vv_ = c - damping_ * omega_ * s;
  }

  /// One step under a + slope tau. The particular solution p + q tau is left out of the free vibration.
  void advance(double a, double slope)
  {
    const double q = -slope / (omega_ * omega_), p = (-a - 2 * damping_ * omega_ * q) / (omega_ * omega_);
    const double u = u_ - p, v = v_ - q;
    u_ = uu_ * u + uv_ * v + p + q * step_;
    v_ = vu_ * u + vv_ * v + q;
    peak_ = std::max(peak_, std::abs(2 * damping_ * omega_ * v_ + omega_ * omega_ * u_));
  }

  double peak() const { return peak_; } ///< absolute acceleration, m/s2

private:
  double omega_, damping_, step_ = 0, uu_ = 1, uv_ = 0, vu_ = 0, vv_ = 1;
  double u_ = 0, v_ = 0, peak_ = 0;
};

double peak_response(const Motion &motion, double period, double damping)
{
  const std::vector<double> &a = motion.accelerations();
  const double dt = motion.interval();
  const double wanted = std::ceil(steps_per_period * dt / period);
  const int n_steps = static_cast<int>(std::clamp(wanted, 1.0, most_steps_per_sample));
  Oscillator oscillator(period, damping);
  oscillator.set_step(dt / n_steps);
  for (std::size_t i = 0; i + 1 < a.size(); ++i)
    {
      const double slope = (a[i + 1] - a[i]) / dt;
      for (int k = 0; k < n_steps; ++k)
        oscillator.advance(a[i] + slope * (k * dt / n_steps), slope);
    }
  oscillator.set_step(period / steps_per_period);
  for (int k = 0; k < steps_per_period; ++k)
    oscillator.advance(0, 0);
  return oscillator.peak();
}
} // namespace

std::vector<double> response_spectrum(const Motion &motion, const std::vector<double> &periods, double damping)
{
  if (!(damping >= 0 && damping < 1))
    throw InputError(
        fmt::format("damping = {}; must be in [0, 1), a fraction of the critical one: 0.05 is 5 %", damping));
  std::vector<double> spectrum;
  for (const double period : periods)
    {
      if (!(period >= 0 && std::isfinite(period)))
        throw InputError(fmt::format("period = {} s; must be >= 0", period));
      spectrum.push_back(period > 0 ? peak_response(motion, period, damping) : motion.peak());
    }
  return spectrum;
}
} // namespace isostat

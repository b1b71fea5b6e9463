// SPDX-License-Identifier: BSD-3-Clause
#include "fem/motion/motion_input.hpp"

#include "base/error.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double pi = std::numbers::pi;

void check(bool good, const std::string &message)
{
  if (!good)
    throw InputError(message);
}

/// An interval that shows the wave: lines between ten samples in a period miss 5 % of a crest at most.
void check_sampling(double amplitude, double frequency, double interval)
{
  check(std::isfinite(amplitude), fmt::format("amplitude = {} m/s2; must be finite", amplitude));
  check(frequency > 0 && std::isfinite(frequency), fmt::format("frequency = {} Hz; must be > 0", frequency));
  check(interval > 0 && interval * frequency <= 0.1 * (1 + 1e-9),
        fmt::format("interval = {} s; must be in (0, {}] s, ten samples in a period of {} Hz; take a shorter one",
                    interval, 0.1 / frequency, frequency));
}

/// Steps that reach `duration`; a multiple of the interval is not exceeded because of round-off.
std::size_t steps_to(double duration, double interval)
{
  const double n = std::ceil(duration / interval - 1e-6);
  check(n <= Motion::most_samples,
        fmt::format("{} s at an interval of {} s are {} samples; must be at most {}. Take a longer "
                    "interval or a shorter motion",
                    duration, interval, n, Motion::most_samples));
  return std::max<std::size_t>(1, n);
}

/// Rise and fall between 0 and 1; 0 outside.
double envelope(double t, double duration, double ramp)
{
  const double inside = std::min(t, duration - t);
  if (inside < -1e-9 * duration)
    return 0;
  if (inside >= ramp || ramp == 0) // the last sample may lie a round-off behind the end
    return 1;
  return 0.5 * (1 - std::cos(pi * std::max(0.0, inside) / ramp));
}

/// a - sum_k c_k (t/T)^k, k = 1, 2, each power without its mean: the velocity at the end does not change.
Motion without_parabola(const Motion &motion)
{
  const std::size_t n = motion.accelerations().size();
  const double dt = motion.interval(), end = motion.duration();
  std::vector<Motion> powers;
  Eigen::MatrixXd velocities(n, 2);
  Eigen::VectorXd drift(n);
  for (int k = 1; k <= 2; ++k)
    {
      std::vector<double> power(n);
      for (std::size_t i = 0; i < n; ++i)
        power[i] = std::pow(i * dt / end, k);
      powers.push_back(corrected(Motion(std::move(power), dt), Baseline::mean));
      for (std::size_t i = 0; i < n; ++i)
        velocities(i, k - 1) = powers.back().velocity(i * dt);
    }
  for (std::size_t i = 0; i < n; ++i)
    drift[i] = motion.velocity(i * dt);
  // Two or three samples do not separate the powers: the decomposition then takes the smallest coefficients.
  const Eigen::Vector2d c = velocities.completeOrthogonalDecomposition().solve(drift);
  std::vector<double> a = motion.accelerations();
  for (std::size_t i = 0; i < n; ++i)
    a[i] -= c[0] * powers[0].accelerations()[i] + c[1] * powers[1].accelerations()[i];
  return Motion(std::move(a), dt);
}
} // namespace

Motion::Motion(std::vector<double> accelerations, double interval)
    : accelerations_(std::move(accelerations)), interval_(interval)
{
  const std::size_t n = accelerations_.size();
  check(n >= 2, fmt::format("a motion of {} samples; needs two at least", n));
  check(interval >= shortest_interval && interval <= longest_interval,
        fmt::format("interval = {} s; must be in [{}, {}] s. Are its times in seconds?", interval, shortest_interval,
                    longest_interval));
  velocities_.resize(n);
  displacements_.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    {
      if (!(std::abs(accelerations_[i]) <= strongest)) // or not a number
        throw InputError(fmt::format("acceleration {} of {} is {} m/s2; must be within {} m/s2. Is the unit right?",
                                     i + 1, n, accelerations_[i], strongest));
      if (i + 1 == n)
        break;
      const double a = accelerations_[i], b = accelerations_[i + 1], h = interval;
      velocities_[i + 1] = velocities_[i] + h * (a + b) / 2;
      displacements_[i + 1] = displacements_[i] + h * (velocities_[i] + h * (2 * a + b) / 6);
    }
}

double Motion::duration() const { return at_rest() ? 0 : delay_ + (accelerations_.size() - 1) * interval_; }

Motion Motion::delayed(double delay, double origin) const
{
  Motion later = *this;
  later.delay_ = delay;
  later.origin_ = origin;
  return later;
}

double Motion::peak() const
{
  double peak = 0;
  for (const double a : accelerations_)
    peak = std::max(peak, std::abs(a));
  return peak;
}

Motion::Place Motion::place(double t) const
{
  const double last = accelerations_.size() - 2;
  const std::size_t i = std::min(std::floor(t / interval_), last);
  return {i, t - i * interval_, (accelerations_[i + 1] - accelerations_[i]) / interval_};
}

double Motion::acceleration(double t) const
{
  if (at_rest() || t < delay_ || t > duration())
    return 0;
  const auto [i, tau, slope] = place(t - delay_);
  return accelerations_[i] + tau * slope;
}

double Motion::velocity(double t) const
{
  if (at_rest() || t < delay_)
    return 0;
  if (t >= duration())
    return velocities_.back();
  const auto [i, tau, slope] = place(t - delay_);
  return velocities_[i] + tau * (accelerations_[i] + tau * slope / 2);
}

double Motion::displacement(double t) const
{
  if (at_rest() || t < delay_)
    return 0;
  if (t >= duration())
    return displacements_.back() + velocities_.back() * (t - duration());
  const auto [i, tau, slope] = place(t - delay_);
  return displacements_[i] + tau * (velocities_[i] + tau * (accelerations_[i] / 2 + tau * slope / 6));
}

Motion harmonic_motion(double amplitude, double frequency, double duration, double ramp, double interval)
{
  check_sampling(amplitude, frequency, interval);
  check(duration > 0 && std::isfinite(duration), fmt::format("duration = {} s; must be > 0", duration));
  check(ramp >= 0 && 2 * ramp <= duration,
        fmt::format("ramp = {} s; must be in [0, {}] s because it comes at both ends; shorten it or take a longer "
                    "duration",
                    ramp, duration / 2));
  std::vector<double> a(steps_to(duration, interval) + 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    a[i] = amplitude * envelope(i * interval, duration, ramp) * std::sin(2 * pi * frequency * (i * interval));
  return Motion(std::move(a), interval);
}

Motion ricker_motion(double amplitude, double frequency, double t0, double interval)
{
  check_sampling(amplitude, frequency, interval);
  check(std::isfinite(t0) && frequency * t0 >= 1 - 1e-9,
        fmt::format("t0 = {} s; must be {} s = 1/frequency at least, or the wavelet is cut off at its start", t0,
                    1 / frequency));
  std::vector<double> a(steps_to(2 * t0, interval) + 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    {
      const double b = pi * frequency * (i * interval - t0), b2 = b * b;
      a[i] = amplitude * (1 - 2 * b2) * std::exp(-b2);
    }
  return Motion(std::move(a), interval);
}

Motion corrected(const Motion &motion, Baseline baseline)
{
  if (motion.at_rest() || baseline == Baseline::none)
    return motion;
  std::vector<double> a = motion.accelerations();
  const double mean = motion.velocity(motion.duration()) / motion.duration();
  for (double &value : a)
    value -= mean;
  const Motion level(std::move(a), motion.interval());
  return baseline == Baseline::mean ? level : without_parabola(level);
}

Motion scaled(const Motion &motion, double factor)
{
  check(std::isfinite(factor), fmt::format("scale factor = {}; must be finite", factor));
  if (motion.at_rest())
    return motion;
  std::vector<double> a = motion.accelerations();
  for (double &value : a)
    value *= factor;
  return Motion(std::move(a), motion.interval());
}

Motion scaled_to_peak(const Motion &motion, double peak)
{
  check(peak > 0 && std::isfinite(peak), fmt::format("peak acceleration = {} m/s2; must be > 0", peak));
  check(motion.peak() > 0, fmt::format("a motion that is all zero cannot be scaled to a peak of {} m/s2; check the "
                                       "record, or ask for no peak",
                                       peak));
  return scaled(motion, peak / motion.peak());
}

Motion repeated(const Motion &motion, double start)
{
  check(start > 0 && std::isfinite(start), fmt::format("start of the second motion = {} s; must be > 0", start));
  if (motion.at_rest())
    return motion;
  const std::vector<double> &once = motion.accelerations();
  const std::size_t shift = steps_to(start, motion.interval());
  std::vector<double> a(once.size() + shift, 0.0);
  for (std::size_t i = 0; i < once.size(); ++i)
    {
      a[i] += once[i];
      a[i + shift] += once[i];
    }
  return Motion(std::move(a), motion.interval());
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "fem/motion/response_spectrum.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace isostat
{
namespace
{
constexpr double parts_per_period = 64;
constexpr double smallest = 1e-150; // below it at rest: numbers that underflow are slow
} // namespace

/// The exact step of length h: free vibration A, and the particular solution p + q tau of a linear acceleration, which
/// is left out of the free vibration.
ResponseSpectrum::Oscillator ResponseSpectrum::oscillator(double period, double damping, double interval)
{
  if (!(period > 0) || !(damping >= 0) || !(damping < 1) || !(interval > 0))
    throw InputError("response spectrum: period = " + std::to_string(period) +
                     " s, damping = " + std::to_string(damping) + ", interval = " + std::to_string(interval) +
                     " s; must be > 0, in [0, 1), > 0");
  Oscillator o{};
  o.parts = static_cast<unsigned>(std::ceil(parts_per_period * interval / period));
  o.after = static_cast<unsigned>(std::ceil(period / interval));
  const double h = interval / o.parts, w = 2 * std::numbers::pi / period, damped = w * std::sqrt(1 - damping * damping),
               decay = std::exp(-damping * w * h), c = decay * std::cos(damped * h),
               s = decay * std::sin(damped * h) / damped;
  o.stiff = w * w;
  o.damp = 2 * damping * w;
  o.a11 = c + damping * w * s;
  o.a12 = s;
  o.a21 = -w * w * s;
  o.a22 = c - damping * w * s;
  const auto response = [&](double a, double slope, double &u, double &v) {
    const double q = -slope / o.stiff, p = (-a - o.damp * q) / o.stiff;
    u = -o.a11 * p - o.a12 * q + p + q * h;
    v = -o.a21 * p - o.a22 * q + q;
  };
  response(1, -1 / h, o.b01, o.b02);
  response(0, 1 / h, o.b11, o.b12);
  return o;
}

ResponseSpectrum::ResponseSpectrum(const std::vector<double> &periods, double damping, double interval)
{
  if (!std::ranges::is_sorted(periods))
    throw InputError("response spectrum: its periods must rise");
  for (double period : periods)
    {
      const Oscillator o = oscillator(period, damping, interval);
      oscillators_.push_back(o);
      if (o.parts > 1)
        {
          states_.emplace_back();
          continue;
        }
      Rows &r = rows_;
      for (auto [to, value] : {std::pair(&r.a11, o.a11),
                               {&r.a12, o.a12},
                               {&r.a21, o.a21},
                               {&r.a22, o.a22},
                               {&r.b01, o.b01},
                               {&r.b02, o.b02},
                               {&r.b11, o.b11},
                               {&r.b12, o.b12},
                               {&r.stiff, o.stiff},
                               {&r.damp, o.damp},
                               {&r.u, 0.0},
                               {&r.v, 0.0},
                               {&r.peak, 0.0},
                               {&r.largest, 0.0}})
        to->push_back(value);
    }
}

ResponseSpectrum::State ResponseSpectrum::state(std::size_t i) const
{
  if (i < states_.size())
    return states_[i];
  const std::size_t k = i - states_.size();
  return {rows_.u[k], rows_.v[k], rows_.peak[k], rows_.largest[k]};
}

void ResponseSpectrum::step(const Oscillator &o, double from, double to, State &s)
{
  const double slope = (to - from) / o.parts;
  double a0 = from;
  for (unsigned k = 1; k <= o.parts; ++k)
    {
      const double a1 = k == o.parts ? to : from + k * slope;
      const double u = o.a11 * s.u + o.a12 * s.v + o.b01 * a0 + o.b11 * a1,
                   v = o.a21 * s.u + o.a22 * s.v + o.b02 * a0 + o.b12 * a1;
      s.u = std::abs(u) < smallest ? 0 : u;
      s.v = std::abs(v) < smallest ? 0 : v;
      s.peak = std::max(s.peak, std::abs(o.stiff * u + o.damp * v));
      s.largest = std::max(s.largest, std::abs(u));
      a0 = a1;
    }
}

void ResponseSpectrum::follow(double acceleration)
{
  if (started_)
    {
      for (std::size_t i = 0; i < states_.size(); ++i)
        step(oscillators_[i], last_, acceleration, states_[i]);
      const double *a11 = rows_.a11.data(), *a12 = rows_.a12.data(), *a21 = rows_.a21.data(), *a22 = rows_.a22.data(),
                   *b01 = rows_.b01.data(), *b02 = rows_.b02.data(), *b11 = rows_.b11.data(), *b12 = rows_.b12.data(),
                   *stiff = rows_.stiff.data(), *damp = rows_.damp.data(), a0 = last_, a1 = acceleration;
      double *__restrict us = rows_.u.data(), *__restrict vs = rows_.v.data(), *__restrict peak = rows_.peak.data(),
                         *__restrict largest = rows_.largest.data();
      const std::size_t n = rows_.u.size();
      for (std::size_t i = 0; i < n; ++i)
        {
          const double u = a11[i] * us[i] + a12[i] * vs[i] + b01[i] * a0 + b11[i] * a1,
                       v = a21[i] * us[i] + a22[i] * vs[i] + b02[i] * a0 + b12[i] * a1,
                       size = std::abs(stiff[i] * u + damp[i] * v);
          us[i] = std::abs(u) < smallest ? 0 : u;
          vs[i] = std::abs(v) < smallest ? 0 : v;
          peak[i] = size > peak[i] ? size : peak[i];
        }
      for (std::size_t i = 0; i < n; ++i) // apart: more pointers than registers
        {
          const double size = std::abs(us[i]);
          largest[i] = size > largest[i] ? size : largest[i];
        }
    }
  started_ = true;
  last_ = acceleration;
}

ResponseSpectrum::Peaks ResponseSpectrum::peaks() const
{
  Peaks peaks;
  for (std::size_t i = 0; i < oscillators_.size(); ++i)
    {
      State s = state(i);
      step(oscillators_[i], last_, 0, s);
      for (unsigned k = 0; k < oscillators_[i].after; ++k)
        step(oscillators_[i], 0, 0, s);
      peaks.absolute.push_back(s.peak);
      peaks.pseudo.push_back(oscillators_[i].stiff * s.largest);
    }
  return peaks;
}

std::vector<double> ResponseSpectrum::save() const
{
  std::vector<double> state = {last_, started_ ? 1.0 : 0.0};
  for (std::size_t i = 0; i < oscillators_.size(); ++i)
    {
      const State s = this->state(i);
      state.insert(state.end(), {s.u, s.v, s.peak, s.largest});
    }
  return state;
}

void ResponseSpectrum::restore(const std::vector<double> &state)
{
  if (state.size() != 2 + 4 * oscillators_.size())
    throw InputError("checkpoint: a response spectrum of " + std::to_string(state.size()) +
                     " numbers does not fit; resume with the scene of the first run");
  last_ = state[0];
  started_ = state[1] != 0;
  for (std::size_t i = 0; i < oscillators_.size(); ++i)
    {
      const double *s = &state[2 + 4 * i];
      if (const std::size_t k = i - states_.size(); i >= states_.size())
        rows_.u[k] = s[0], rows_.v[k] = s[1], rows_.peak[k] = s[2], rows_.largest[k] = s[3];
      else
        states_[i] = {s[0], s[1], s[2], s[3]};
    }
}

std::vector<double> spectrum_periods()
{
  constexpr int n = 160;
  constexpr double shortest = 0.02, longest = 5;
  std::vector<double> periods;
  for (int k = 0; k < n; ++k)
    periods.push_back(shortest * std::pow(longest / shortest, k / (n - 1.0)));
  return periods;
}

ResponseSpectrum::Peaks response_spectrum(const Motion &motion, const std::vector<double> &periods, double damping,
                                          double end)
{
  const std::vector<double> rest(periods.size(), 0.0);
  if (motion.at_rest())
    return {rest, rest};
  ResponseSpectrum spectrum(periods, damping, motion.interval());
  const auto time = [&](std::size_t k) { return motion.delay() + static_cast<double>(k) * motion.interval(); };
  for (std::size_t k = 0; k < motion.accelerations().size() && time(k) <= end; ++k)
    spectrum.follow(motion.accelerations()[k]);
  return spectrum.peaks();
}
} // namespace isostat

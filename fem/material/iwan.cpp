// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/iwan.hpp"

#include "base/scene/numbers.hpp"
#include "fem/material/elastic.hpp"
#include "fem/material/iwan_scene.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace isostat
{
namespace
{
std::vector<double> checked_numbers(IwanParameters p, std::span<const double> more)
{
  check_numbers(all_iwan_keys().keys, p, "iwan: ");
  std::vector<double> numbers = numbers_of(all_iwan_keys().keys, p);
  numbers.insert(numbers.end(), more.begin(), more.end());
  return numbers;
}
} // namespace

Backbone fit_hyperbola(unsigned n)
{
  if (n < 4 || n > 128)
    throw InputError("iwan: elements = " + std::to_string(n) + "; must be 4 to 128");
  // Lift and last node: those of the minimax error, found by search for n = 8 ... 20; of many elements the last node is
  // where the lifted hyperbola reaches the strength, and 1.2/lift would be beyond it.
  const bool many = n > 32;
  const double lift = 0.018 * std::pow(12.0 / n, many ? 1.53 : 1.35), last = many ? 1.0 : 1.2;
  const double ratio = std::pow(last / (lift * lift), 1.0 / (n - 1));
  std::vector<double> x(n + 1, 0.0), f(n + 1, 0.0);
  for (unsigned k = 1; k <= n; ++k)
    {
      x[k] = lift * std::pow(ratio, k - 1.0);
      f[k] = (1 + lift) * x[k] / (1 + x[k]);
    }
  f[1] = x[1];
  f[n] = 1;
  Backbone b;
  for (unsigned k = 1; k <= n; ++k)
    {
      const double slope = (f[k] - f[k - 1]) / (x[k] - x[k - 1]);
      b.weights.push_back(slope - (k < n ? (f[k + 1] - f[k]) / (x[k + 1] - x[k]) : 0));
      b.yield_strains.push_back(x[k]);
    }
  return b;
}

Iwan::Iwan(const IwanParameters &p, std::size_t n_points) : Iwan(p, fit_hyperbola(p.elements), {}, 0, n_points) {}

Iwan::Iwan(const IwanParameters &p, const Backbone &b, std::span<const double> numbers, std::size_t n_more,
           std::size_t n_points)
    : RowMaterial("iwan", checked_numbers(p, numbers), n_points,
                  elements + 5 * padded(p.elements) + (p.reconsolidation > 0 ? std::size_t(n_reconsolidation) : 0) +
                      n_more),
      parameters_(p), width_(padded(p.elements)), stride_(committed_.size() / std::max<std::size_t>(1, n_points)),
      extra_(elements + 5 * width_)
{
  bulk_per_shear_ = ElasticParameters{1.0, p.poisson_ratio}.bulk_modulus();
  weights_.assign(width_, 0.0); // padding bears nothing and yields never
  yields_.assign(width_, 1.0);
  for (std::size_t k = 0; k < b.weights.size(); ++k)
    {
      weights_[k] = b.weights[k];
      yields_[k] = p.strength_ratio * b.weights[k] * b.yield_strains[k];
    }
  increments_.resize(n_points);
  const double s = -p.reference_pressure;
  Iwan::set_initial_stress(std::vector<Stress>(n_points, Stress{s, s, s, 0, 0, 0}));
}

double Iwan::reference_strain(double p) const { return parameters_.strength_ratio * p / shear_modulus(p); }
double Iwan::mean_pressure(std::size_t i) const { return committed_[i * stride_ + pressure]; }
double Iwan::loosening(std::size_t i) const { return committed_[i * stride_ + loose]; }

/// (25) integrated: d p / K
double Iwan::compression(double from, double to) const
{
  const double n = parameters_.exponent, softest = bulk_per_shear_ * shear_modulus(to) * std::pow(to, -n);
  return (n == 1 ? std::log(to / from) : (std::pow(to, 1 - n) - std::pow(from, 1 - n)) / (1 - n)) / softest;
}

void Iwan::set_initial_stress(std::span<const Stress> effective)
{
  assert(effective.size() == n_points());
  std::vector<double> states(committed_.size(), 0.0);
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const Stress &t = effective[i];
      const double p = -(t[0] + t[1] + t[2]) / 3;
      const Shear s{(t[0] - t[1]) / 2, (2 * t[2] - t[0] - t[1]) / (2 * std::numbers::sqrt3), t[3], t[4], t[5]};
      const double size = std::sqrt(s[0] * s[0] + s[1] * s[1] + s[2] * s[2] + s[3] * s[3] + s[4] * s[4]);
      if (!(p > 0) || !std::isfinite(p))
        throw InputError(at_point(i) + "initial mean effective stress = " + std::to_string(p) +
                         " Pa; must be above 0 (compression); give the surface a load");
      if (!(size <= parameters_.strength_ratio * p))
        throw InputError(
            fmt::format("{}initial stress ratio = {:.4g}; must not be above strength_ratio, {:.4g}; choose k0 "
                        "nearer to 1",
                        at_point(i), size / p, parameters_.strength_ratio));
      double *state = &states[i * stride_];
      state[pressure] = p;
      state[floor_pressure] = std::min(p, std::max(parameters_.residual_ratio * p, parameters_.min_pressure));
      share_out(s, p, state);
      if (parameters_.reconsolidation > 0)
        state[extra_ + initial_pressure] = p;
    }
  committed_ = std::move(states);
  has_trial_ = false;
}

/// Virgin loading to the shear t under normal stresses n: each element has the share w_k x_k of n and, of t, what
/// min(w_k G gamma, what its strength leaves next to n) gives; the sum over all is t. In that sum, gamma runs from one
/// yield to the next.
void Iwan::share_out(const Shear &s, double p, double *state) const
{
  const std::size_t n = parameters_.elements;
  const double normal = s[0] * s[0] + s[1] * s[1], shear = std::sqrt(s[2] * s[2] + s[3] * s[3] + s[4] * s[4]);
  const double ratio = parameters_.strength_ratio;
  const double left = std::sqrt(std::max(0.0, 1 - normal / (ratio * p * ratio * p))); // of an element's strength
  std::vector<double> part(n, 0.0);
  double slope = 1, borne = 0; // of the elements that do not yield, shear of those that do
  for (std::size_t k = 0; shear > 0 && k < n; ++k)
    {
      const double yields = left * p * yields_[k];
      if (const double x = (shear - borne) / slope; weights_[k] * x <= yields || k + 1 == n) // x is G gamma
        {
          for (std::size_t j = k; j < n; ++j)
            part[j] = std::min(weights_[j] * x, left * p * yields_[j]);
          break;
        }
      part[k] = yields;
      borne += yields;
      slope -= weights_[k];
    }
  for (int c = 0; c < 5; ++c)
    {
      state[deviator + c] = s[c];
      for (std::size_t k = 0; k < n; ++k)
        state[elements + c * width_ + k] =
            c < 2 ? s[c] * (yields_[k] / ratio) : (shear > 0 ? s[c] / shear * part[k] : 0);
    }
}

void Iwan::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  assert(increments.size() == n_points() && stresses.size() == n_points());
  has_trial_ = false;
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      double *to = &trial_[i * stride_];
      integrate(&committed_[i * stride_], increment(increments[i], i), to);
      stresses[i] = stress(to);
      increments_[i] = increments[i];
    }
  has_trial_ = true;
}

void Iwan::stiffness(std::span<Stiffness> tangents) const
{
  for (std::size_t i = 0; i < n_points(); ++i)
    tangents[i] = tangent(i);
}

void Iwan::wave_moduli(std::span<WaveModuli> moduli) const
{
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const double shear = shear_modulus(mean_pressure(i));
      moduli[i] = {(bulk_per_shear_ + 4.0 / 3.0) * shear, shear};
    }
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/iwan_curve.hpp"

#include "fem/material/elastic.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double sqrt3 = std::numbers::sqrt3;

double pressure_of(const Stress &s) { return -(s[0] + s[1] + s[2]) / 3; }

/// What the state of a material with this backbone must agree on, besides the parameters of Iwan.
std::vector<double> numbers_of(const Backbone &backbone, const std::optional<LoopReduction> &reduction)
{
  std::vector<double> numbers = backbone.weights;
  numbers.insert(numbers.end(), backbone.yield_strains.begin(), backbone.yield_strains.end());
  if (reduction)
    numbers.insert(numbers.end(), {reduction->p1, reduction->p2, reduction->p3});
  return numbers;
}
} // namespace

IwanOfCurve::IwanOfCurve(const IwanParameters &parameters, const Backbone &backbone,
                         const std::optional<LoopReduction> &reduction, std::size_t n_points)
    : Iwan(parameters, backbone, numbers_of(backbone, reduction), reduction ? all : strain_now, n_points),
      reduction_(reduction), n_more_(reduction ? all : strain_now)
{}

double IwanOfCurve::virgin_stress(double strain, double pressure) const
{
  const double shear = shear_modulus(pressure);
  double sum = 0;
  for (std::size_t k = 0; k < width_; ++k)
    sum += std::min(weights_[k] * shear * strain, pressure * yields_[k]);
  return sum;
}

double IwanOfCurve::virgin_strain(double stress, double pressure) const
{
  double low = stress / shear_modulus(pressure), high = 2 * low; // exact while no element yields
  while (high < 1e3 && virgin_stress(high, pressure) < stress)
    high *= 2;
  for (int k = 0; k < 60 && virgin_stress(low, pressure) < stress; ++k)
    (virgin_stress((low + high) / 2, pressure) < stress ? low : high) = (low + high) / 2;
  return low;
}

IwanOfCurve::Loop IwanOfCurve::loop(double strain, double p) const
{
  const double shear = shear_modulus(p), secant = strain > 0 ? virgin_stress(strain, p) / strain : shear;
  return {reduction_->factor(secant / shear), secant};
}

void IwanOfCurve::set_initial_stress(std::span<const Stress> effective)
{
  std::vector<Stress> borne(effective.begin(), effective.end()); // by the elements
  for (Stress &s : borne)
    s[0] = s[1] = s[2] = -pressure_of(s);
  Iwan::set_initial_stress(borne);
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const Stress &s = effective[i];
      const double p = pressure_of(s), shear = std::hypot(s[3], s[4], s[5]);
      double *kept = more(committed_, i);
      kept[normal] = (s[0] - s[1]) / 2;
      kept[normal + 1] = (2 * s[2] - s[0] - s[1]) / (2 * sqrt3);
      if (!reduction_)
        continue;
      kept[largest] = virgin_strain(shear, p);
      for (int c = 0; c < 3; ++c)
        kept[strain_now + 2 + c] = shear > 0 ? s[3 + c] / shear * kept[largest] : 0;
    }
}

void IwanOfCurve::trial(std::span<const Gradient> increments, std::span<Stress> stresses)
{
  Iwan::trial(increments, stresses);
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const double *from = more(committed_, i);
      double *to = more(trial_, i);
      Stress &s = stresses[i];
      const double p = pressure_of(s);
      Shear borne{(s[0] - s[1]) / 2, (2 * s[2] - s[0] - s[1]) / (2 * sqrt3), s[3], s[4], s[5]};
      std::copy(from, from + n_more_, to);
      if (reduction_)
        {
          const auto d = strain(increments[i]);
          const Shear added{d[0] - d[1], (2 * d[2] - d[0] - d[1]) / sqrt3, d[3], d[4], d[5]};
          double square = 0;
          for (int c = 0; c < 5; ++c)
            {
              to[strain_now + c] += added[c];
              square += to[strain_now + c] * to[strain_now + c];
            }
          to[largest] = std::max(from[largest], std::sqrt(square));
          const Loop now = loop(to[largest], p);
          for (int c = 0; c < 5; ++c)
            borne[c] = now.factor * borne[c] + (1 - now.factor) * now.secant * to[strain_now + c];
        }
      const double left = std::min(1.0, parameters_.strength_ratio * p / std::hypot(to[normal], to[normal + 1]));
      to[normal] *= left;
      to[normal + 1] *= left;
      const double a = borne[0] + to[normal], b = (borne[1] + to[normal + 1]) / sqrt3;
      s = {a - b - p, -a - b - p, 2 * b - p, borne[2], borne[3], borne[4]};
    }
}

void IwanOfCurve::stiffness(std::span<Stiffness> tangents) const
{
  using Row = Eigen::Matrix<double, 1, 6>;
  using Column = Eigen::Matrix<double, 6, 1>;
  Iwan::stiffness(tangents);
  if (!has_trial_)
    return;
  const Column mean = (Column() << 1, 1, 1, 0, 0, 0).finished() / 3;
  for (std::size_t i = 0; i < n_points(); ++i)
    {
      const double *from = more(committed_, i), *to = more(trial_, i), *state = &trial_[i * stride_];
      const double p = state[pressure];
      Shear by_pressure{};
      for (int c = 0; c < 2; ++c)
        by_pressure[c] = to[normal + c] != from[normal + c] ? to[normal + c] / p : 0;
      Stiffness &c = tangents[i];
      const Row of_strain = -mean.transpose() * c; // dp'
      if (reduction_ && to[largest] == from[largest])
        {
          const double step = 1e-6 * p;
          const Loop now = loop(to[largest], p), then = loop(to[largest], p + step);
          for (int k = 0; k < 5; ++k)
            by_pressure[k] += ((then.factor - now.factor) * state[deviator + k] +
                               ((1 - then.factor) * then.secant - (1 - now.factor) * now.secant) * to[strain_now + k]) /
                              step;
          c += (1 - now.factor) * (isotropic_stiffness(0, now.secant) - (c + 3 * mean * of_strain).eval());
        }
      const double a = by_pressure[0], b = by_pressure[1] / sqrt3;
      c += (Column() << a - b, -a - b, 2 * b, by_pressure[2], by_pressure[3], by_pressure[4]).finished() * of_strain;
    }
}
} // namespace isostat

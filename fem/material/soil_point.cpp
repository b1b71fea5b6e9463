// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/soil_point.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double half_second = 0.5;   // half a cycle of 1 Hz
constexpr double longest_step = 2e-5; // strain; a sub-step of Iwan
constexpr double most_strain = 0.2;   // |gamma| that ends a cyclic test; a step that finds no vertical stress

Gradient gradient(double gamma, double vertical) { return {0, 0, gamma, 0, 0, 0, 0, 0, vertical}; }

/// x with |f(x)| <= error of a rising f: brackets it from 0 by doubled steps, then regula falsi (Illinois).
/// @throws RunFailure  none within most_strain
template <class Function>
double root(const Function &f, double step, double error)
{
  double low = 0, f_low = f(low);
  if (std::abs(f_low) <= error)
    return low;
  step *= f_low < 0 ? 1 : -1;
  double high = step, f_high = f(high);
  while (f_low * f_high > 0 && std::abs(f_high) > error)
    {
      low = high, f_low = f_high;
      high += step *= 2, f_high = f(high);
      if (!(std::abs(step) < most_strain))
        throw RunFailure("element test: no strain gives the vertical stress");
    }
  for (int side = 0, k = 0; std::abs(f_high) > error && k < 100; ++k)
    {
      const double x = high - f_high * (high - low) / (f_high - f_low), f_x = f(x);
      if (f_x * f_high < 0)
        low = std::exchange(high, x), f_low = std::exchange(f_high, f_x), side = 0;
      else
        high = x, f_high = f_x, f_low *= side++ > 0 ? 0.5 : 1;
    }
  return high;
}
} // namespace

SoilPoint::SoilPoint(std::unique_ptr<Material> material, const Stress &in_situ)
    : material_(std::move(material)), stress_(in_situ)
{
  material_->set_initial_stress({&in_situ, 1});
}

double SoilPoint::shear_modulus() const
{
  WaveModuli moduli;
  material_->wave_moduli({&moduli, 1});
  return moduli.s;
}

SoilPoint::Row SoilPoint::row() const
{
  return {strain_[4], stress_[4], -stress_[2], -(stress_[0] + stress_[1] + stress_[2]) / 3,
          -(strain_[0] + strain_[1] + strain_[2])};
}

Stress SoilPoint::tried(const Gradient &h)
{
  Stress stress;
  material_->trial({&h, 1}, {&stress, 1});
  return stress;
}

void SoilPoint::deform(const Gradient &h)
{
  stress_ = tried(h);
  material_->commit();
  const auto more = isostat::strain(h);
  for (std::size_t k = 0; k < more.size(); ++k)
    strain_[k] += more[k];
}

/// @param vertical  sigma_zz of drained shear
void SoilPoint::shear_once(double gamma, bool drained, double vertical)
{
  const auto off = [&](double strain) { return tried(gradient(gamma, strain))[2] - vertical; };
  deform(gradient(gamma, drained ? root(off, 0.1 * std::abs(gamma), 1e-6 * std::abs(vertical)) : 0));
}

void SoilPoint::shear(double gamma, unsigned steps, bool drained, std::vector<Row> *path)
{
  const double vertical = stress_[2];
  material_->set_time_step(half_second / steps);
  for (unsigned k = 0; k < steps; ++k)
    {
      const double begin = std::numbers::pi * k / steps, end = std::numbers::pi * (k + 1) / steps;
      shear_once(gamma * (std::cos(begin) - std::cos(end)) / 2, drained, vertical);
      if (path)
        path->push_back(row());
    }
}

bool SoilPoint::shear_to(double tau, bool drained, double limit, std::vector<Row> *path)
{
  const double vertical = stress_[2], sign = tau < stress_[4] ? -1 : 1, error = 1e-5 * std::abs(vertical);
  material_->set_time_step(0);
  while (sign * (tau - stress_[4]) > error)
    {
      if (sign * strain_[4] >= limit)
        return false;
      double step = sign * longest_step;
      if (const double beyond = sign * (tried(gradient(step, 0))[4] - tau); beyond > 0)
        step *= root([&](double part) { return sign * (tried(gradient(part * step, 0))[4] - tau); }, 1.0, error);
      shear_once(step, drained, vertical);
      if (path)
        path->push_back(row());
    }
  return true;
}

void SoilPoint::compress_to(double vertical, std::vector<Row> *path)
{
  const double sign = vertical > -stress_[2] ? -1 : 1; // of eps_zz
  material_->set_time_step(0);
  const double error = 1e-6 * std::max(vertical, std::abs(stress_[2]));
  for (double gone = 0; sign * (stress_[2] + vertical) < -error; gone += longest_step)
    {
      if (gone > most_strain)
        throw RunFailure("element test: no compression gives the vertical stress");
      double step = sign * longest_step;
      if (sign * (tried(gradient(0, step))[2] + vertical) > 0)
        step *= root([&](double part) { return sign * (tried(gradient(0, part * step))[2] + vertical); }, 1.0, error);
      deform(gradient(0, step));
      if (path)
        path->push_back(row());
    }
}

SoilPoint::Cycles SoilPoint::cyclic_shear(double tau, double max_cycles, double more, std::vector<Row> *path)
{
  const double vertical = stress_[2];
  Cycles cycles;
  std::vector<Row> rows;
  double begun = 0, end = max_cycles; // cycles
  for (double part = 0.25, target = tau; begun < end; begun += part, part = 0.5, target = -target)
    {
      const double start = stress_[4];
      rows.clear();
      const bool reached = shear_to(target, false, most_strain, &rows);
      for (const Row &row : rows)
        {
          cycles.largest_strain = std::max(cycles.largest_strain, std::abs(row[0]));
          const bool liquefied = 1 + row[2] / vertical >= liquefied_ratio || std::abs(row[0]) >= liquefied_strain;
          if (!liquefied || std::isfinite(cycles.to_liquefaction))
            continue;
          cycles.to_liquefaction = begun + part * (row[1] - start) / (target - start);
          end = cycles.to_liquefaction + more;
        }
      if (path)
        path->insert(path->end(), rows.begin(), rows.end());
      if (!reached)
        break;
    }
  return cycles;
}
} // namespace isostat

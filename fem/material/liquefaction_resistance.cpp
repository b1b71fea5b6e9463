// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/liquefaction_resistance.hpp"

#include "base/error.hpp"
#include "fem/material/soil_point.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
namespace
{
constexpr double one_atmosphere = 101325; // Pa

/// D_r.
double cone_density(double q) { return 0.478 * std::pow(q, 0.264) - 1.063; }
} // namespace

double blow_count(const SandDensity &density)
{
  if (density.n1_60cs)
    return *density.n1_60cs;
  const double relative = density.qc1ncs ? cone_density(*density.qc1ncs) : *density.relative_density;
  return 46 * relative * relative;
}

double reference_resistance(const SandDensity &density)
{
  if (density.qc1ncs)
    {
      const double q = *density.qc1ncs;
      return std::exp(q / 113 + std::pow(q / 1000, 2) - std::pow(q / 140, 3) + std::pow(q / 137, 4) - 2.8);
    }
  const double n = blow_count(density);
  return std::exp(n / 14.1 + std::pow(n / 126, 2) - std::pow(n / 23.6, 3) + std::pow(n / 25.4, 4) - 2.8);
}

double overburden_factor(const SandDensity &density, double vertical)
{
  const double slope = 1 / (density.qc1ncs ? 37.3 - 8.27 * std::pow(*density.qc1ncs, 0.264)
                                           : 18.9 - 2.55 * std::sqrt(blow_count(density)));
  return std::min(1.1, 1 - std::min(0.3, slope) * std::log(vertical / one_atmosphere));
}

double resistance(const SandDensity &density, double vertical)
{
  return reference_resistance(density) * overburden_factor(density, vertical);
}

double cycles_exponent(const SandDensity &density)
{
  const double largest = std::min(
      2.2, 1.09 + (density.qc1ncs ? std::pow(*density.qc1ncs / 180, 3) : std::pow(blow_count(density) / 26, 2)));
  return std::clamp(std::log(largest / 0.65) / std::log(reference_cycles / 0.75), 0.2, 0.4);
}

double reconsolidation_factor(const SandDensity &density)
{
  return 1.5 * std::exp(density.qc1ncs ? 2.551 - 1.147 * std::pow(*density.qc1ncs, 0.264)
                                       : -0.369 * std::sqrt(blow_count(density)));
}

IwanParameters resisting(const IwanParameters &given, const SandDensity &density, const Stress &in_situ,
                         const std::function<std::unique_ptr<Material>(const IwanParameters &)> &make)
{
  IwanParameters sand = given;
  if (!density.given())
    return sand;
  const double ratio = resistance(density, -in_situ[2]);
  sand.contraction_exponent = 1 / cycles_exponent(density) - 2;
  sand.reconsolidation = reconsolidation_factor(density);
  const double denser = std::clamp((blow_count(density) - 15) / 5, 0.0, 1.0);
  sand.fabric_limit *= std::pow(12.5, denser);
  sand.fabric_rate *= std::pow(0.15, denser);
  const auto liquefies_with = [&](double contraction) {
    sand.contraction = contraction;
    SoilPoint point(make(sand), in_situ);
    return point.cyclic_shear(-ratio * in_situ[2], reference_cycles).to_liquefaction <= reference_cycles;
  };
  if (ratio >= sand.strength_ratio * (in_situ[0] + in_situ[1] + in_situ[2]) / (3 * in_situ[2]))
    {
      sand.contraction = 0;
      return sand;
    }
  constexpr double least = 1e-4, most = 1e4, factor = 4;
  double high = 1;
  if (liquefies_with(high))
    while (high > least && liquefies_with(high / factor))
      high /= factor;
  else
    while (high < most && !liquefies_with(high *= factor))
      ;
  if (high >= most)
    throw InputError(fmt::format("no contraction gives it a cyclic resistance of {:.3g} at {:.3g} kPa; give a lower "
                                 "strength_ratio, or a higher phase_transformation_ratio",
                                 ratio, -in_situ[2] / 1e3));
  if (high <= least) // near its strength
    {
      sand.contraction = 0;
      return sand;
    }
  for (double low = high / factor; high / low > 1.01;)
    if (const double middle = std::sqrt(low * high); liquefies_with(middle))
      high = middle;
    else
      low = middle;
  const std::string digits = fmt::format("{:.3g}", high);
  std::from_chars(digits.data(), digits.data() + digits.size(), sand.contraction);
  return sand;
}
} // namespace isostat

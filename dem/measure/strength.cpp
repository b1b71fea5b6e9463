// SPDX-License-Identifier: BSD-3-Clause
#include "dem/measure/strength.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isostat
{
namespace
{
constexpr double mean_share = 0.01, slope_share = 0.05; ///< of the strain of the stage
constexpr double degrees = 180 / std::numbers::pi;

struct Rows
{
  std::size_t begin, end;
};

/// The rows within half a width of one, at least one to each side.
Rows rows_about(const std::vector<double> &x, std::size_t at, double width)
{
  Rows rows{at > 0 ? at - 1 : 0, std::min(at + 2, x.size())};
  while (rows.begin > 0 && std::abs(x[rows.begin - 1] - x[at]) <= 0.5 * width)
    --rows.begin;
  while (rows.end < x.size() && std::abs(x[rows.end] - x[at]) <= 0.5 * width)
    ++rows.end;
  return rows;
}

double mean(const std::vector<double> &y, Rows rows)
{
  double sum = 0;
  for (std::size_t i = rows.begin; i < rows.end; ++i)
    sum += y[i];
  return sum / static_cast<double>(rows.end - rows.begin);
}

/// Of the line of least squares; 0 where x stands still.
double slope(const std::vector<double> &x, const std::vector<double> &y, Rows rows)
{
  const double x0 = mean(x, rows), y0 = mean(y, rows);
  double xx = 0, xy = 0;
  for (std::size_t i = rows.begin; i < rows.end; ++i)
    xx += (x[i] - x0) * (x[i] - x0), xy += (x[i] - x0) * (y[i] - y0);
  return xx > 0 ? xy / xx : 0;
}
} // namespace

double friction_angle(double stress_ratio)
{
  const double eta = std::abs(stress_ratio), sine = 3 * eta / (stress_ratio >= 0 ? 6 + eta : 6 - eta);
  return degrees * std::asin(std::min(sine, 1.0));
}

double dilatancy_angle(double rate) { return degrees * std::asin(std::clamp(rate / (2 + rate), -1.0, 1.0)); }

DrainedStrength drained_strength(const DrainedPath &path)
{
  DrainedStrength found;
  const std::size_t n = path.axial.size();
  if (n < 2 || path.axial.back() == path.axial.front())
    return found;
  const double strain = path.axial.back() - path.axial.front(), span = std::abs(strain);
  const double direction = strain > 0 ? 1 : -1;
  found.most_contracted = path.volumetric[0];
  found.contracted_strain = path.axial[0];
  found.dilatancy_rate = -1e300;
  for (std::size_t i = 0; i < n; ++i)
    {
      const double ratio = mean(path.stress_ratio, rows_about(path.axial, i, mean_share * span));
      if (std::abs(ratio) > std::abs(found.peak_ratio))
        found.peak_ratio = ratio, found.peak_strain = path.axial[i];
      if (path.volumetric[i] > found.most_contracted)
        found.most_contracted = path.volumetric[i], found.contracted_strain = path.axial[i];
      const double rate =
          -direction * slope(path.axial, path.volumetric, rows_about(path.axial, i, slope_share * span));
      const bool whole = std::min(std::abs(path.axial[i] - path.axial[0]),
                                  std::abs(path.axial[n - 1] - path.axial[i])) >= 0.5 * slope_share * span;
      if (whole && rate > found.dilatancy_rate)
        found.dilatancy_rate = rate, found.dilatancy_strain = path.axial[i];
    }
  if (found.dilatancy_rate == -1e300) // too few rows for a whole window: the mean of all
    found.dilatancy_rate = -direction * slope(path.axial, path.volumetric, {0, n});
  found.end_ratio = mean(path.stress_ratio, rows_about(path.axial, n - 1, 2 * mean_share * span));
  found.end_volumetric = path.volumetric.back();
  found.peak_friction = friction_angle(found.peak_ratio);
  found.end_friction = friction_angle(found.end_ratio);
  if (direction > 0)
    found.dilatancy = dilatancy_angle(found.dilatancy_rate);
  return found;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#include "dem/prepare/grading.hpp"

#include "base/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace isostat
{
namespace
{
/// As measured: they need not reach 0 and 100 %.
const std::map<std::string, GradingCurve> &built_in_curves()
{
  static const std::map<std::string, GradingCurve> curves = {
      {"karlsruhe-fine-sand",
       {{0.0631e-3, 0.0795e-3, 0.1002e-3, 0.1249e-3, 0.1581e-3, 0.2441e-3, 0.3135e-3},
        {1.53, 4.83, 11.96, 28.24, 84.99, 99.75, 100}}}};
  return curves;
}

GradingCurve curve_by_name(const std::string &name)
{
  const auto &curves = built_in_curves();
  if (const auto found = curves.find(name); found != curves.end())
    return found->second;
  std::string known;
  for (const auto &[other, curve] : curves)
    known += (known.empty() ? "\"" : ", \"") + other + "\"";
  throw InputError(fmt::format("grading.curve = \"{}\"; known curves are {}. Take one of them or give "
                               "grading.table = [[diameter, percent finer], ...].",
                               name, known));
}

GradingCurve checked_table(const std::vector<std::pair<double, double>> &table)
{
  if (table.size() < 2)
    throw InputError(fmt::format("grading.table has {} point; must have two or more because mass lies between points. "
                                 "For nearly equal grains give two diameters 1 % apart.",
                                 table.size()));
  GradingCurve curve;
  for (std::size_t i = 0; i < table.size(); ++i)
    {
      const auto [diameter, percent] = table[i];
      const double finer_diameter = i ? table[i - 1].first : 0.0;
      const double finer_percent = i ? table[i - 1].second : 0.0;
      if (!(diameter > finer_diameter) || !std::isfinite(diameter))
        throw InputError(fmt::format("grading.table[{}]: diameter = {:g} m; must be above {:g} m because points are "
                                     "listed from fine to coarse, each diameter once. Sort the table.",
                                     i, diameter, finer_diameter));
      if (!(percent >= 0 && percent <= 100))
        throw InputError(
            fmt::format("grading.table[{}]: percent finer = {:g}; must be in [0, 100] because it is a part "
                        "of the mass. Give percent, not a fraction.",
                        i, percent));
      if (percent < finer_percent)
        throw InputError(
            fmt::format("grading.table[{}]: percent finer = {:g} after {:g}; must not fall because it is a "
                        "cumulative mass. Give percent passing, not percent retained.",
                        i, percent, finer_percent));
      curve.diameter.push_back(diameter);
      curve.percent_finer.push_back(percent);
    }
  return curve;
}

/// Diameter (m) at `percent` in segment k: log-linear, and exact at both ends.
double interpolated_diameter(const GradingCurve &curve, std::size_t k, double percent)
{
  const double p0 = curve.percent_finer[k], p1 = curve.percent_finer[k + 1];
  const double d0 = curve.diameter[k], d1 = curve.diameter[k + 1];
  if (percent >= p1)
    return d1;
  return percent <= p0 ? d0 : d0 * std::pow(d1 / d0, (percent - p0) / (p1 - p0));
}

/// Limits of what is kept of a curve, % of its mass.
struct Cut
{
  double fine, coarse;
};

Cut effective_cut(const GradingSpec &spec, const GradingCurve &given)
{
  const double fine = spec.finest_percent, coarse = spec.coarsest_percent;
  if (!(fine >= 0 && fine < 100))
    throw InputError(fmt::format("grading.finest_percent = {:g}; must be in [0, 100) because it is percent finer by "
                                 "mass. 0 keeps all fines.",
                                 fine));
  if (!(coarse > fine && coarse <= 100))
    throw InputError(fmt::format("grading.coarsest_percent = {:g}; must be in ({:g}, 100] because it is percent finer "
                                 "by mass, above finest_percent. 100 keeps the coarsest grains.",
                                 coarse, fine));
  const Cut cut = {std::max(fine, given.percent_finer.front()), std::min(coarse, given.percent_finer.back())};
  if (!(cut.coarse - cut.fine > 1e-9)) // less cannot be distinguished from round-off
    throw InputError(fmt::format("grading: nothing is left between finest_percent = {:g} and coarsest_percent = {:g}; "
                                 "the points of the curve cover {:g} ... {:g} %. Widen the cut.",
                                 fine, coarse, given.percent_finer.front(), given.percent_finer.back()));
  return cut;
}

GradingCurve cut_and_rescaled(const GradingCurve &given, const Cut &cut)
{
  const auto &p = given.percent_finer;
  // last point not above the fine cut, first point not below the coarse one: level ends of the curve hold no mass
  const std::size_t first = std::upper_bound(p.begin(), p.end(), cut.fine) - p.begin() - 1;
  const std::size_t last = std::lower_bound(p.begin(), p.end(), cut.coarse) - p.begin();
  const double start = interpolated_diameter(given, first, cut.fine);
  const double end = interpolated_diameter(given, last - 1, cut.coarse);
  GradingCurve kept = {{start}, {0}};
  for (std::size_t i = first + 1; i < last; ++i)
    if (given.diameter[i] > start && given.diameter[i] < end) // a cut within round-off of a point replaces it
      {
        kept.diameter.push_back(given.diameter[i]);
        kept.percent_finer.push_back(100 * (p[i] - cut.fine) / (cut.coarse - cut.fine));
      }
  kept.diameter.push_back(end);
  kept.percent_finer.push_back(100);
  return kept;
}

double inverse_cube(double d) { return 1.0 / (d * d * d); }
} // namespace

GradingCurve grading_curve(const GradingSpec &spec)
{
  const GradingCurve given = spec.table.empty() ? curve_by_name(spec.curve) : checked_table(spec.table);
  return cut_and_rescaled(given, effective_cut(spec, given));
}

double d_at(const GradingCurve &curve, double percent)
{
  if (!(percent >= 0 && percent <= 100))
    throw InputError(
        fmt::format("d_at: percent finer = {:g}; must be in [0, 100] because it is a part of the mass.", percent));
  const auto &p = curve.percent_finer;
  const std::size_t next = std::lower_bound(p.begin() + 1, p.end() - 1, percent) - p.begin();
  return interpolated_diameter(curve, next - 1, percent);
}

double uniformity_coefficient(const GradingCurve &curve) { return d_at(curve, 60) / d_at(curve, 10); }

std::vector<double> sample_diameters(const GradingCurve &curve, std::size_t n)
{
  if (n == 0)
    throw InputError("grading.grains = 0; must be 1 or more because a specimen is made of grains.");
  const auto &d = curve.diameter;
  const std::size_t n_segments = d.size() - 1;
  std::vector<double> number(n_segments); // of grains in a segment, times pi/2 rho; only ratios matter
  double total = 0;
  for (std::size_t k = n_segments; k-- > 0;)
    {
      const double mass = curve.percent_finer[k + 1] - curve.percent_finer[k];
      number[k] = mass / std::log(d[k + 1] / d[k]) * (inverse_cube(d[k]) - inverse_cube(d[k + 1]));
      total += number[k];
    }
  std::vector<double> sample(n);
  std::size_t k = n_segments - 1;
  double coarser = 0; // number in the segments above k
  for (std::size_t i = 0; i < n; ++i)
    {
      const double target = (static_cast<double>(i) + 0.5) / static_cast<double>(n) * total;
      while (k > 0 && target >= coarser + number[k])
        coarser += number[k--];
      const double fraction = std::min(1.0, (target - coarser) / number[k]);
      const double coarse = inverse_cube(d[k + 1]), fine = inverse_cube(d[k]);
      sample[i] = 1.0 / std::cbrt(coarse + fraction * (fine - coarse));
    }
  return sample;
}

double upscaling_factor(const std::vector<double> &diameters, double solid_volume)
{
  double sum = 0;
  for (double d : diameters)
    sum += d * d * d;
  return std::cbrt(solid_volume / (std::numbers::pi / 6.0 * sum));
}
} // namespace isostat

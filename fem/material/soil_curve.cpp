// SPDX-License-Identifier: BSD-3-Clause
#include "fem/material/soil_curve.hpp"

#include "base/files/csv_table.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
double SoilCurve::at(std::span<const double> values, double strain) const
{
  if (strain <= strains.front())
    return values.front();
  if (strain >= strains.back())
    return values.back();
  const std::size_t n = strains.size(),
                    k = static_cast<std::size_t>(std::ranges::upper_bound(strains, strain) - strains.begin()) - 1;
  const auto width = [&](std::size_t j) { return std::log(strains[j + 1] / strains[j]); };
  const auto chord = [&](std::size_t j) { return (values[j + 1] - values[j]) / width(j); };
  // slope at a point of the table: harmonic mean of those of the chords next to it
  const auto slope = [&](std::size_t j) {
    if (j == 0 || j + 1 == n)
      return chord(j == 0 ? 0 : n - 2);
    const double a = chord(j - 1), b = chord(j), h = width(j - 1), g = width(j);
    return a * b > 0 ? 3 * (h + g) / ((2 * g + h) / a + (g + 2 * h) / b) : 0;
  };
  const double h = width(k), t = std::log(strain / strains[k]) / h, u = 1 - t;
  return values[k] * u * u * (1 + 2 * t) + values[k + 1] * t * t * (3 - 2 * t) +
         h * t * u * (u * slope(k) - t * slope(k + 1));
}

SoilCurve read_soil_curve(const std::filesystem::path &path)
{
  const std::string text = read_text(path), first(split_lines(text).empty() ? "" : split_lines(text).front());
  std::vector<std::string> columns = {"strain (-)", "G/G_max (-)"};
  if (std::ranges::count(CsvHeader(path, first).columns, "damping (-)"))
    columns.push_back("damping (-)");
  const CsvTable table(path, columns);
  if (table.n_rows() < 3)
    reject(path, 2, fmt::format("the curve has {} rows; give 3 or more", table.n_rows()));
  SoilCurve curve;
  for (std::size_t i = 0; i < table.n_rows(); ++i)
    {
      const auto refuse = [&](std::size_t column, const char *rule) {
        reject(
            path, table.line(i),
            fmt::format("{} = {:g}; must {}; correct it or take the row out", columns[column], table(i, column), rule));
      };
      if (!(table(i, 0) > (i == 0 ? 0 : table(i - 1, 0))))
        refuse(0, "be above 0 and rise from row to row");
      if (!(table(i, 1) > 0 && table(i, 1) <= (i == 0 ? 1 : table(i - 1, 1))))
        refuse(1, "be in (0, 1] and not rise");
      curve.strains.push_back(table(i, 0));
      curve.reduction.push_back(table(i, 1));
      if (columns.size() == 2)
        continue;
      if (!(table(i, 2) >= 0 && table(i, 2) < 1))
        refuse(2, "be in [0, 1), a ratio of critical damping");
      curve.damping.push_back(table(i, 2));
    }
  return curve;
}
} // namespace isostat

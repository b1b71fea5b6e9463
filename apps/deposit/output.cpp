// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/output.hpp"

#include "fem/space/vtu.hpp"

namespace isostat
{
PointValues point_values(const ColumnInstant &instant, std::size_t q, std::span<const double> vertical_stress)
{
  const Gradient &h = instant.gradients[q];
  const Stress &s = instant.stresses[q];
  const double u = instant.pressure[q];
  return {h[2] + h[6], h[5] + h[7], -h[8], s[4], s[3], -s[2], mean_effective(s), u, u / vertical_stress[q]};
}

std::vector<double> columns_at(const ColumnInstant &instant, std::span<const std::size_t> points,
                               std::span<const double> vertical_stress)
{
  std::vector<double> values(points.size() * point_columns.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    {
      const PointValues row = point_values(instant, points[k], vertical_stress);
      for (std::size_t j = 0; j < row.size(); ++j)
        values[j * points.size() + k] = row[j];
    }
  return values;
}

void write_column_vtu(const std::filesystem::path &path, const FiniteElementSpace &space, const ColumnInstant &instant,
                      std::span<const double> vertical_stress)
{
  std::vector<PointField> fields;
  for (const auto &[name, unit] : point_columns)
    fields.push_back({name, {}});
  for (std::size_t q = 0; q < space.n_points(); ++q)
    {
      const PointValues row = point_values(instant, q, vertical_stress);
      for (std::size_t k = 0; k < row.size(); ++k)
        fields[k].values.push_back(row[k]);
    }
  write_vtu(path, space, {instant.time, instant.step},
            {{"displacement", instant.displacement}, {"velocity", instant.velocity}}, fields);
}

std::vector<double> along(int axis, const std::vector<Place> &places)
{
  std::vector<double> all;
  for (const Place &place : places)
    all.push_back(place[axis]);
  return all;
}

SeriesLayout profile_layout(std::vector<double> depths, std::vector<double> sigma_v0,
                            std::vector<double> shear_velocity)
{
  SeriesLayout layout;
  layout.format = "isostat-column-profiles";
  for (const auto &[name, unit] : point_columns)
    layout.series.push_back({name, unit, depths.size()});
  layout.constants = {{"depth", "m", std::move(depths)},
                      {"sigma_v0", "Pa", std::move(sigma_v0)},
                      {"shear_velocity", "m/s", std::move(shear_velocity)}};
  return layout;
}
} // namespace isostat

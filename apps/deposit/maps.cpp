// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/maps.hpp"

#include <numeric>

namespace isostat
{
namespace
{
constexpr std::size_t anticlockwise[] = {0, 1, 3, 2}; ///< corners of an element, which have x fastest

std::vector<double> depths(const FiniteElementSpace &space)
{
  std::vector<double> all;
  for (const Place &place : space.position)
    all.push_back(space.mesh().depth(place));
  return all;
}

/// f(element, its corner) for all corners of all elements.
template <typename F>
void for_each_corner(const FiniteElementSpace &space, const F &f)
{
  for (std::size_t cell = 0; cell < space.n_cells(); ++cell)
    for (std::size_t corner : anticlockwise)
      f(cell, corner);
}

SeriesLayout layout_of(const FiniteElementSpace &space, std::span<const double> vertical_stress,
                       std::span<const double> velocities, bool packings)
{
  std::vector<Place> corners;
  for_each_corner(space, [&](std::size_t cell, std::size_t k) { corners.push_back(space.corner[4 * cell + k]); });
  SeriesLayout layout = profile_layout(depths(space), {vertical_stress.begin(), vertical_stress.end()},
                                       {velocities.begin(), velocities.end()});
  for (const char *name : {"displacement_x", "displacement_y", "displacement_z"})
    layout.series.push_back({name, "m", corners.size()});
  layout.series.push_back({"sigma_x", "Pa", space.n_points()});
  if (packings)
    layout.series.push_back({"redundancy", "-", space.n_points()});
  layout.constants.push_back({"x", "m", along(0, space.position)});
  layout.constants.push_back({"z", "m", along(2, space.position)});
  layout.constants.push_back({"corner_x", "m", along(0, corners)});
  layout.constants.push_back({"corner_z", "m", along(2, corners)});
  return layout;
}
} // namespace

BoxMaps::BoxMaps(const std::filesystem::path &path, const FiniteElementSpace &space,
                 std::span<const double> vertical_stress, std::span<const double> velocities, std::size_t resume_rows,
                 bool packings)
    : space_(space), vertical_stress_(vertical_stress), points_(space.n_points()),
      file_(path, layout_of(space, vertical_stress, velocities, packings), resume_rows)
{
  std::iota(points_.begin(), points_.end(), 0);
}

void BoxMaps::append(const ColumnInstant &instant, std::span<const double> redundancy)
{
  std::vector<double> values = columns_at(instant, points_, vertical_stress_);
  for (unsigned axis : {0, 1, 2})
    for_each_corner(space_, [&](std::size_t cell, std::size_t corner) {
      values.push_back(space_.at_node(instant.displacement, cell, corner, axis));
    });
  for (const Stress &stress : instant.stresses)
    values.push_back(-stress[0]);
  values.insert(values.end(), redundancy.begin(), redundancy.end());
  file_.append(instant.time, values);
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "apps/deposit/output.hpp"

namespace isostat
{
/// The whole of a box at instants, in maps.h5: what profiles.h5 has, of every point of the mesh, their `x` and `z` (m),
/// and of each element's corners (anticlockwise) `corner_x`, `corner_z` (m) and, at each instant, `displacement_x`,
/// `displacement_z` (m). With packings `redundancy`, the index I_R of every point, not-a-number where there is none.
/// tested: tests/apps/box_test.py
class BoxMaps
{
public:
  /// @param vertical_stress, velocities  of every point, Pa, m/s   @pre the mesh is not shared out
  /// @throws as SeriesFile
  BoxMaps(const std::filesystem::path &path, const FiniteElementSpace &space, std::span<const double> vertical_stress,
          std::span<const double> velocities, std::size_t resume_rows, bool packings);

  /// @param redundancy  of every point, if there are packings
  void append(const ColumnInstant &instant, std::span<const double> redundancy);
  void flush() { file_.flush(); }

private:
  const FiniteElementSpace &space_;
  std::span<const double> vertical_stress_;
  std::vector<std::size_t> points_; ///< all
  SeriesFile file_;
};
} // namespace isostat

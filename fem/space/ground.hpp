// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <vector>

namespace isostat
{
/// The surface of soil that is not level, in the plane of x and z: straight between its points, level beyond the first
/// and the last one.   tested: tests/fem/space/ground_test.cpp
struct GroundLine
{
  std::vector<std::array<double, 2>> points; ///< x (rising) and height z above the base, m; none: level ground

  bool is_level() const { return points.empty(); }
  double at(double x) const; ///< z   @pre not level
  double highest() const;    ///< likewise
  /// @throws InputError  fewer than two points, x that do not rise, a height that is not positive
  void check() const;

  bool operator==(const GroundLine &) const = default;
};
} // namespace isostat

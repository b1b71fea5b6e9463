// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/packing.hpp"

namespace isostat
{
/// Rigid, frictionless box aligned with the axes: six planes at lower[k] and upper[k] (m). y is the axial direction of
/// an element test, x and z are lateral (DESIGN 2).
struct RigidBox
{
  Vec3 lower = Vec3::Zero();
  Vec3 upper = Vec3::Zero();

  Vec3 edges() const { return upper - lower; }
  Vec3 centre() const { return 0.5 * (lower + upper); }
  double volume() const { return edges().prod(); }
  /// Area of the wall normal to an axis, m2.
  double area(int axis) const { return edges()[(axis + 1) % 3] * edges()[(axis + 2) % 3]; }
};

/// Void ratio e = V / V_s - 1 [-].
inline double void_ratio(double volume, double solid_volume) { return volume / solid_volume - 1.0; }

/// Distance of a grain's surface from wall 0..5 (x-, x+, y-, y+, z-, z+), m; negative: it overlaps the wall.
inline double wall_gap(const Packing &packing, const RigidBox &box, std::size_t i, int wall)
{
  const double x = packing.position[4 * i + wall / 2];
  return (wall % 2 ? box.upper[wall / 2] - x : x - box.lower[wall / 2]) - packing.radius(i);
}
} // namespace isostat

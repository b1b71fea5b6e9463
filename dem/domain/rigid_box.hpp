// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/dem/drive/strain_path_test.cpp
#pragma once
#include "base/types.hpp"

namespace isostat
{
/// Rigid, frictionless box aligned with the axes: six planes at lower[k] and upper[k] (m). y is the axial direction of
/// an element test, x and z are lateral.
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
} // namespace isostat

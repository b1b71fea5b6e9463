// SPDX-License-Identifier: BSD-3-Clause
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
  static RigidBox about(const Vec3 &centre, const Vec3 &edges) { return {centre - 0.5 * edges, centre + 0.5 * edges}; }
  /// Box under a logarithmic strain along x, y, z, tension positive [-]: edge exp(strain) about the same centre. From
  /// the total strain, never from increments, its volume is V exp(sum) to round-off after any number of steps.
  RigidBox strained(const Vec3 &strain) const { return about(centre(), edges().array() * strain.array().exp()); }
  /// Area of the wall normal to an axis, m2.
  double area(int axis) const { return edges()[(axis + 1) % 3] * edges()[(axis + 2) % 3]; }
};

/// Strain of constant volume for an axial compression: (axial/2, -axial, axial/2); the sum is exactly 0.
inline Vec3 isochoric(double axial_compression)
{
  return {0.5 * axial_compression, -axial_compression, 0.5 * axial_compression};
}

/// Void ratio e = V / V_s - 1 [-].
inline double void_ratio(double volume, double solid_volume) { return volume / solid_volume - 1.0; }
} // namespace isostat

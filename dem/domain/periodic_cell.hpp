// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/fields.hpp"
#include "base/types.hpp"

#include <optional>

namespace isostat
{
/// Shift between periodic images, in whole cell edges, packed into one number: 10 bits for each edge.
using ImageCode = std::uint32_t;
inline constexpr int max_image = 511;
inline ImageCode image_code(const Eigen::Vector3i &shift)
{
  const auto part = [&](int k) { return static_cast<ImageCode>(shift[k] + max_image + 1) & 1023u; };
  return part(0) | part(1) << 10 | part(2) << 20;
}
inline Eigen::Vector3i image_shift(ImageCode code)
{
  const auto part = [&](int k) { return static_cast<int>(code >> (10 * k) & 1023u) - max_image - 1; };
  return {part(0), part(1), part(2)};
}

/// Periodic cell of a representative volume element under any velocity gradient:
///
///         c ____          x = deformation X + fluctuations; an image of a grain is at x + edges * (whole numbers)
///          /   /|
///         /___/ | b       own frame: turns with the mean rotation of the material,
///     a  |   |  /         so that all it ever sees is stretch; laboratory = rotation * own
///        |___| /
///
/// A step with displacement gradient H = L dt (laboratory) is split at mid-step (Hughes & Winget 1980,
/// doi:10.1002/nme.1620151210): with Q the rotation half a step on, E = sym(Q'HQ) stretches cell and grains by A = I +
/// E + E^2/2, and rotation <- rotation exp(skew). A rigid rotation thus changes no bit of grains and forces, and stress
/// turns with `rotation` alone. Volume is set, not accumulated: det(edges) = reference_volume exp(sum tr E), to
/// round-off after any number of steps. Inertia of the affine motion (L^2 x, L w) is left out: the element has no place
/// in space, and it is of the order of (rate * time step)^2.
/// tested: tests/dem/domain/periodic_cell_test.cpp
struct PeriodicCell
{
  Mat3 edges = Mat3::Identity();       ///< columns a, b, c, m, own frame
  Mat3 deformation = Mat3::Identity(); ///< of the material since the cell was made, own frame; flips leave it alone
  Mat3 rotation = Mat3::Identity();    ///< own frame -> laboratory
  Mat3 strain_step = Mat3::Zero();     ///< E of the last step, own frame, tension positive: what contacts slide by
  double volume_strain = 0;            ///< sum tr E = ln(V/V0) [-]
  double reference_volume = 1;         ///< V0, m3
  std::uint64_t flips = 0;             ///< how often the cell has been exchanged for a more upright one

  /// Right-angled cell.   @param lengths  m
  static PeriodicCell with_edges(const Vec3 &lengths);
  double volume() const { return edges.determinant(); }
  /// Distances between opposite faces, m.
  Vec3 widths() const;

  /// One step.   @param displacement_gradient  L dt, laboratory frame, not small against 1: at most 1 %
  /// @return A - I: how the step stretches positions, own frame
  Mat3 deform(const Mat3 &displacement_gradient);

  /// Another cell of the same lattice with edges closer to right angles, once an edge leans by more than 0.6 of
  /// another; the threshold above one half keeps a cell under cyclic shear from flipping to and fro.
  std::optional<Mat3> upright_edges() const;

  /// What files and bytes hold of a cell.
  ISOSTAT_FIELDS(edges, deformation, rotation, strain_step, volume_strain, reference_volume, flips)

  /// Tensor from own frame to laboratory.
  Mat3 to_laboratory(const Mat3 &own) const { return rotation * own * rotation.transpose(); }
};
} // namespace isostat

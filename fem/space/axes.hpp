// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/fem/space/discretisation_test.cpp
#pragma once
#include <array>
#include <cstddef>

namespace isostat
{
/// Faces of a block of soil, without the patches that MeshSpec::patches cuts out of them; more values are patches:
/// patch_face().
enum class Face
{
  x_low,
  x_high,
  y_low,
  y_high,
  base,
  surface
};

inline constexpr int n_faces = 6;

/// MeshSpec::patches[k] as a face.
constexpr Face patch_face(std::size_t k) { return static_cast<Face>(n_faces + static_cast<int>(k)); }
constexpr bool is_patch(Face face) { return static_cast<int>(face) >= n_faces; }

/// A place in space: x, y, z, m. z = 0 at the base, upwards positive.
using Place = std::array<double, 3>;

/// Axes x, y, z (0, 1, 2) of a mesh's coordinates, by its dimension 1, 2, 3: z alone, x and z, or all three.
inline constexpr std::array<std::array<int, 3>, 4> mesh_axes = {{{}, {2, 2, 2}, {0, 2, 2}, {0, 1, 2}}};

/// The mesh's number of a face, -1 if its axis is not meshed.
template <int dim>
int boundary_id(Face face)
{
  if (is_patch(face))
    return 2 * dim + static_cast<int>(face) - n_faces;
  const int axis = static_cast<int>(face) / 2;
  for (int d = 0; d < dim; ++d)
    if (mesh_axes[dim][d] == axis)
      return 2 * d + static_cast<int>(face) % 2;
  return -1;
}

/// Place of a point of the mesh, which has `dim` coordinates; axes that are not meshed are 0.
/// tested: tests/fem/space/discretisation_test.cpp
template <int dim, typename Point>
Place place_of(const Point &point)
{
  Place place = {0, 0, 0};
  for (int d = 0; d < dim; ++d)
    place[mesh_axes[dim][d]] = point[d];
  return place;
}
} // namespace isostat

// SPDX-License-Identifier: BSD-3-Clause
// tested: tests/fem/space/discretisation_test.cpp
#pragma once
#include "fem/space/discretisation.hpp"

namespace isostat
{
/// Axes x, y, z (0, 1, 2) of a mesh's coordinates: z alone, x and z, or all three.
template <int dim>
inline constexpr std::array<int, 3> mesh_axes = {2, 2, 2};
template <>
inline constexpr std::array<int, 3> mesh_axes<2> = {0, 2, 2};
template <>
inline constexpr std::array<int, 3> mesh_axes<3> = {0, 1, 2};

/// deal.II's number of a face, -1 if its axis is not meshed.
template <int dim>
int boundary_id(Face face)
{
  const int axis = static_cast<int>(face) / 2;
  for (int d = 0; d < dim; ++d)
    if (mesh_axes<dim>[d] == axis)
      return 2 * d + static_cast<int>(face) % 2;
  return -1;
}

/// Place of a point of the mesh in space; axes that are not meshed are 0.
template <int dim>
std::array<double, 3> place_of(const dealii::Point<dim> &point)
{
  std::array<double, 3> place = {0, 0, 0};
  for (int d = 0; d < dim; ++d)
    place[mesh_axes<dim>[d]] = point[d];
  return place;
}
} // namespace isostat
